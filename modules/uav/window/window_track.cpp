// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_track.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace alidade {
namespace {

constexpr double kSeedRobustness = 2.5;  // sigma; a seed's companions may be another target's
constexpr int kGrowths = 6;              // two or three are usual
constexpr double kFarOff = std::numeric_limits<double>::infinity();

// Of the position at t_s, m².
Eigen::Matrix3d position_covariance(const MotionMatrix<6>& P, double t_s) {
  return P.topLeftCorner<3, 3>() + t_s * (P.topRightCorner<3, 3>() + P.bottomLeftCorner<3, 3>()) +
         t_s * t_s * P.bottomRightCorner<3, 3>();
}

std::vector<BearingRows> rows_of_track(const BearingWindow& window, const WindowTrack& track) {
  std::vector<BearingRows> rows;
  rows.reserve(track.bearing_of_scan.size());
  for (const std::size_t bearing : track.bearing_of_scan) {
    if (bearing != kNoBearing) rows.push_back(window.rows[bearing]);
  }
  return rows;
}

bool is_possible(const BearingWindow& window, const MotionSolution<6>& motion) {
  return motion.outcome == MotionOutcome::Determined && motion.x.tail<3>().norm() <= window.options.top_speed_m_s &&
         motion.x.head<3>().norm() <= 2.0 * window.options.greatest_range_m;
}

// Of scans without a bearing: before the first one that has, and after the last, the target may not have been there.
double log_ratio_of_misses(const BearingWindow& window, const WindowTrack& track) {
  const double log_miss = std::log1p(-window.options.detection_probability);
  const double log_absent = std::log(window.options.appearance_probability);
  const auto has = [](std::size_t bearing) { return bearing != kNoBearing; };
  const auto& of = track.bearing_of_scan;
  const auto first = std::find_if(of.begin(), of.end(), has);
  const auto last = std::find_if(of.rbegin(), of.rend(), has).base();
  if (first == of.end()) return 0.0;
  const auto before = static_cast<double>(first - of.begin());
  const auto after = static_cast<double>(of.end() - last);
  const auto within = static_cast<double>(std::count(first, last, kNoBearing));
  return within * log_miss + std::max(before * log_miss, log_absent) + std::max(after * log_miss, log_absent);
}

// The density of targets in space and velocity, times the volume of states that the bearings leave.
double log_ratio_of_state(const BearingWindow& window, const MotionSolution<6>& motion) {
  const double top = window.options.top_speed_m_s;
  const double log_density =
      std::log(window.options.target_density_m3) - std::log(4.0 / 3.0 * std::numbers::pi * top * top * top);
  const Eigen::LLT<MotionMatrix<6>> llt(motion.covariance);
  if (llt.info() != Eigen::Success) return -kFarOff;
  return log_density + 3.0 * std::log(2.0 * std::numbers::pi) + llt.matrixLLT().diagonal().array().log().sum();
}

}  // namespace

double innovation_chi2(const BearingWindow& window, std::size_t bearing, const MotionSolution<6>& motion) {
  const BearingRows& row = window.rows[bearing];
  const BearingError at = bearing_error(row, position_of<6>(motion.x, row.t_s));
  if (!(at.depth_m > 0.0)) return kFarOff;
  const double chi2 = at.error.squaredNorm();
  const Eigen::Matrix3d P = position_covariance(motion.covariance, row.t_s);
  // S <= 1 + trace P |J|², so that far ones need no inverse
  if (chi2 > window.options.gate_chi2 * (1.0 + P.trace() * at.J.squaredNorm())) return kFarOff;
  const Eigen::Matrix2d S = Eigen::Matrix2d::Identity() + at.J * P * at.J.transpose();
  return at.error.dot(S.inverse() * at.error);
}

bool refit(const BearingWindow& window, WindowTrack& track) {
  const std::vector<BearingRows> rows = rows_of_track(window, track);
  if (rows.size() < 3) return false;
  track.motion = refine_motion<6>(rows, {}, {}, track.motion.x);
  if (track.motion.outcome != MotionOutcome::Determined) track.motion = solve_motion<6>(rows, {}, {});
  if (!is_possible(window, track.motion)) return false;
  double log_ratio = log_ratio_of_state(window, track.motion) + log_ratio_of_misses(window, track);
  for (const std::size_t bearing : track.bearing_of_scan) {
    if (bearing != kNoBearing) log_ratio += window.log_gain[bearing];
  }
  track.log_ratio = log_ratio - 0.5 * track.motion.chi2;
  return true;
}

std::optional<WindowTrack> grow_track(const BearingWindow& window, std::span<const std::size_t> seed,
                                      const std::vector<char>& is_free) {
  WindowTrack track;
  track.bearing_of_scan.assign(window.scans.size(), kNoBearing);
  for (const std::size_t bearing : seed) track.bearing_of_scan[window.scan_of[bearing]] = bearing;
  MotionFitOptions robust;
  robust.robust_scale = kSeedRobustness;
  track.motion = solve_motion<6>(rows_of_track(window, track), {}, robust);
  for (int growth = 0; growth < kGrowths; ++growth) {
    if (!is_possible(window, track.motion)) return std::nullopt;
    std::vector<std::size_t> nearest(window.scans.size(), kNoBearing);
    for (std::size_t s = 0; s < window.scans.size(); ++s) {
      double least = window.options.gate_chi2;
      for (const std::size_t bearing : window.scans[s].bearings) {
        if (!is_free[bearing]) continue;
        const double chi2 = innovation_chi2(window, bearing, track.motion);
        if (chi2 < least) {
          least = chi2;
          nearest[s] = bearing;
        }
      }
    }
    const bool is_settled = growth > 0 && nearest == track.bearing_of_scan;
    track.bearing_of_scan = std::move(nearest);
    if (is_settled) return track;
    if (!refit(window, track)) return std::nullopt;
  }
  return track;
}

}  // namespace alidade
