// SPDX-License-Identifier: Apache-2.0
#include "app/camera_calibration_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "app/calibration_drawings.h"
#include "capture/undistortion.h"
#include "io/image_files.h"
#include "io/rig_file.h"
#include "io/table.h"
#include "view/overlay.h"

namespace alidade {
namespace {

constexpr int kMostBadViews = 6;

RigCamera calibrated_camera(const CameraCalibrationRun& run) {
  const CameraCalibration& c = run.result;
  RigCamera camera{"camera", c.camera};
  camera.intrinsics_covariance =
      intrinsics_covariance(c.covariance, BundleLayout(c.fit.bundle, c.freedom), c.camera, 0);
  return camera;
}

void write_views(const std::filesystem::path& path, const CameraCalibrationRun& run) {
  constexpr std::array<std::string_view, 5> kColumns{"image", "corners", "cut", "rms_px", "verdict"};
  TableWriter table(path, kColumns);
  for (std::size_t i = 0; i < run.result.verdicts.size(); ++i) {
    const ViewVerdict& verdict = run.result.verdicts[i];
    const BoardView& view = run.images.views[i];
    const std::vector<TableCell> cells{view.name, static_cast<int>(view.corners.size()), verdict.outliers,
                                       verdict.rms_px, describe(verdict, view, run.images.views)};
    table.write_row(cells);
  }
  table.commit();
}

ReportSection views_section(const CameraCalibrationRun& run, const ResultDirectory& directory) {
  std::vector<Bar> bars;
  ReportTable table{"", {"image", "corners", "RMS (px)", "what became of it"}, {}};
  for (std::size_t i = 0; i < run.result.verdicts.size(); ++i) {
    const ViewVerdict& verdict = run.result.verdicts[i];
    const BoardView& view = run.images.views[i];
    bars.push_back({view.name, verdict.rms_px, verdict.use != ViewUse::Used});
    table.rows.push_back({view.name, std::to_string(view.corners.size()), fmt::format("{:.3f}", verdict.rms_px),
                          describe(verdict, view, run.images.views)});
  }
  const cv::Mat picture = draw_bars("RMS of all corners, px, by image", bars);
  write_image(directory.path("views.png"), picture);
  return {"Images", {"Red: corners were cut, or the image left out."}, {}, {{picture, "", FigureFormat::Png}}, {table}};
}

ReportSection lenses_section(const CameraCalibrationRun& run) {
  ReportTable trials{"", {"lens", "board's corners", "RMS of its own images (px)", "RMS of images left out (px)"}, {}};
  for (const LensTrial& trial : run.result.trials) {
    trials.rows.push_back({std::string(name_of(trial.model.lens)), trial.model.free_corners ? "found" : "as printed",
                           fmt::format("{:.4f}", trial.training_rms_px), fmt::format("{:.4f}", trial.held_out_rms_px)});
  }
  ReportTable parameters{"", {"parameter", "value", "standard deviation"}, {}};
  const CameraCalibration& c = run.result;
  const Eigen::VectorXd sigma = intrinsics_sigma(c.covariance, BundleLayout(c.fit.bundle, c.freedom), 0);
  const auto names = intrinsics_names(c.camera);
  const Intrinsics values = intrinsics(c.camera);
  for (Eigen::Index i = 0; i < sigma.size(); ++i) {
    const int place = c.freedom.intrinsics.front()[static_cast<std::size_t>(i)];
    parameters.rows.push_back({names[static_cast<std::size_t>(place)], fmt::format("{:.6g}", values[place]),
                               fmt::format("{:.2g}", sigma[i])});
  }
  const auto& warp = c.fit.bundle.warp;
  return {"Lens",
          {"The lens was chosen by its error on images that it was not fitted to; the simplest of those that are "
           "equally good.",
           fmt::format("The board bulges by {:.3f} mm along its rows and {:.3f} mm along its columns.", 1e3 * warp.x_m,
                       1e3 * warp.y_m)},
          {},
          {},
          {trials, parameters}};
}

cv::Mat beside(const cv::Mat& left, const cv::Mat& right) {
  cv::Mat pair;
  cv::hconcat(left, right, pair);
  const double factor = std::min(1.0, 1400.0 / pair.cols);
  cv::resize(pair, pair, {}, factor, factor, cv::INTER_AREA);
  return pair;
}

}  // namespace

ReportSection camera_section(const FittedCamera& of, const Board& board, const std::string& prefix,
                             const ResultDirectory& directory) {
  const BoardShape shape = shape_of(board);
  const Camera& camera = of.fit.bundle.cameras[static_cast<std::size_t>(of.camera)].camera;
  const double distance_m = median_distance_m(of.fit, shape, of.camera);
  const UncertaintyMap map = uncertainty_map(of.covariance, of.fit.bundle, of.freedom, of.camera, distance_m);
  const std::vector<std::pair<std::string, cv::Mat>> pictures{
      {"coverage", draw_coverage(of.fit, of.camera)},
      {"uncertainty", draw_uncertainty(map, camera)},
      {"residuals", draw_residuals(of.fit, shape, of.residuals, of.camera)},
      {"radial", draw_plot(radial_residual_plot(of.fit, shape, of.camera), {720, 320})}};
  ReportSection section{"Pictures to judge by",
                        {"Uncertainty is what errors of this calibration do to a pixel; noise of the next measurement "
                         "comes on top. Residuals that point the same way in one part of the image are a lens that "
                         "does not fit."},
                        {},
                        {}};
  for (const auto& [name, picture] : pictures) {
    write_image(directory.path(prefix + name + ".png"), picture);
    section.figures.push_back({picture, "", FigureFormat::Png});
  }
  return section;
}

ReportSection undistorted_section(const Camera& camera, const cv::Mat& sample) {
  ReportSection section{"Without distortion", {}, {}, {}};
  const auto pinhole = undistorted_camera(camera);
  if (!pinhole || sample.empty()) {
    section.paragraphs = {"This lens sees too wide for one pinhole image: alidade undistort --focal-px."};
    return section;
  }
  const cv::Mat straight = undistorted_image(sample, undistortion_map(camera, *pinhole));
  section.figures.push_back({beside(sample, straight), "as taken, and undistorted", FigureFormat::Jpeg});
  return section;
}

ReportSection bad_views_section(const BundleFit& fit, int camera, const std::vector<BoardView>& views,
                                const std::vector<int>& frame_of_view, const BoardImages& images) {
  ReportSection section{"Images with corners that were cut", {"Green: used; red: cut."}, {}, {}};
  for (std::size_t i = 0; i < views.size() && static_cast<int>(section.figures.size()) < kMostBadViews; ++i) {
    const auto view = std::find_if(fit.views.begin(), fit.views.end(), [&](const BundleView& v) {
      return v.camera == camera && v.frame == frame_of_view[i];
    });
    if (view == fit.views.end() || std::count(view->weights.begin(), view->weights.end(), 0.0) == 0) continue;
    const cv::Mat& thumbnail = images.images[static_cast<std::size_t>(views[i].frame)].thumbnail;
    const double scale = static_cast<double>(thumbnail.cols) / images.image.width;
    Overlay overlay;
    overlay.status = views[i].name;
    for (std::size_t j = 0; j < view->corners.size(); ++j) {
      const Eigen::Vector2d pixel =
          scale * (view->corners[j].pixel + Eigen::Vector2d(0.5, 0.5)) - Eigen::Vector2d(0.5, 0.5);
      overlay.tracks.push_back({pixel, {}, view->weights[j] > 0 ? TrackState::Tracked : TrackState::Rejected, {}});
    }
    section.figures.push_back({draw_overlay(thumbnail, overlay), "", FigureFormat::Jpeg});
  }
  if (section.figures.empty()) section.paragraphs = {"None."};
  return section;
}

void write_corners(const std::filesystem::path& path, const BundleFit& fit, const BoardShape& shape, int camera,
                   const std::vector<std::string>& names_by_frame) {
  constexpr std::array<std::string_view, 8> kColumns{"image",    "corner",        "x_px",          "y_px",
                                                     "sigma_px", "residual_x_px", "residual_y_px", "used"};
  TableWriter table(path, kColumns);
  for (const BundleView& view : fit.views) {
    if (view.camera != camera) continue;
    const auto residuals = residuals_px(fit.bundle, shape, view);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const BoardCorner& corner = view.corners[i];
      const std::vector<TableCell> cells{names_by_frame[static_cast<std::size_t>(view.frame)],
                                         corner.id,
                                         corner.pixel.x(),
                                         corner.pixel.y(),
                                         corner.sigma_px,
                                         residuals[i].x(),
                                         residuals[i].y(),
                                         view.weights[i] > 0 ? 1 : 0};
      table.write_row(cells);
    }
  }
  table.commit();
}

