// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/board_turns.h"

#include <algorithm>
#include <cmath>

#include "calib/bundle/board_placement.h"
#include "calib/rigs/rig_start.h"

namespace alidade {
namespace {

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Turn rates on a grid of times that are multiples of the step; NaN where the film says nothing.
struct TurnGrid {
  long first = 0;  // the multiple of element 0
  std::vector<double> rates;
};

TurnGrid resample(std::span<const TurnRate> rates, double step_s) {
  std::vector<double> values;
  for (const TurnRate& rate : rates) values.push_back(rate.rate_rad_s);
  // A board placed wrongly once must not decide.
  const double most = 2.0 * quantile(values, 0.9);
  TurnGrid grid{static_cast<long>(std::ceil(rates.front().time_s / step_s)), {}};
  std::size_t next = 1;
  for (long i = grid.first; static_cast<double>(i) * step_s <= rates.back().time_s; ++i) {
    const double time_s = static_cast<double>(i) * step_s;
    while (next + 1 < rates.size() && rates[next].time_s < time_s) ++next;
    const TurnRate &a = rates[next - 1], &b = rates[next];
    const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
    const double rate = std::min(most, (1 - share) * a.rate_rad_s + share * b.rate_rad_s);
    grid.rates.push_back(b.time_s - a.time_s <= 10.0 * step_s ? rate : std::nan(""));
  }
  return grid;
}

struct Correlation {
  int samples = 0;
  double value = 0;

