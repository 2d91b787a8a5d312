// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/camera_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "calib/bundle/projection_uncertainty.h"
#include "calib/cameras/view_diversity.h"

namespace alidade {
namespace {

using Outcome = CameraCalibrationOutcome;
constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<BundleView> to_bundle_views(std::span<const BoardView> views, const BundleFitOptions& options) {
  std::vector<BundleView> bundle;
  for (const BoardView& view : views) bundle.push_back(bundle_view(0, 0, view.corners, options));
  return bundle;
}

void require_corners_of(const BoardShape& shape, std::span<const BoardView> views) {
  const int count = static_cast<int>(shape.corners_m.size());
  for (const BoardView& view : views) {
    for (const BoardCorner& corner : view.corners) {
      if (corner.id >= 0 && corner.id < count) continue;
      throw std::invalid_argument(
          fmt::format("{}: the board has corners 0 to {}, not {}", view.name, count - 1, corner.id));
    }
  }
}

// The views that show something new, their frames numbered; fills in what becomes of the others.
std::vector<BundleView> distinct_views(std::span<const BoardView> views, const CameraCalibrationOptions& options,
                                       CameraCalibration& calibration) {
  const std::vector<BundleView> all = to_bundle_views(views, options.fit);
  const std::vector<int> earlier = find_repeated_views(all, options.repeated_view_px);
  std::vector<BundleView> distinct;
  for (std::size_t i = 0; i < all.size(); ++i) {
    ViewVerdict verdict;
    verdict.repeats = earlier[i];
    if (earlier[i] >= 0) verdict.use = ViewUse::Repeated;
    calibration.verdicts.push_back(verdict);
    calibration.frame_of_view.push_back(earlier[i] >= 0 ? -1 : static_cast<int>(distinct.size()));
    if (earlier[i] >= 0) continue;
    distinct.push_back(all[i]);
    distinct.back().frame = static_cast<int>(distinct.size()) - 1;
  }
  calibration.distinct_views = static_cast<int>(distinct.size());
  return distinct;
}

// In order of parameters.
std::vector<CameraModel> models_to_try(const CameraCalibrationOptions& options) {
  std::vector<LensModel> lenses{LensModel::Radial, LensModel::Brown, LensModel::Rational, LensModel::Fisheye};
  if (options.lens) lenses = {*options.lens};
  std::vector<CameraModel> models;
  for (const bool free_corners : {false, true}) {
    if (options.free_corners && *options.free_corners != free_corners) continue;
    for (const LensModel lens : lenses) models.push_back({lens, free_corners});
  }
  return models;
}

struct Tried {
  LensTrial trial;
  BundleFit fit;
};

std::optional<Tried> try_model(const CameraModel& model, const ImageExtent& image, const BoardShape& shape,
                               const std::vector<BundleView>& views, const CameraCalibrationOptions& options) {
  auto fit = fit_camera(model, image, shape, views, options.fit);
  if (!fit) return std::nullopt;
  Tried tried{{model, rms_px(fit->bundle, shape, fit->views), 0.0}, std::move(*fit)};
  const int folds = std::min(options.folds, static_cast<int>(views.size()));
  const auto held_out = held_out_error(model, image, shape, views, options.fit, folds);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  tried.trial.held_out_rms_px = held_out ? held_out->rms_px : unknown;
  tried.trial.held_out_median_px = held_out ? held_out->median_px : unknown;
  return tried;
}

// The first, in order of parameters, whose held-out error is nearly the least; where there is none, the first.
const Tried& choose(const std::vector<Tried>& tried, double simpler_within) {
  double least = std::numeric_limits<double>::infinity();
  for (const Tried& t : tried) least = std::fmin(least, t.trial.held_out_rms_px);
  const auto good = std::find_if(tried.begin(), tried.end(),
                                 [&](const Tried& t) { return t.trial.held_out_rms_px <= simpler_within * least; });
  return good == tried.end() ? tried.front() : *good;
}

void judge_views(const BoardShape& shape, CameraCalibration& calibration) {
  for (std::size_t i = 0; i < calibration.verdicts.size(); ++i) {
    if (calibration.frame_of_view[i] < 0) continue;
    const BundleView& view = calibration.fit.views[static_cast<std::size_t>(calibration.frame_of_view[i])];
    ViewVerdict& verdict = calibration.verdicts[i];
    verdict.rms_px = rms_px(calibration.fit.bundle, shape, std::span(&view, 1), true);
    verdict.outliers = static_cast<int>(std::count(view.weights.begin(), view.weights.end(), 0.0));
    if (verdict.outliers > 0) verdict.use = ViewUse::PartlyUsed;
    if (2 * verdict.outliers > static_cast<int>(view.weights.size())) verdict.use = ViewUse::Rejected;
  }
}

int used_corners(const std::vector<BundleView>& views) {
  int count = 0;
  for (const BundleView& view : views) {
    count += static_cast<int>(std::count_if(view.weights.begin(), view.weights.end(), [](double w) { return w > 0; }));
  }
  return count;
}

// Two coordinates of each corner for one parameter, the warp's two and six of every view among them.
bool has_corners_for(LensModel lens, const std::vector<BundleView>& views) {
  const std::size_t parameters = free_intrinsics(lens).size() + 2 + 6 * views.size();
  return used_corners(views) >= static_cast<int>(parameters);
}

Outcome judge(const CameraCalibration& calibration, const CameraCalibrationOptions& options, bool has_covariance) {
  if (!has_corners_for(calibration.model.lens, calibration.fit.views)) return Outcome::TooFewCorners;
  if (calibration.tilt_spread_rad < options.least_tilt_deg * kDegree) return Outcome::NoTilt;
  if (!has_covariance || find_fault(calibration.camera)) return Outcome::Undetermined;
  const BundleLayout layout(calibration.fit.bundle, calibration.freedom);
  const double sigma = intrinsics_sigma(calibration.covariance, layout, 0)[0];
  return sigma < options.worst_focal_sigma * calibration.camera.fx ? Outcome::Calibrated : Outcome::Undetermined;
}

// Views that were left out may err far more than the ones that were fitted: then the fit has taken part of its errors
// for the lens, and what it says of itself is as wrong.
void enlarge_by_left_out(double left_out_median_px, const BoardShape& shape, CameraCalibration& c) {
  const double ratio = std::pow(left_out_median_px / median_px(c.fit.bundle, shape, c.fit.views), 2);
  if (!(ratio > 2.0)) return;  // less is usual for few views
  c.covariance.left_out = ratio;
  c.covariance.shared_and_motion *= ratio;
}

void finish(const BoardShape& shape, const CameraCalibrationOptions& options, double left_out_median_px,
            CameraCalibration& calibration) {
  const BundleFit& fit = calibration.fit;
  calibration.camera = fit.bundle.cameras.front().camera;
  calibration.freedom = calibration.model.freedom();
  calibration.rms_px = rms_px(fit.bundle, shape, fit.views);
  calibration.rms_all_px = rms_px(fit.bundle, shape, fit.views, true);
  calibration.tilt_spread_rad = tilt_spread_rad(fit.bundle, fit.views, 0);
  calibration.residuals = residual_field(fit, shape, 0);
  judge_views(shape, calibration);
  const auto covariance = bundle_covariance(fit, shape, calibration.freedom);
  if (covariance) calibration.covariance = *covariance;
  enlarge_by_left_out(left_out_median_px, shape, calibration);
  calibration.outcome = judge(calibration, options, covariance.has_value());
}

}  // namespace

void validate(const CameraCalibrationOptions& o) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(o.folds >= 2, fmt::format("folds must be >= 2, got {}", o.folds));
  require(o.simpler_within >= 1, fmt::format("simpler_within must be >= 1, got {}", o.simpler_within));
  require(o.repeated_view_px >= 0, fmt::format("repeated_view_px must be >= 0 px, got {}", o.repeated_view_px));
  require(o.least_tilt_deg >= 0, fmt::format("least_tilt_deg must be >= 0 deg, got {}", o.least_tilt_deg));
  require(o.worst_focal_sigma > 0, fmt::format("worst_focal_sigma must be > 0, got {}", o.worst_focal_sigma));
  require(o.fit.least_sigma_px >= 0, fmt::format("least_sigma_px must be >= 0 px, got {}", o.fit.least_sigma_px));
  require(o.fit.outlier_sigmas >= 2, fmt::format("outlier_sigmas must be >= 2, got {}", o.fit.outlier_sigmas));
}