void write_camera_calibration(const CameraCalibrationRun& run, const ResultDirectory& directory,
                              const std::vector<std::string>& arguments, const std::string& options_yaml) {
  const CameraCalibration& c = run.result;
  const BoardShape shape = shape_of(run.board.board);
  write_camera_rig(directory.path("camera.yaml"), CameraRig{{calibrated_camera(run)}});
  write_views(directory.path("views.csv"), run);
  std::vector<std::string> names(static_cast<std::size_t>(c.distinct_views));
  for (std::size_t i = 0; i < c.frame_of_view.size(); ++i) {
    if (c.frame_of_view[i] >= 0) names[static_cast<std::size_t>(c.frame_of_view[i])] = run.images.views[i].name;
  }
  write_corners(directory.path("corners.csv"), c.fit, shape, 0, names);
  Report report;
  report.title = "Calibration of a camera from " + run.images.source;
  report.arguments = arguments;
  report.summary = figure_rows(run);
  report.warnings = run.warnings;
  report.sections.push_back(
      camera_section({c.fit, c.freedom, c.covariance, c.residuals, 0}, run.board.board, "", directory));
  report.sections.push_back(views_section(run, directory));
  report.sections.push_back(bad_views_section(c.fit, 0, run.images.views, c.frame_of_view, run.images));
  report.sections.push_back(lenses_section(run));
  report.sections.push_back(undistorted_section(c.camera, run.images.sample));
  report.links = {{"camera.yaml", "the camera with its covariance, for every other verb"},
                  {"views.csv", "what became of each image"},
                  {"corners.csv", "every corner with its residual"}};
  report.options = options_yaml;
  directory.write_text("options.yaml", options_yaml);
  write_report(directory.path("report.html"), report);
}

}  // namespace alidade
