// SPDX-License-Identifier: Apache-2.0
#include "app/camera_calibration_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/boards/board_text.h"

namespace alidade {
namespace {

constexpr double kGoodPixel = 0.5;      // px: an uncertainty that most uses do not notice
constexpr double kLeastCoverage = 0.5;  // of the image's cells

std::optional<double> sigma_px(const std::optional<Eigen::Matrix2d>& covariance) {
  if (!covariance) return std::nullopt;
  return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(*covariance).eigenvalues()[1]));
}

std::array<UncertainPlace, 3> places_of(const CameraCalibrationRun& run) {
  return uncertain_places(run.result.covariance, run.result.fit, run.result.freedom, shape_of(run.board.board), 0);
}

int count_use(const CameraCalibration& calibration, ViewUse use) {
  return static_cast<int>(std::count_if(calibration.verdicts.begin(), calibration.verdicts.end(),
                                        [use](const ViewVerdict& v) { return v.use == use; }));
}

std::string number(const std::optional<double>& value, const char* format = "{:.3f}") {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::vector<ReportRow> error_rows(const CameraCalibrationRun& run) {
  const CameraCalibration& c = run.result;
  std::vector<ReportRow> rows;
  rows.push_back({"reprojection error, RMS of the corners used", fmt::format("{:.3f}", c.rms_px), "px"});
  if (c.held_out_rms_px) {
    const bool is_good = *c.held_out_rms_px < 1.5 * c.rms_all_px + 0.05;
    rows.push_back({"on images left out, RMS of all corners", fmt::format("{:.3f}", *c.held_out_rms_px), "px",
                    is_good ? Verdict::Good : Verdict::Poor,
                    is_good ? "the lens was not fitted to noise" : "much worse than on its own images: take more"});
  }
  if (run.opencv) {
    rows.push_back({"OpenCV on the same corners, RMS", fmt::format("{:.3f}", run.opencv->rms_px), "px", Verdict::None,
                    fmt::format("all corners, five coefficients; ours: {:.3f}", c.rms_all_px)});
  }
  const bool fits = lens_fits(c.residuals);
  rows.push_back({"systematic error that the lens leaves", fmt::format("{:.3f}", c.residuals.systematic_px), "px",
                  fits ? Verdict::Good : Verdict::Poor,
                  fits ? "the lens model fits" : "the lens model does not fit: see the residuals over the image"});
  return rows;
}

std::vector<ReportRow> camera_rows(const CameraCalibrationRun& run) {
  const CameraCalibration& c = run.result;
  const Eigen::VectorXd sigma = intrinsics_sigma(c.covariance, BundleLayout(c.fit.bundle, c.freedom), 0);
  std::vector<ReportRow> rows{
      {"lens", std::string(name_of(c.model.lens)), "", Verdict::None,
       c.model.free_corners ? "with the true places of the board's corners, which lowers the error left out" : ""}};
  const auto names = intrinsics_names(c.camera);
  const Intrinsics values = intrinsics(c.camera);
  const std::vector<int> free = c.freedom.intrinsics.front();
  for (std::size_t i = 0; i < 4; ++i) {
    rows.push_back({names[static_cast<std::size_t>(free[i])],
                    fmt::format("{:.3f} ± {:.3f}", values[free[i]], sigma[static_cast<Eigen::Index>(i)]), "px"});
  }
  return rows;
}

std::vector<ReportRow> uncertainty_rows(const CameraCalibrationRun& run) {
  std::vector<ReportRow> rows;
  for (const UncertainPlace& place : places_of(run)) {
    const bool is_good = place.near_px && *place.near_px < kGoodPixel;
    rows.push_back({"uncertainty of a pixel, " + place.name, number(place.near_px), "px",
                    is_good ? Verdict::Good : Verdict::Poor,
                    fmt::format("one standard deviation; ten times as far: {}", number(place.far_px))});
  }
  return rows;
}

}  // namespace

