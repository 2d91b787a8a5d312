// SPDX-License-Identifier: Apache-2.0
#include "evaluation/track_jumps.h"

#include <stdexcept>

#include <Eigen/Cholesky>

namespace alidade {
namespace {

// How far the middle one of the positions is off the parabola that most of them agree on, m.
double off_parabola_m(std::span<const TimedPosition> some, double scale_m) {
  const auto count = static_cast<Eigen::Index>(some.size()), middle = count / 2;
  Eigen::MatrixX3d A(count, 3), p(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const TimedPosition& position = some[static_cast<std::size_t>(i)];
    const double t = to_seconds(position.time - some[static_cast<std::size_t>(middle)].time);
    A.row(i) << 1.0, t, t * t;
    p.row(i) = position.p;
  }
  Eigen::VectorXd w = Eigen::VectorXd::Ones(count);
  double off_m = 0.0;
  for (int round = 0; round < 10; ++round) {
    const Eigen::Matrix3d x = (A.transpose() * w.asDiagonal() * A).ldlt().solve(A.transpose() * w.asDiagonal() * p);
    const Eigen::VectorXd off = (A * x - p).rowwise().norm();
    w = (1.0 + (off / scale_m).array().square()).inverse();
    off_m = off[middle];
  }
  return off_m;
}

}  // namespace

std::vector<std::size_t> track_jumps(std::span<const TimedPosition> track, const TrackJumpOptions& options) {
  if (options.neighbours < 2 || !(options.scale_m > 0.0) || !(options.least_jump_m > 0.0)) {
    throw std::invalid_argument("track_jumps: two neighbours or more, a scale and a jump > 0 m are wanted");
  }
  const auto side = static_cast<std::size_t>(options.neighbours);
  std::vector<std::size_t> jumps;
  for (std::size_t i = side; i + side < track.size(); ++i) {
    if (off_parabola_m(track.subspan(i - side, 2 * side + 1), options.scale_m) > options.least_jump_m)
      jumps.push_back(i);
  }
  return jumps;
}

}  // namespace alidade
