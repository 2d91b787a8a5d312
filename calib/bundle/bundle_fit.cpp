// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/bundle_fit.h"

#include <algorithm>
#include <cmath>

#include "calib/bundle/bundle_priors.h"

namespace alidade {
namespace {

constexpr double kRayleighMedian = 1.17741;  // of the length of a normal residual in the plane

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Lengths of the residuals in units of the corners' sigma, by view.
std::vector<std::vector<double>> residual_sigmas(const BoardBundle& bundle, const BoardShape& shape,
                                                 std::span<const BundleView> views) {
  std::vector<std::vector<double>> lengths;
  for (const BundleView& view : views) {
    const auto residuals = residuals_px(bundle, shape, view);
    auto& of_view = lengths.emplace_back();
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      of_view.push_back(residuals[i].norm() / view.corners[i].sigma_px);
    }
  }
  return lengths;
}

void measure_scales(const std::vector<std::vector<double>>& lengths, BundleFit& fit) {
  std::vector<double> all;
  fit.view_scale.clear();
  for (const auto& of_view : lengths) {
    all.insert(all.end(), of_view.begin(), of_view.end());
    fit.view_scale.push_back(median(of_view) / kRayleighMedian);
  }
  fit.scale = median(std::move(all)) / kRayleighMedian;
}

constexpr double kUsualScatter = 1.3;  // by chance, of the median of some dozens of corners

enum class Weighting { Fading, Cut };

// Returns whether a corner changed sides.
bool weigh(const std::vector<std::vector<double>>& lengths, Weighting weighting, const BundleFitOptions& options,
           BundleFit& fit) {
  bool has_changed = false;
  for (std::size_t v = 0; v < fit.views.size(); ++v) {
    const double scale = std::clamp(fit.view_scale[v], fit.scale, options.view_scale_limit * fit.scale);
    const bool scatters = options.weigh_views && scale > kUsualScatter * fit.scale;
    const double trust = scatters ? std::pow(fit.scale / scale, 2) : 1.0;
    for (std::size_t i = 0; i < lengths[v].size(); ++i) {
      const double sigmas = lengths[v][i] / std::max(scale, 1e-9);
      double weight = sigmas <= options.outlier_sigmas ? trust : 0.0;
      if (weighting == Weighting::Fading) weight = 1.0 / std::pow(1.0 + 0.1 * sigmas * sigmas, 2);  // Geman, McClure
      has_changed |= (weight > 0) != (fit.views[v].weights[i] > 0);
      fit.views[v].weights[i] = weight;
    }
  }
  return has_changed;
}

// Least squares would never come back from a whole view of another moment: views that are far off at the start, for
// their camera, wait until the others are solved.
void hold_back_far_views(const BoardShape& shape, const BundleFitOptions& options, BundleFit& fit) {
  measure_scales(residual_sigmas(fit.bundle, shape, fit.views), fit);
  std::vector<std::vector<double>> of_camera(fit.bundle.cameras.size());
  for (std::size_t v = 0; v < fit.views.size(); ++v) {
    of_camera[static_cast<std::size_t>(fit.views[v].camera)].push_back(fit.view_scale[v]);
  }
  for (std::size_t v = 0; v < fit.views.size(); ++v) {
    const double usual = median(of_camera[static_cast<std::size_t>(fit.views[v].camera)]);
    if (fit.view_scale[v] <= options.view_scale_limit * usual) continue;
    std::fill(fit.views[v].weights.begin(), fit.views[v].weights.end(), 0.0);
  }
}

}  // namespace

BundleView bundle_view(int camera, int frame, std::vector<BoardCorner> corners, const BundleFitOptions& options) {
  for (BoardCorner& corner : corners) corner.sigma_px = std::hypot(corner.sigma_px, options.least_sigma_px);
  std::vector<double> weights(corners.size(), 1.0);
  return {camera, frame, std::move(corners), std::move(weights)};
}

BundleFit fit_bundle(const BoardBundle& start, const BoardShape& shape, std::vector<BundleView> views,
                     const BundleFreedom& freedom, const BundleFitOptions& options) {
  BundleFit fit;
  fit.bundle = start;
  fit.views = std::move(views);
  hold_back_far_views(shape, options, fit);
  constexpr int kFadingRounds = 2;
  for (int round = 0; round < options.most_rounds; ++round) {
    const bool is_first = round == 0;
    // While weights still change a rough optimum will do.
    const BundleSolverOptions accuracy = round < kFadingRounds ? BundleSolverOptions{12, 1e-3} : BundleSolverOptions{};
    auto solution = solve_bundle(std::move(fit.bundle), shape, fit.views, freedom, accuracy);
    fit.bundle = std::move(solution.bundle);
    fit.iterations += solution.iterations;
    fit.converged = solution.converged;
    const auto lengths = residual_sigmas(fit.bundle, shape, fit.views);
    measure_scales(lengths, fit);
    const Weighting weighting = round < kFadingRounds ? Weighting::Fading : Weighting::Cut;
    const bool has_changed = weigh(lengths, weighting, options, fit);
    if (weighting == Weighting::Cut && !has_changed && !is_first && round > kFadingRounds) break;
  }
  return fit;
}

namespace {

// The same bulge as offsets of the corners, the whole board where it should be.
BoardWarp as_offsets(const BoardWarp& warp, const BoardShape& shape) {
  BoardWarp offsets;
  for (std::size_t i = 0; i < shape.corners_m.size(); ++i) {
    offsets.offsets_m.push_back(shape.corner(static_cast<int>(i), warp) - shape.corners_m[i]);
  }
  const Eigen::VectorXd moved = shape.rigid_modes * rigid_part(offsets, shape);
  for (std::size_t i = 0; i < offsets.offsets_m.size(); ++i) {
    offsets.offsets_m[i] -= moved.segment<3>(3 * static_cast<Eigen::Index>(i));
  }
  return offsets;
}

}  // namespace

BundleFit fit_corners(const BundleFit& fit, const BoardShape& shape, const BundleFreedom& freedom,
                      const BundleFitOptions& options) {
  BoardBundle start = fit.bundle;
  start.warp = as_offsets(start.warp, shape);
  return fit_bundle(start, shape, fit.views, freedom, options);
}

double median_px(const BoardBundle& bundle, const BoardShape& shape, std::span<const BundleView> views) {
  std::vector<double> lengths;
  for (const BundleView& view : views) {
    for (const Eigen::Vector2d& residual : residuals_px(bundle, shape, view)) lengths.push_back(residual.norm());
  }
  return median(std::move(lengths));
}

double rms_px(const BoardBundle& bundle, const BoardShape& shape, std::span<const BundleView> views, bool all) {
  double sum = 0;
  int count = 0;
  for (const BundleView& view : views) {
    const auto residuals = residuals_px(bundle, shape, view);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (!all && view.weights[i] <= 0) continue;
      sum += residuals[i].squaredNorm();
      ++count;
    }
  }
  return count == 0 ? 0.0 : std::sqrt(sum / count);
}

}  // namespace alidade