std::array<UncertainPlace, 3> uncertain_places(const BundleCovariance& covariance, const BundleFit& fit,
                                               const BundleFreedom& freedom, const BoardShape& shape, int camera) {
  const Camera& c = fit.bundle.cameras[static_cast<std::size_t>(camera)].camera;
  const double right = 0.98 * (c.width - 1), bottom = 0.98 * (c.height - 1);
  std::array<UncertainPlace, 3> places{{{"centre", {0.5 * (c.width - 1), 0.5 * (c.height - 1)}, {}, {}},
                                        {"edge", {right, 0.5 * (c.height - 1)}, {}, {}},
                                        {"corner", {right, bottom}, {}, {}}}};
  const double distance_m = median_distance_m(fit, shape, camera);
  for (UncertainPlace& place : places) {
    const auto at = [&](double d) {
      return sigma_px(pixel_covariance(covariance, fit.bundle, freedom, camera, place.pixel, d));
    };
    place.near_px = at(distance_m);
    place.far_px = at(10.0 * distance_m);
  }
  return places;
}

std::string describe(const ViewVerdict& verdict, const BoardView& view, const std::vector<BoardView>& views) {
  switch (verdict.use) {
    case ViewUse::Used:
      return "used";
    case ViewUse::PartlyUsed:
      return fmt::format("used; {} of {} corners lie off and were cut", verdict.outliers, view.corners.size());
    case ViewUse::Rejected:
      return fmt::format("rejected: {} of {} corners lie off, RMS {:.2f} px; blurred, moved or wrongly found",
                         verdict.outliers, view.corners.size(), verdict.rms_px);
    case ViewUse::Repeated:
      return fmt::format("left out: shows the same as {}", views[static_cast<std::size_t>(verdict.repeats)].name);
  }
  return "";
}

void add_warnings(CameraCalibrationRun& run) {
  const CameraCalibration& c = run.result;
  auto& warnings = run.warnings;
  if (run.board.is_guessed) {
    warnings.push_back(
        fmt::format("the board was guessed: {} (--board {})", describe(run.board.board), board_text(run.board.board)));
  }
  for (std::size_t i = 0; i < c.verdicts.size(); ++i) {
    if (c.verdicts[i].use != ViewUse::Rejected && c.verdicts[i].use != ViewUse::Repeated) continue;
    warnings.push_back(run.images.views[i].name + ": " +
                       describe(c.verdicts[i], run.images.views[i], run.images.views));
  }
  if (!lens_fits(c.residuals)) {
    warnings.push_back(
        fmt::format("the lens '{}' does not fit: {:.3f} px of systematic error remain beside {:.3f} px "
                    "of noise",
                    name_of(c.model.lens), c.residuals.systematic_px, c.residuals.noise_px));
  }
  if (c.covariance.within_views > 1) {
    warnings.push_back(
        fmt::format("corners of an image err together (a board that is not flat, motion, light): "
                    "uncertainties are {:.1f} times those of independent errors",
                    std::sqrt(c.covariance.within_views)));
  }
  if (c.covariance.left_out > 1) {
    warnings.push_back(
        fmt::format("images left out err {:.1f} times as much as those that were fitted: uncertainties "
                    "are enlarged as much; take more images",
                    std::sqrt(c.covariance.left_out)));
  }
  if (coverage(c.residuals) < kLeastCoverage) {
    warnings.push_back(fmt::format("corners cover {:.0f} % of the image; show the board at its edges and corners too",
                                   100.0 * coverage(c.residuals)));
  }
}

CalibrationVerdict verdict_of(const CameraCalibrationRun& run) {
  const auto places = places_of(run);
  const CameraCalibration& c = run.result;
  if (!lens_fits(c.residuals)) return {false, "usable with care: the lens model does not fit"};
  const auto poor = std::find_if(places.begin(), places.end(),
                                 [](const auto& place) { return !(place.near_px && *place.near_px < kGoodPixel); });
  if (poor == places.end()) return {true, "good: every pixel is known to better than half a pixel"};
  return {false, fmt::format("weak at the image's {}: take images with the board there", poor->name)};
}

