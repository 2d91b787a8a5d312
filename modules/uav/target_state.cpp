// SPDX-License-Identifier: Apache-2.0
#include "uav/target_state.h"

namespace alidade {

TargetState moved_to(const TargetState& state, Timestamp time) {
  const double dt = to_seconds(time - state.time);
  Matrix9d F = Matrix9d::Identity();
  F.block<6, 6>(0, 3).diagonal().array() = dt;
  F.topRightCorner<3, 3>().diagonal().array() = 0.5 * dt * dt;
  TargetState moved = state;
  moved.time = time;
  moved.p_world += state.v_world * dt + 0.5 * dt * dt * state.a_world;
  moved.v_world += state.a_world * dt;
  moved.covariance = F * state.covariance * F.transpose();
  return moved;
}

}  // namespace alidade
