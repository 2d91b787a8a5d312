// SPDX-License-Identifier: Apache-2.0
#include "app/live_messages.h"

#include <nlohmann/json.hpp>

#include "app/version.h"

namespace alidade {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> list_of(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return {values.begin(), values.end()};
}

Json pose_of(const Eigen::Isometry3d& T) {
  Eigen::Quaterniond q(T.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  return {{"p_m", list_of(T.translation())}, {"q_wxyz", {q.w(), q.x(), q.y(), q.z()}}};
}

Json rows_of(const Matrix6d& matrix) {
  Json rows = Json::array();
  for (int r = 0; r < 6; ++r) rows.push_back(list_of(matrix.row(r).transpose()));
  return rows;
}

std::int64_t nanoseconds(Timestamp time) {
  return time.time_since_epoch().count();
}

}  // namespace

Json hello_message(const LiveHello& hello) {
  Json message{{"type", "hello"},
               {"schema", "alidade.live"},
               {"version", kLiveVersion},
               {"program", std::string("alidade ") + kVersion},
               {"verb", hello.verb},
               {"source", hello.source},
               {"clock", hello.clock},
               {"sent_clock", "host, monotonic (CLOCK_MONOTONIC)"},
               {"pose", hello.pose},
               {"unit_of_length", hello.is_metric ? "m" : "free"},
               {"covariance", hello.pose == "p_world_m" ? "of (p m, v m/s), world axes"
                                                        : "of xi = (translation m, rotation rad), T * exp(xi)"}};
  if (!hello.bodies.empty()) message["bodies"] = hello.bodies;
  return message;
}

Json pose_message(const std::string& source, const FrameReport& report, const CaptureStamp& stamp) {
  Json message{{"type", "pose"},
               {"source", source},
               {"frame", report.index},
               {"t_ns", nanoseconds(report.time)},
               {"state", to_string(report.state)}};
  if (!report.reason.empty()) message["reason"] = report.reason;
  if (report.has_pose()) {
    message["T_world_camera"] = pose_of(report.T_world_camera);
    message["covariance"] = rows_of(report.covariance);
  }
  if (stamp.sequence) message["sequence"] = *stamp.sequence;
  message["dropped_before"] = stamp.dropped_before;
  message["discarded_before"] = stamp.discarded_before;
  return message;
}

Json pose_message(const std::string& source, const std::string& body, const BodyEstimate& estimate, PoseDetail detail) {
  Json message{{"type", "pose"},
               {"source", source},
               {"body", body},
               {"t_ns", nanoseconds(estimate.time)},
               {"state", to_string(estimate.status)}};
  if (estimate.status == BodyStatus::Lost) return message;
  const MotionState& state = estimate.state;
  message["T_world_body"] = pose_of(state.T_world_body);
  if (detail == PoseDetail::Pose) return message;
  message["covariance"] = rows_of(state.covariance.topLeftCorner<6, 6>());
  message["v_world_m_s"] = list_of(state.v_world);
  message["omega_body_rad_s"] = list_of(state.omega_body);
  return message;
}

Json target_message(const std::string& source, const TargetRow& target) {
  Json message{{"type", "target"},
               {"source", source},
               {"target", target.target},
               {"t_ns", nanoseconds(target.time)},
               {"state", target.state},
               {"p_world_m", list_of(target.p_world)},
               {"v_world_m_s", list_of(target.v_world)}};
  if (target.covariance) message["covariance"] = rows_of(*target.covariance);
  message["sightings"] = target.sightings;
  if (target.temperature_k) message["temperature_k"] = *target.temperature_k;
  if (target.temperature_sigma_k) message["temperature_sigma_k"] = *target.temperature_sigma_k;
  return message;
}

Json cue_message(const AddressedCue& addressed) {
  const Cue& cue = addressed.cue;
  const Eigen::Matrix2d& C = cue.covariance;
  return {{"type", "cue"},
          {"target", addressed.target},
          {"receiver", addressed.receiver},
          {"told_ns", nanoseconds(addressed.told)},
          {"t_ns", nanoseconds(cue.time)},
          {"own_t_ns", nanoseconds(cue.own_time)},
          {"azimuth_rad", cue.azimuth_elevation[0]},
          {"elevation_rad", cue.azimuth_elevation[1]},
          {"covariance", {{C(0, 0), C(0, 1)}, {C(1, 0), C(1, 1)}}},
          {"range_m", cue.range_m}};
}

Json end_message(const LiveEnd& end) {
  return {{"type", "end"}, {"frames", end.frames}, {"tracked", end.tracked}, {"interrupted", end.interrupted}};
}

}  // namespace alidade