std::vector<ReportRow> figure_rows(const CameraCalibrationRun& run) {
  const CameraCalibration& c = run.result;
  const CalibrationVerdict verdict = verdict_of(run);
  std::vector<ReportRow> rows{
      {"verdict", verdict.text, "", verdict.is_good ? Verdict::Good : Verdict::Poor},
      {"board", describe(run.board.board), "", Verdict::None, run.board.is_guessed ? "guessed" : ""},
      {"images", fmt::format("{}", run.images.images.size()), "", Verdict::None,
       fmt::format("{} with the board, {} used", run.images.seen,
                   count_use(c, ViewUse::Used) + count_use(c, ViewUse::PartlyUsed))}};
  for (const auto& more : {error_rows(run), camera_rows(run), uncertainty_rows(run)}) {
    rows.insert(rows.end(), more.begin(), more.end());
  }
  const bool covers = coverage(c.residuals) >= kLeastCoverage;
  rows.push_back({"image covered by corners", fmt::format("{:.0f}", 100.0 * coverage(c.residuals)), "%",
                  covers ? Verdict::Good : Verdict::Poor, ""});
  rows.push_back({"largest angle between two boards",
                  fmt::format("{:.0f}", c.tilt_spread_rad * 180.0 / std::numbers::pi), "deg",
                  c.tilt_spread_rad > 0.5 ? Verdict::Good : Verdict::Poor, "30 and more fix the focal length"});
  return rows;
}

nlohmann::json summary_of(const CameraCalibrationRun& run) {
  const CameraCalibration& c = run.result;
  const Eigen::VectorXd sigma = intrinsics_sigma(c.covariance, BundleLayout(c.fit.bundle, c.freedom), 0);
  nlohmann::json summary{{"source", run.images.source},
                         {"board", board_text(run.board.board)},
                         {"board_guessed", run.board.is_guessed},
                         {"images", run.images.images.size()},
                         {"images_with_board", run.images.seen},
                         {"lens", name_of(c.model.lens)},
                         {"free_corners", c.model.free_corners},
                         {"rms_px", c.rms_px},
                         {"rms_all_px", c.rms_all_px},
                         {"lens_fits", lens_fits(c.residuals)},
                         {"systematic_px", c.residuals.systematic_px},
                         {"noise_px", c.residuals.noise_px},
                         {"variance_within_views", c.covariance.within_views},
                         {"coverage", coverage(c.residuals)},
                         {"board_warp_m", {c.fit.bundle.warp.x_m, c.fit.bundle.warp.y_m}},
                         {"calibration_s", run.calibration_s},
                         {"verdict", verdict_of(run).text},
                         {"warnings", run.warnings}};
  if (c.held_out_rms_px) summary["held_out_rms_px"] = *c.held_out_rms_px;
  if (run.opencv) summary["opencv_rms_px"] = run.opencv->rms_px;
  const auto names = intrinsics_names(c.camera);
  const Intrinsics values = intrinsics(c.camera);
  for (Eigen::Index i = 0; i < sigma.size(); ++i) {
    const int place = c.freedom.intrinsics.front()[static_cast<std::size_t>(i)];
    const std::string& name = names[static_cast<std::size_t>(place)];
    summary["intrinsics"][name] = {{"value", values[place]}, {"sigma", sigma[i]}};
  }
  for (const LensTrial& trial : c.trials) {
    summary["lenses"].push_back({{"lens", name_of(trial.model.lens)},
                                 {"free_corners", trial.model.free_corners},
                                 {"rms_px", trial.training_rms_px},
                                 {"held_out_rms_px", trial.held_out_rms_px}});
  }
  for (const UncertainPlace& place : places_of(run)) {
    if (place.near_px) summary["pixel_sigma_px"][place.name] = {{"near", *place.near_px}, {"far", *place.far_px}};
  }
  for (std::size_t i = 0; i < c.verdicts.size(); ++i) {
    summary["views"].push_back({{"image", run.images.views[i].name},
                                {"rms_px", c.verdicts[i].rms_px},
                                {"verdict", describe(c.verdicts[i], run.images.views[i], run.images.views)}});
  }
  return summary;
}

}  // namespace alidade
