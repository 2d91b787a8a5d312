// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/receiver_parameters.h"

#include <cmath>
#include <stdexcept>

#include "geometry/rotation.h"

namespace alidade {
namespace {

double row_share(const Camera& camera, double y_px) {
  return (y_px + 0.5) / camera.height - 0.5;
}

}  // namespace

Receiver changed(Receiver receiver, const ReceiverChange& change) {
  receiver.T_world_receiver = receiver.T_world_receiver * perturbation(change.head<6>());
  receiver.clock.offset_s += change[kClockOffset];
  receiver.clock.rate += change[kClockRate];
  if (!receiver.camera) return receiver;
  receiver.camera->readout_s += change[kReadout];
  receiver.camera->fx *= std::exp(change[kFocal]);
  receiver.camera->fy *= std::exp(change[kFocal]);
  return receiver;
}

SightTime sight_time(const Receiver& receiver, const ReceiverChange& change, const ReceiverReading& reading) {
  const double since_s = to_seconds(reading.time - receiver.clock.reference);
  const double share = receiver.camera ? row_share(*receiver.camera, reading.value.y()) : 0.0;
  const double readout_s = receiver.camera ? receiver.camera->readout_s + change[kReadout] : 0.0;
  SightTime time;
  time.t_s = to_seconds(reading.time - Timestamp{}) + receiver.clock.offset_s + change[kClockOffset] +
             (receiver.clock.rate + change[kClockRate]) * since_s + readout_s * share;
  time.J_change[kClockOffset] = 1.0;
  time.J_change[kClockRate] = since_s;
  time.J_change[kReadout] = share;
  return time;
}

std::optional<SightResidual> sight_residual(const Receiver& receiver, const ReceiverChange& change,
                                            const ReceiverReading& reading, const TrackPoint& point) {
  if (!receiver.camera) throw std::invalid_argument("sight_residual: the receiver has no camera");
  Camera camera = *receiver.camera;
  camera.fx *= std::exp(change[kFocal]);
  camera.fy *= std::exp(change[kFocal]);
  const Eigen::Matrix3d R_world_given = receiver.T_world_receiver.linear();
  const Eigen::Matrix3d R_given_camera = exp_so3(change.segment<3>(kRotation));
  const Eigen::Vector3d p_given = R_world_given.transpose() * (point.p_world - receiver.T_world_receiver.translation());
  const Eigen::Vector3d p_camera = R_given_camera.transpose() * (p_given - change.head<3>());
  const auto seen = project(camera, p_camera);
  if (!seen) return std::nullopt;
  const Eigen::Matrix<double, 2, 3>& J = seen->J_pixel_point;
  SightResidual result;
  result.residual_px = seen->pixel - reading.value;
  result.J_position = J * (R_world_given * R_given_camera).transpose();
  result.J_change = result.J_position * point.v_world * sight_time(receiver, change, reading).J_change.transpose();
  result.J_change.leftCols<3>() = -J * R_given_camera.transpose();
  result.J_change.middleCols<3>(kRotation) = J * skew(p_camera) * right_jacobian_so3(change.segment<3>(kRotation));
  result.J_change.col(kFocal) = seen->pixel - Eigen::Vector2d(camera.cx, camera.cy);
  return result;
}

}  // namespace alidade
