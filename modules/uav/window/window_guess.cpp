// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_guess.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace alidade {
namespace {

using Eigen::Vector3d;

constexpr double kGate = 4.0;                 // sigma
constexpr double kReach = 1.2;                // of a search: angles and distances agree to that below half a radian
constexpr std::size_t kFew = 16;              // bearings that are sooner looked at one by one
constexpr int kPasses = 8;                    // of two pairs; two or three where delays are short
constexpr double kSettled_m = 0.02;           // below any gate
constexpr double kLeastSquaredSine = 1e-3;    // of the angle between a pair's lines of sight: 1.8 degrees
constexpr double kGreatestRangeShare = 0.05;  // a guess's sigma: beyond, its gates hold anything

bool is_in_range(const BearingWindow& window, double range_m) {
  return range_m > 0.0 && range_m < window.options.greatest_range_m;
}

bool is_slow_enough(const BearingWindow& window, const MotionGuess& guess) {
  const double dt = guess.t1_s - guess.t0_s;
  const double reach = window.options.top_speed_m_s * dt + kGate * std::sqrt(guess.variance0_m2 + guess.variance1_m2);
  return (guess.p1 - guess.p0).squaredNorm() <= reach * reach;
}

// Where two lines of sight come nearest to each other: on the first one's; and how near that is.
struct Meeting {
  Vector3d p = Vector3d::Zero();
  double range_first_m = 0.0, range_second_m = 0.0, squared_miss_m2 = 0.0, squared_sine = 0.0;
};

Meeting meet(const BearingRows& first, const BearingRows& second, const Vector3d& second_origin) {
  const Vector3d base = second_origin - first.origin;
  const double c = first.direction.dot(second.direction);
  const double along_first = first.direction.dot(base), along_second = second.direction.dot(base);
  Meeting result;
  result.squared_sine = 1.0 - c * c;
  const double inverse = 1.0 / std::max(result.squared_sine, 1e-12);
  result.range_first_m = (along_first - c * along_second) * inverse;
  result.range_second_m = (c * along_first - along_second) * inverse;
  const Vector3d on_first = result.range_first_m * first.direction;
  const Vector3d on_second = base + result.range_second_m * second.direction;
  result.p = first.origin + 0.5 * (on_first + on_second);
  result.squared_miss_m2 = (on_first - on_second).squaredNorm();
  return result;
}

double squared(double x) {
  return x * x;
}

double lateral_variance(const BearingWindow& window, std::size_t first, std::size_t second, const Meeting& meeting) {
  return squared(window.sigma_rad[first] * meeting.range_first_m) +
         squared(window.sigma_rad[second] * meeting.range_second_m);
}

bool is_place(const BearingWindow& window, const Meeting& meeting) {
  return meeting.squared_sine > kLeastSquaredSine && is_in_range(window, meeting.range_first_m) &&
         is_in_range(window, meeting.range_second_m);
}

// The square of the distance between the bearing's line of sight and the guess, in shares of its variance.
double squared_distance(const BearingWindow& window, const MotionGuess& guess, std::size_t bearing) {
  const BearingRows& row = window.rows[bearing];
  const double u = (row.t_s - guess.t0_s) / (guess.t1_s - guess.t0_s);
  const Vector3d d = guess.p0 + u * (guess.p1 - guess.p0) - row.origin;
  const double along = d.dot(row.direction), square = d.squaredNorm();
  if (along <= 0.0) return 2.0 * kGate * kGate;
  const double variance = squared(1.0 - u) * guess.variance0_m2 + squared(u) * guess.variance1_m2 +
                          squared(window.sigma_rad[bearing]) * square;
  return (square - along * along) / variance;
}

// Calls visit(bearing, squared distance) for each free bearing of a scan within the gate, until it returns true.
template <typename Visit>
bool visit_near(const BearingWindow& window, const MotionGuess& guess, const WindowScan& scan,
                const std::vector<char>& is_free, Visit visit) {
  const auto visit_one = [&](std::size_t bearing) {
    if (!is_free[bearing]) return false;
    const double distance = squared_distance(window, guess, bearing);
    return distance < kGate * kGate && visit(bearing, distance);
  };
  if (scan.bearings.size() <= kFew) return std::any_of(scan.bearings.begin(), scan.bearings.end(), visit_one);
  const double dt = guess.t1_s - guess.t0_s, u = (scan.t_s - guess.t0_s) / dt;
  const Vector3d d = guess.p0 + u * (guess.p1 - guess.p0) - window.rows[scan.bearings.front()].origin;
  const double range = d.norm();
  // How far off a bearing within the gate may be: the guess's error, the bearing's own, and what the scan's differ by.
  const double variance = squared(1.0 - u) * guess.variance0_m2 + squared(u) * guess.variance1_m2;
  const double apart = scan.origin_spread_m + scan.half_time_s / dt * (guess.p1 - guess.p0).norm();
  const double reach = kReach * (kGate * std::sqrt(variance + squared(scan.greatest_sigma_rad * range)) + apart);
  if (!(range > 2.0 * reach)) return std::any_of(scan.bearings.begin(), scan.bearings.end(), visit_one);
  return scan.grid.visit_near(d / range, reach / range,
                              [&](std::size_t place) { return visit_one(scan.bearings[place]); });
}

bool has_bearing_near(const BearingWindow& window, const MotionGuess& guess, const WindowScan& scan,
                      const std::vector<char>& is_free) {
  return visit_near(window, guess, scan, is_free, [](std::size_t, double) { return true; });
}

std::optional<std::size_t> nearest_bearing(const BearingWindow& window, const MotionGuess& guess,
                                           const WindowScan& scan, const std::vector<char>& is_free) {
  std::optional<std::size_t> nearest;
  double least = kGate * kGate;
  visit_near(window, guess, scan, is_free, [&](std::size_t bearing, double distance) {
    if (distance < least) {
      least = distance;
      nearest = bearing;
    }
    return false;
  });
  return nearest;
}

}  // namespace

