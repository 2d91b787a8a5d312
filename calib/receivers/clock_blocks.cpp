// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/clock_blocks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/LU>

#include "core/median.h"

namespace alidade {
namespace {

constexpr std::size_t kFewest = 30;

// Of one reading: how far off it is, and how that changes with the clock, px and px/s.
struct Lag {
  Eigen::Vector2d residual_px;
  Eigen::Vector2d per_s;
};

// Late by x[0], askew by x[1], x[2]: residual + per_s x[0] + (x[1], x[2]) = 0, with weights that fade.
std::optional<ClockBlock> block_of(const std::vector<Lag>& lags, double effective_share,
                                   const ClockBlockOptions& options) {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Matrix3d H;
  double scatter2 = 0.0;
  for (int round = 0; round < 12; ++round) {
    std::vector<double> off2;
    const auto left = [&](const Lag& lag) -> Eigen::Vector2d {
      return lag.residual_px + lag.per_s * x[0] + x.tail<2>();
    };
    for (const Lag& lag : lags) off2.push_back(left(lag).squaredNorm());
    scatter2 = std::max(1e-4, median(std::move(off2)) / (1.17741 * 1.17741));  // of a coordinate
    H.setZero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (const Lag& lag : lags) {
      Eigen::Matrix<double, 2, 3> J;
      J << lag.per_s, Eigen::Matrix2d::Identity();
      const Eigen::Vector2d r = left(lag);
      const double w = 1.0 / (1.0 + r.squaredNorm() / (options.loss_sigmas * options.loss_sigmas * scatter2));
      H += w * J.transpose() * J;
      g += w * J.transpose() * r;
    }
    const Eigen::FullPivLU<Eigen::Matrix3d> lu(H);
    if (!lu.isInvertible()) return std::nullopt;
    x -= lu.solve(g);
  }
  ClockBlock block;
  block.late_s = x[0];
  block.sigma_s = std::sqrt(scatter2 * H.inverse()(0, 0) / effective_share);
  return block;
}

}  // namespace

std::vector<ClockBlock> clock_blocks(const Receiver& receiver, std::span<const ReceiverReading> readings,
                                     const KnownTrack& track, const ClockBlockOptions& options) {
  std::map<long, std::vector<Lag>> lags;
  std::map<long, std::pair<Timestamp, Timestamp>> spans;
  for (const ReceiverReading& reading : readings) {
    const auto point = track.at(sight_time(receiver, ReceiverChange::Zero(), reading).t_s);
    const auto seen = point ? sight_residual(receiver, ReceiverChange::Zero(), reading, *point) : std::nullopt;
    if (!seen) continue;
    const long number = static_cast<long>(std::floor(to_seconds(reading.time - Timestamp{}) / options.block_s));
    lags[number].push_back({seen->residual_px, seen->J_change.col(kClockOffset)});
    auto& span = spans.emplace(number, std::pair(reading.time, reading.time)).first->second;
    span.second = reading.time;
  }
  std::vector<ClockBlock> blocks;
  for (const auto& [number, own] : lags) {
    const auto [first, last] = spans.at(number);
    const double span_s = to_seconds(last - first);
    if (own.size() < kFewest || span_s < 0.25 * options.block_s) continue;
    const double per_correlation = options.correlation_s * static_cast<double>(own.size()) / span_s;
    auto block = block_of(own, 1.0 / std::max(1.0, per_correlation), options);
    if (!block || block->sigma_s > options.most_sigma_s) continue;
    block->middle = first + (last - first) / 2;
    blocks.push_back(*block);
  }
  return blocks;
}

}  // namespace alidade
