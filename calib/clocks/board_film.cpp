// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/board_film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace alidade {
namespace {

using Nodes = std::array<std::size_t, 4>;

// Lagrange's polynomial through four views: what each weighs in the value and in the slope at a time.
struct CubicWeights {
  std::array<double, 4> value{}, slope{};
  double distance_s4 = 0;  // product of the distances from the nodes: 24 times the error per fourth derivative
};

CubicWeights weights_at(double time_s, const std::array<double, 4>& times) {
  CubicWeights weights;
  weights.distance_s4 = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    weights.distance_s4 *= std::abs(time_s - times[i]);
    double scale = 1, value = 1, slope = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      if (j == i) continue;
      scale *= times[i] - times[j];
      slope = slope * (time_s - times[j]) + value;
      value *= time_s - times[j];
    }
    weights.value[i] = value / scale;
    weights.slope[i] = slope / scale;
  }
  return weights;
}

const BoardCorner* find_corner(const BoardView& view, int id) {
  const auto found = std::lower_bound(view.corners.begin(), view.corners.end(), id,
                                      [](const BoardCorner& corner, int wanted) { return corner.id < wanted; });
  return found != view.corners.end() && found->id == id ? &*found : nullptr;
}

struct InterpolatedCorner {
  BoardCorner corner;
  CornerMotion motion;
};

std::optional<InterpolatedCorner> interpolate(const std::vector<BoardView>& views, const Nodes& nodes, int id,
                                              const CubicWeights& weights) {
  InterpolatedCorner result{{id, Eigen::Vector2d::Zero(), 0.0}, {}};
  double variance = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const BoardCorner* corner = find_corner(views[nodes[i]], id);
    if (corner == nullptr) return std::nullopt;
    result.corner.pixel += weights.value[i] * corner->pixel;
    result.motion.velocity_px_s += weights.slope[i] * corner->pixel;
    result.motion.variance_rate_px2_s += 2.0 * weights.value[i] * weights.slope[i] * std::pow(corner->sigma_px, 2);
    variance += std::pow(weights.value[i] * corner->sigma_px, 2);
  }
  result.corner.sigma_px = std::sqrt(variance);
  return result;
}

std::array<double, 4> times_of(const std::vector<BoardView>& views, const Nodes& nodes) {
  std::array<double, 4> times{};
  for (std::size_t i = 0; i < 4; ++i) times[i] = views[nodes[i]].time_s;
  return times;
}

double median_interval_s(const std::vector<BoardView>& views) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < views.size(); ++i) {
    intervals.push_back(views[i].time_s - views[i - 1].time_s);
    if (!(intervals.back() > 0)) throw std::invalid_argument("the times of a film increase");
  }
  if (intervals.empty()) return 0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

}  // namespace

BoardFilm::BoardFilm(std::vector<BoardView> views) : views_(std::move(views)), interval_s_(median_interval_s(views_)) {}

bool BoardFilm::is_gapless(std::size_t first, std::size_t last) const {
  if (last >= views_.size()) return false;
  for (std::size_t i = first; i < last; ++i) {
    if (views_[i + 1].time_s - views_[i].time_s > 1.7 * interval_s_) return false;
  }
  return true;
}

// Root mean square over the corners, less what noise explains; 0 where the neighbours lack.
double BoardFilm::fourth_derivative_px_s4(std::size_t middle) const {
  if (middle < 2 || !is_gapless(middle - 2, middle + 2)) return 0;
  const Nodes nodes{middle - 2, middle - 1, middle + 1, middle + 2};
  const CubicWeights weights = weights_at(views_[middle].time_s, times_of(views_, nodes));
  double sum = 0;
  int count = 0;
  for (const BoardCorner& corner : views_[middle].corners) {
    const auto foretold = interpolate(views_, nodes, corner.id, weights);
    if (!foretold) continue;
    sum += 0.5 * (foretold->corner.pixel - corner.pixel).squaredNorm() - std::pow(foretold->corner.sigma_px, 2) -
           std::pow(corner.sigma_px, 2);
    ++count;
  }
  return count == 0 ? 0 : 24.0 * std::sqrt(std::max(0.0, sum / count)) / weights.distance_s4;
}

std::optional<FilmMoment> BoardFilm::at(double time_s) const {
  const auto after = std::upper_bound(views_.begin(), views_.end(), time_s,
                                      [](double time, const BoardView& view) { return time < view.time_s; });
  const auto next = static_cast<std::size_t>(after - views_.begin());
  if (next < 2 || !is_gapless(next - 2, next + 1)) return std::nullopt;
  const Nodes nodes{next - 2, next - 1, next, next + 1};
  const CubicWeights weights = weights_at(time_s, times_of(views_, nodes));
  const double bend = std::max(fourth_derivative_px_s4(next - 1), fourth_derivative_px_s4(next));
  const double error_px = bend * weights.distance_s4 / 24.0;
  const bool is_nearer_next = views_[next].time_s - time_s < time_s - views_[next - 1].time_s;
  const BoardView& nearest = views_[is_nearer_next ? next : next - 1];
  FilmMoment moment{{nearest.name, nearest.frame, time_s, {}}, {}, static_cast<int>(next) - 2};
  for (const BoardCorner& corner : nearest.corners) {
    auto between = interpolate(views_, nodes, corner.id, weights);
    if (!between) continue;
    between->corner.sigma_px = std::hypot(between->corner.sigma_px, error_px);
    moment.view.corners.push_back(between->corner);
    moment.motion.push_back(between->motion);
  }
  if (moment.view.corners.empty()) return std::nullopt;
  return moment;
}

}  // namespace alidade