std::optional<MotionGuess> guess_of_three(const BearingWindow& window, const std::array<std::size_t, 3>& bearings) {
  const BearingRows& first = window.rows[bearings[0]];
  const BearingRows& middle = window.rows[bearings[1]];
  const BearingRows& last = window.rows[bearings[2]];
  const double beta = (middle.t_s - first.t_s) / (last.t_s - first.t_s), alpha = 1.0 - beta;
  if (!(alpha > 0.0) || !(beta > 0.0)) return std::nullopt;
  // alpha p_first - p_middle + beta p_last = 0, by Cramer's rule
  const Vector3d rhs = middle.origin - alpha * first.origin - beta * last.origin;
  const Vector3d across_first = middle.direction.cross(last.direction);
  const Vector3d across_last = first.direction.cross(middle.direction);
  const double volume = first.direction.dot(across_first);
  if (std::abs(volume) < kLeastSquaredSine) return std::nullopt;
  const double range_first = across_first.dot(rhs) / (alpha * volume);
  const double range_last = across_last.dot(rhs) / (beta * volume);
  const double range_middle = -last.direction.cross(first.direction).dot(rhs) / volume;
  if (!is_in_range(window, range_first) || !is_in_range(window, range_middle) || !is_in_range(window, range_last)) {
    return std::nullopt;
  }
  const double first_m2 = squared(window.sigma_rad[bearings[0]] * range_first);
  const double last_m2 = squared(window.sigma_rad[bearings[2]] * range_last);
  const double rhs_m2 =
      squared(alpha) * first_m2 + squared(window.sigma_rad[bearings[1]] * range_middle) + squared(beta) * last_m2;
  MotionGuess guess;
  guess.t0_s = first.t_s;
  guess.t1_s = last.t_s;
  guess.p0 = first.origin + range_first * first.direction;
  guess.p1 = last.origin + range_last * last.direction;
  guess.variance0_m2 = first_m2 + rhs_m2 * across_first.squaredNorm() / squared(alpha * volume);
  guess.variance1_m2 = last_m2 + rhs_m2 * across_last.squaredNorm() / squared(beta * volume);
  const bool is_sure = guess.variance0_m2 < squared(kGreatestRangeShare * range_first) &&
                       guess.variance1_m2 < squared(kGreatestRangeShare * range_last);
  if (!is_sure || !is_slow_enough(window, guess)) return std::nullopt;
  return guess;
}