  // Fisher's z over its standard deviation, but for the samples' own correlation, which is the same for all offsets.
  double significance() const { return std::atanh(std::min(value, 0.9999)) * std::sqrt(samples); }
};

// Of the first grid with the second one moved by `shift` steps.
Correlation correlate(const TurnGrid& first, const TurnGrid& second, long shift) {
  const long moved = second.first + shift;
  const long begin = std::max(first.first, moved);
  const long end =
      std::min(first.first + static_cast<long>(first.rates.size()), moved + static_cast<long>(second.rates.size()));
  double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (long i = begin; i < end; ++i) {
    const double a = first.rates[static_cast<std::size_t>(i - first.first)];
    const double b = second.rates[static_cast<std::size_t>(i - moved)];
    if (std::isnan(a) || std::isnan(b)) continue;
    n += 1, sa += a, sb += b, saa += a * a, sbb += b * b, sab += a * b;
  }
  const double variances = (n * saa - sa * sa) * (n * sbb - sb * sb);
  return {static_cast<int>(n), variances > 0 ? (n * sab - sa * sb) / std::sqrt(variances) : 0.0};
}

// The pose at a time; empty where no two poses closer than the gap enclose it.
std::optional<Eigen::Isometry3d> pose_at(const PlacedFilm& film, double time_s, double most_gap_s) {
  const auto after = std::upper_bound(film.time_s.begin(), film.time_s.end(), time_s);
  if (after == film.time_s.begin() || after == film.time_s.end()) return std::nullopt;
  const auto next = static_cast<std::size_t>(after - film.time_s.begin());
  const double gap_s = film.time_s[next] - film.time_s[next - 1];
  if (gap_s > most_gap_s) return std::nullopt;
  return interpolate(film.T_camera_board[next - 1], film.T_camera_board[next],
                     (time_s - film.time_s[next - 1]) / gap_s);
}

// Where both cameras saw a board that moved.
struct SharedPoses {
  std::vector<PlacedBoard> first, second;
};

SharedPoses shared_poses(const PlacedFilm& first, const PlacedFilm& second, double offset_s, double most_gap_s) {
  const std::vector<TurnRate> rates = turn_rates(first, most_gap_s);
  SharedPoses shared;
  if (rates.empty()) return shared;
  std::vector<double> values;
  for (const TurnRate& rate : rates) values.push_back(rate.rate_rad_s);
  const double median = quantile(values, 0.5);
  for (const TurnRate& rate : rates) {
    if (rate.rate_rad_s < median) continue;
    const auto in_first = pose_at(first, rate.time_s, most_gap_s);
    const auto in_second = pose_at(second, rate.time_s - offset_s, most_gap_s);
    if (!in_first || !in_second) continue;
    const int moment = static_cast<int>(shared.first.size());
    shared.first.push_back({moment, *in_first, 1});
    shared.second.push_back({moment, *in_second, 1});
  }
  return shared;
}

// At most so many, evenly: all pairs of them are compared.
SharedPoses thinned(const SharedPoses& shared, std::size_t most) {
  const std::size_t step = (shared.first.size() + most - 1) / most;
  SharedPoses thin;
  for (std::size_t i = 0; i < shared.first.size(); i += std::max<std::size_t>(1, step)) {
    thin.first.push_back(shared.first[i]);
    thin.second.push_back(shared.second[i]);
  }
  return thin;
}

}  // namespace

PlacedFilm place_film(const CameraFilm& film, const BoardShape& shape, const BoardWarp& warp, double step_s) {
  PlacedFilm placed;
  for (const BoardView& view : film.film.views()) {
    if (!placed.time_s.empty() && view.time_s - placed.time_s.back() < step_s) continue;
    const auto T_camera_board = place_board(film.camera, shape, warp, view.corners);
    if (!T_camera_board) continue;
    placed.time_s.push_back(view.time_s);
    placed.T_camera_board.push_back(*T_camera_board);
  }
  return placed;
}

double turn_range_rad(const PlacedFilm& film) {
  if (film.T_camera_board.empty()) return 0;
  std::vector<double> angles;
  for (const Eigen::Isometry3d& T : film.T_camera_board) {
    angles.push_back(rotation_angle(film.T_camera_board.front().linear().transpose() * T.linear()));
  }
  return quantile(angles, 0.9);
}

std::vector<TurnRate> turn_rates(const PlacedFilm& film, double most_gap_s) {
  std::vector<TurnRate> rates;
  for (std::size_t i = 1; i < film.time_s.size(); ++i) {
    const double gap_s = film.time_s[i] - film.time_s[i - 1];
    if (gap_s > most_gap_s) continue;
    const double angle =
        rotation_angle(film.T_camera_board[i - 1].linear().transpose() * film.T_camera_board[i].linear());
    rates.push_back({0.5 * (film.time_s[i] + film.time_s[i - 1]), angle / gap_s});
  }
  return rates;
}

std::vector<TurnMatch> match_turns(std::span<const TurnRate> first, std::span<const TurnRate> second,
                                   const TurnMatchOptions& options) {
  if (first.size() < 2 || second.size() < 2) return {};
  const TurnGrid a = resample(first, options.step_s), b = resample(second, options.step_s);
  const long begin = a.first - b.first - static_cast<long>(b.rates.size());
  const long end = a.first - b.first + static_cast<long>(a.rates.size());
  struct Scored {
    TurnMatch match;
    double significance;
  };
  std::vector<Scored> scored;
  for (long shift = begin; shift <= end; ++shift) {
    const Correlation correlation = correlate(a, b, shift);
    const double overlap_s = correlation.samples * options.step_s;
    if (overlap_s < options.least_overlap_s || correlation.value <= 0) continue;
    scored.push_back(
        {{static_cast<double>(shift) * options.step_s, correlation.value, overlap_s}, correlation.significance()});
  }
  std::stable_sort(scored.begin(), scored.end(),
                   [](const Scored& x, const Scored& y) { return x.significance > y.significance; });
  std::vector<TurnMatch> matches;
  for (const Scored& s : scored) {
    if (static_cast<int>(matches.size()) >= options.most) break;
    const bool is_apart = std::none_of(matches.begin(), matches.end(), [&](const TurnMatch& m) {
      return std::abs(m.offset_s - s.match.offset_s) < options.apart_s;
    });
    if (is_apart) matches.push_back(s.match);
  }
  return matches;
}

std::optional<PoseAgreement> agree_on_pose(const PlacedFilm& first, const PlacedFilm& second, double offset_s,
                                           double most_gap_s) {
  const SharedPoses shared = thinned(shared_poses(first, second, offset_s, most_gap_s), 100);
  if (shared.first.size() < 6) return std::nullopt;
  const std::vector<std::vector<PlacedBoard>> by_camera{shared.first, shared.second};
  const auto chained = chain_cameras(by_camera);
  PoseAgreement agreement;
  agreement.T_first_second = std::get<std::vector<Eigen::Isometry3d>>(chained).back();
  agreement.moments = static_cast<int>(shared.first.size());
  for (std::size_t i = 0; i < shared.first.size(); ++i) {
    const Eigen::Isometry3d& T_first_board = shared.first[i].T_camera_board;
    const Eigen::Isometry3d T_found = agreement.T_first_second * shared.second[i].T_camera_board;
    const double distance_m = T_first_board.translation().norm();
    const bool agrees = rotation_angle(T_first_board.linear().transpose() * T_found.linear()) < 0.1 &&
                        (T_first_board.translation() - T_found.translation()).norm() < 0.1 * distance_m;
    if (agrees) agreement.share += 1.0 / agreement.moments;
  }
  return agreement;
}

}  // namespace alidade