CameraCalibration calibrate_camera(const ImageExtent& image, const Board& board, std::span<const BoardView> views,
                                   const CameraCalibrationOptions& options, const ProgressSink& progress,
                                   const std::stop_token& stop) {
  validate(options);
  const BoardShape shape = shape_of(board);
  require_corners_of(shape, views);
  CameraCalibration calibration;
  const std::vector<BundleView> distinct = distinct_views(views, options, calibration);
  calibration.outcome = Outcome::TooFewViews;
  if (distinct.size() < 3) return calibration;
  const auto models = models_to_try(options);
  calibration.fit.views = distinct;
  calibration.outcome = Outcome::TooFewCorners;
  if (!has_corners_for(models.front().lens, distinct)) return calibration;
  std::vector<Tried> tried;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (stop.stop_requested()) {
      calibration.outcome = Outcome::Stopped;
      return calibration;
    }
    if (progress)
      progress({"fitting lenses", static_cast<std::int64_t>(i), static_cast<std::int64_t>(models.size()), ""});
    if (auto t = try_model(models[i], image, shape, distinct, options)) tried.push_back(std::move(*t));
  }
  calibration.outcome = Outcome::Undetermined;
  if (tried.empty()) return calibration;
  const Tried& chosen = choose(tried, options.simpler_within);
  for (const Tried& t : tried) calibration.trials.push_back(t.trial);
  calibration.model = chosen.trial.model;
  calibration.fit = chosen.fit;
  if (std::isfinite(chosen.trial.held_out_rms_px)) calibration.held_out_rms_px = chosen.trial.held_out_rms_px;
  finish(shape, options, chosen.trial.held_out_median_px, calibration);
  return calibration;
}

