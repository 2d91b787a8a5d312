// SPDX-License-Identifier: Apache-2.0
#include "marker1d/paper_motion.h"

#include <algorithm>
#include <stdexcept>

#include <Eigen/Cholesky>

#include "geometry/rotation.h"

namespace alidade {

void PaperMotion::add(Timestamp time, const Eigen::Isometry3d& T_world_body) {
  if (!past_.empty() && past_.back().time == time) past_.pop_back();
  if (past_.size() == memory_) past_.erase(past_.begin());
  past_.push_back({time, T_world_body});
}

// What the value at each past time counts in the polynomial's value at `time`.
Eigen::VectorXd PaperMotion::weights_at(Timestamp time) const {
  if (past_.empty()) throw std::invalid_argument("PaperMotion: there is no pose yet");
  const auto count = static_cast<Eigen::Index>(past_.size());
  const Eigen::Index terms = std::min<Eigen::Index>(3, count);
  // Times from the last pose, in units of the whole.
  const double unit = count > 1 ? to_seconds(past_.back().time - past_.front().time) : 1.0;
  const auto powers = [&](Timestamp at) {
    const double u = to_seconds(at - past_.back().time) / unit;
    return Eigen::Vector3d(1.0, terms > 1 ? u : 0.0, terms > 2 ? u * u : 0.0);
  };
  Eigen::Matrix<double, Eigen::Dynamic, 3> V(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) V.row(i) = powers(past_[static_cast<std::size_t>(i)].time).transpose();
  Eigen::Matrix3d VV = V.transpose() * V;
  for (Eigen::Index i = terms; i < 3; ++i) VV(i, i) = 1.0;
  return V * VV.ldlt().solve(powers(time));
}

Eigen::Isometry3d PaperMotion::pose_at(Timestamp time) const {
  const Eigen::VectorXd weights = weights_at(time);
  const Eigen::Matrix3d R_last = past_.back().T_world_body.linear();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();  // from the last attitude
  for (std::size_t i = 0; i < past_.size(); ++i) {
    const double weight = weights(static_cast<Eigen::Index>(i));
    translation += weight * past_[i].T_world_body.translation();
    turn += weight * log_so3(R_last.transpose() * past_[i].T_world_body.linear());
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R_last * exp_so3(turn);
  T.translation() = translation;
  return T;
}

Eigen::Vector3d PaperMotion::point_at(Timestamp time, const Eigen::Vector3d& p_body) const {
  const Eigen::VectorXd weights = weights_at(time);
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < past_.size(); ++i) {
    p_world += weights(static_cast<Eigen::Index>(i)) * (past_[i].T_world_body * p_body);
  }
  return p_world;
}

}  // namespace alidade