bool may_meet(const BearingWindow& window, std::size_t first, std::size_t second) {
  const BearingRows& a = window.rows[first];
  const BearingRows& b = window.rows[second];
  const Meeting meeting = meet(a, b, b.origin);
  const double flown = window.options.top_speed_m_s * std::abs(b.t_s - a.t_s);
  const double gate = flown + kGate * std::sqrt(lateral_variance(window, first, second, meeting));
  return is_place(window, meeting) && meeting.squared_miss_m2 <= gate * gate;
}

std::optional<MotionGuess> guess_of_pairs(const BearingWindow& window, const std::array<std::size_t, 4>& bearings) {
  const std::array<const BearingRows*, 4> rows{&window.rows[bearings[0]], &window.rows[bearings[1]],
                                               &window.rows[bearings[2]], &window.rows[bearings[3]]};
  MotionGuess guess;
  guess.t0_s = rows[0]->t_s;
  guess.t1_s = rows[2]->t_s;
  if (!(guess.t1_s > guess.t0_s)) return std::nullopt;
  Vector3d v = Vector3d::Zero();
  Meeting before, after;
  const double before_s = rows[1]->t_s - rows[0]->t_s, after_s = rows[3]->t_s - rows[2]->t_s;
  const double greatest_delay_s = std::max(std::abs(before_s), std::abs(after_s));
  // Each pass is nearer by the share of the delay in the time between the pairs.
  for (int pass = 0; pass < kPasses; ++pass) {
    before = meet(*rows[0], *rows[1], rows[1]->origin - v * before_s);
    after = meet(*rows[2], *rows[3], rows[3]->origin - v * after_s);
    if (!is_place(window, before) || !is_place(window, after)) return std::nullopt;
    const Vector3d last = std::exchange(v, (after.p - before.p) / (guess.t1_s - guess.t0_s));
    if (pass > 0 && (v - last).norm() * greatest_delay_s < kSettled_m) break;
  }
  const double before_m2 = lateral_variance(window, bearings[0], bearings[1], before);
  const double after_m2 = lateral_variance(window, bearings[2], bearings[3], after);
  // What the velocity errs by moves the second lines of sight; twice the variance holds for delays up to that.
  constexpr double kSpread = 2.0;
  if (before.squared_miss_m2 > kSpread * kGate * kGate * before_m2 ||
      after.squared_miss_m2 > kSpread * kGate * kGate * after_m2) {
    return std::nullopt;
  }
  guess.p0 = before.p;
  guess.p1 = after.p;
  guess.variance0_m2 = before_m2 / before.squared_sine;
  guess.variance1_m2 = after_m2 / after.squared_sine;
  if (!is_slow_enough(window, guess)) return std::nullopt;
  return guess;
}

std::optional<Support> find_support(const BearingWindow& window, const MotionGuess& guess,
                                    std::span<const std::size_t> scans, const SupportSearch& search) {
  const double pd = window.options.detection_probability;
  const double log_hit = std::log(pd / search.chance), log_miss = std::log((1.0 - pd) / (1.0 - search.chance));
  double log_ratio = 0.0;
  for (const std::size_t s : scans) {
    log_ratio += has_bearing_near(window, guess, window.scans[s], search.is_free) ? log_hit : log_miss;
    if (log_ratio < search.refuted) return std::nullopt;
  }
  if (log_ratio < search.supported) return std::nullopt;
  Support support{{}, log_ratio};
  for (const std::size_t s : scans) {
    if (const auto nearest = nearest_bearing(window, guess, window.scans[s], search.is_free))
      support.bearings.push_back(*nearest);
  }
  return support;
}

}  // namespace alidade