std::string explain(const CameraCalibration& c) {
  const auto given = c.verdicts.size();
  switch (c.outcome) {
    case Outcome::Calibrated:
      return "";
    case Outcome::TooFewViews:
      if (static_cast<int>(given) == c.distinct_views) {
        return fmt::format(
            "the board is seen in {} image{}, three are the least; take 10 to 20 with the board at "
            "different places and tilts",
            given, given == 1 ? "" : "s");
      }
      return fmt::format(
          "the board is seen in {} images, but only {} of them differ{}; move and tilt the board between "
          "images",
          given, c.distinct_views, c.distinct_views == 1 ? "s" : "");
    case Outcome::TooFewCorners:
      return fmt::format(
          "{} corners in {} images do not suffice for the lens; take more images, with more of the board in them",
          used_corners(c.fit.views), c.distinct_views);
    case Outcome::NoTilt:
      return fmt::format(
          "the board faces the camera alike in all {} images (within {:.1f} deg), so that focal length "
          "and distance cannot be told apart; tilt it by 30 to 45 deg in different directions",
          c.distinct_views, c.tilt_spread_rad / kDegree);
    case Outcome::Undetermined:
      return "the images do not determine the camera; tilt the board by 30 to 45 deg in different directions, fill the "
             "image with it, and check that --board says the right size";
    case Outcome::Stopped:
      return "stopped";
  }
  return "";
}

bool lens_fits(const ResidualField& field) {
  return field.systematic_px <= 0.33 * field.noise_px;
}

}  // namespace alidade
