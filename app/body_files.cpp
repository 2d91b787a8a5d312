// SPDX-License-Identifier: Apache-2.0
#include "app/body_files.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

namespace alidade {
namespace {

constexpr std::array<std::string_view, 26> kPoseColumns{
    "t_ns",         "body",       "status",    "x_m",       "y_m",       "z_m",          "qw",
    "qx",           "qy",         "qz",        "vx_m_s",    "vy_m_s",    "vz_m_s",       "wx_rad_s",
    "wy_rad_s",     "wz_rad_s",   "sigma_x_m", "sigma_y_m", "sigma_z_m", "sigma_rx_rad", "sigma_ry_rad",
    "sigma_rz_rad", "determined", "readings",  "inliers",   "chi2"};
constexpr std::array<std::string_view, 16> kCandidateColumns{
    "t_ns", "body", "candidate", "x_m",       "y_m",       "z_m",          "qw",           "qx",
    "qy",   "qz",   "sigma_x_m", "sigma_y_m", "sigma_z_m", "sigma_rx_rad", "sigma_ry_rad", "sigma_rz_rad"};

Eigen::Quaterniond attitude_of(const MotionState& state) {
  Eigen::Quaterniond q(state.T_world_body.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  return q;
}

Vector6d sigma_of(const MotionState& state) {
  return state.covariance.diagonal().head<6>().cwiseSqrt();
}

std::int64_t nanoseconds(Timestamp time) {
  return time.time_since_epoch().count();
}

void append(std::vector<TableCell>& cells, const Eigen::Ref<const Eigen::VectorXd>& values) {
  cells.insert(cells.end(), values.begin(), values.end());
}

void append_pose(std::vector<TableCell>& cells, const MotionState& state) {
  const Eigen::Quaterniond q = attitude_of(state);
  append(cells, state.T_world_body.translation());
  append(cells, Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
}

std::vector<std::string> marker_names(std::span<const RigidBody> bodies) {
  std::vector<std::string> names;
  for (const RigidBody& body : bodies) {
    for (const BodyMarker& marker : body.markers) names.push_back(fmt::format("{}_{}", body.name, marker.id));
  }
  return names;
}

// What a file may be called, different for each body.
std::vector<std::string> file_stems(std::span<const RigidBody> bodies) {
  std::vector<std::string> stems;
  if (bodies.size() == 1) return {"trajectory"};
  for (const RigidBody& body : bodies) {
    std::string stem = body.name;
    std::replace_if(
        stem.begin(), stem.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; }, '_');
    const bool is_taken = std::find(stems.begin(), stems.end(), stem) != stems.end() || stem == "trajectory";
    stems.push_back(is_taken || stem.empty() ? fmt::format("{}_{}", stem, stems.size() + 1) : stem);
  }
  return stems;
}

}  // namespace

std::string to_string(BodyStatus status) {
  switch (status) {
    case BodyStatus::Lost:
      return "lost";
    case BodyStatus::Ambiguous:
      return "ambiguous";
    case BodyStatus::Tracked:
      return "tracked";
  }
  return "";
}

MarkerFrames::MarkerFrames(const std::filesystem::path& path, std::span<const RigidBody> bodies)
    : bodies_(bodies.begin(), bodies.end()), first_{0}, writer_(path, marker_names(bodies)) {
  for (const RigidBody& body : bodies_) first_.push_back(first_.back() + body.markers.size());
}

void MarkerFrames::add(std::size_t body, Timestamp time, const std::optional<Eigen::Isometry3d>& T_world_body) {
  Frame& frame = waiting_[time];
  frame.p_world.resize(first_.back());
  ++frame.told;
  const auto& markers = bodies_.at(body).markers;
  for (std::size_t i = 0; T_world_body && i < markers.size(); ++i) {
    frame.p_world[first_[body] + i] = *T_world_body * markers[i].p_body;
  }
  while (!waiting_.empty() && waiting_.begin()->second.told == bodies_.size()) write_front();
}

void MarkerFrames::write_front() {
  writer_.write(waiting_.begin()->first, waiting_.begin()->second.p_world);
  waiting_.erase(waiting_.begin());
}

void MarkerFrames::commit() {
  while (!waiting_.empty()) write_front();
  writer_.commit();
}

BodyFiles::BodyFiles(const ResultDirectory& directory, std::span<const RigidBody> bodies, PoseDetail detail)
    : directory_(directory),
      detail_(detail),
      poses_(directory.path("poses.csv"), kPoseColumns),
      markers_(directory.path("markers.trc"), bodies) {
  for (const RigidBody& body : bodies) names_.push_back(body.name);
  for (const std::string& stem : file_stems(bodies)) trajectories_.emplace_back(directory.path(stem + ".tum"), "body");
}

void BodyFiles::add(std::size_t body, const BodyEstimate& estimate, std::size_t readings) {
  const MotionState& state = estimate.state;
  std::vector<TableCell> cells{nanoseconds(estimate.time), names_.at(body), to_string(estimate.status)};
  if (estimate.status != BodyStatus::Lost) {
    append_pose(cells, state);
    if (detail_ == PoseDetail::Motion) {
      append(cells, state.v_world);
      append(cells, state.omega_body);
      append(cells, sigma_of(state));
    }
  }
  cells.resize(kPoseColumns.size() - 4, std::string());
  for (const std::int64_t count :
       {std::int64_t{estimate.determined}, static_cast<std::int64_t>(readings), std::int64_t{estimate.inlier_count}}) {
    cells.emplace_back(count);
  }
  cells.emplace_back(estimate.chi2);
  poses_.write_row(cells);
  if (estimate.status == BodyStatus::Ambiguous) write_candidates(names_[body], estimate);
  const bool is_tracked = estimate.status == BodyStatus::Tracked;
  markers_.add(body, estimate.time, is_tracked ? std::optional(state.T_world_body) : std::nullopt);
  if (!is_tracked) return;
  StampedPose pose{estimate.time, state.T_world_body, {}};
  if (detail_ == PoseDetail::Motion) pose.covariance = state.covariance.topLeftCorner<6, 6>();
  trajectories_[body].write(pose);
}

void BodyFiles::write_candidates(const std::string& name, const BodyEstimate& estimate) {
  if (!candidates_) candidates_.emplace(directory_.path("candidates.csv"), kCandidateColumns);
  std::int64_t number = 0;
  for (const MotionState& candidate : estimate.candidates) {
    std::vector<TableCell> cells{nanoseconds(estimate.time), name, number++};
    append_pose(cells, candidate);
    append(cells, sigma_of(candidate));
    candidates_->write_row(cells);
  }
}

void BodyFiles::commit() {
  poses_.commit();
  if (candidates_) candidates_->commit();
  for (TrajectoryWriter& trajectory : trajectories_) trajectory.commit();
  markers_.commit();
}

}  // namespace alidade
