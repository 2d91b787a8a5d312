// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <mutex>

#include <Eigen/LU>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/board_simulation.h"
#include "app/experiments/calibration_experiment.h"
#include "calib/boards/board_detection.h"
#include "calib/bundle/projection_uncertainty.h"
#include "calib/cameras/camera_calibration.h"

namespace alidade {
namespace {

constexpr double k90Percent = 4.605;  // chi square of two degrees of freedom

struct CoveragePlace {
  const char* name;
  Eigen::Vector2d pixel;
  int covered = 0, counted = 0;
  double squares = 0, stated = 0;  // px², of errors and of what is said of them
};

struct CoverageTally {
  std::array<CoveragePlace, 3> places{{{"centre", {319.5, 239.5}}, {"edge", {632, 239.5}}, {"corner", {632, 472}}}};
  int sets = 0, failed = 0;
  double focal_error = 0, focal_squares = 0;  // shares of fx
};

BoardSimulationOptions scene(unsigned seed) {
  BoardSimulationOptions options;
  options.board = {BoardKind::Chessboard, 9, 6, 0.025};
  options.camera = {640, 480, 531, 530, 325, 236, BrownConrady{-0.27, 0.09, 0.001, -0.0005}, 0};
  options.images = 20;
  options.rendering.blur_px = 0.6;
  options.rendering.noise_grey = 4;
  options.seed = seed;
  return options;
}

// Where a point that truly lies at `pixel` is imaged by the calibration: carried over by all boards, whose true and
// found poses are known (the mean of what they say).
std::optional<Eigen::Vector2d> found_pixel(const CameraCalibration& c, const BoardSimulation& simulation,
                                           const std::vector<int>& images, const Eigen::Vector3d& p_camera) {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t view = 0; view < images.size(); ++view) {
    if (c.frame_of_view[view] < 0) continue;
    const Eigen::Vector3d p_board = simulation.T_board_camera(images[view]) * p_camera;
    p += c.fit.bundle.T_rig_board[static_cast<std::size_t>(c.frame_of_view[view])] * p_board;
    ++count;
  }
  const auto seen = project(c.camera, p / count);
  return seen ? std::optional(seen->pixel) : std::nullopt;
}

void add(const CameraCalibration& c, const BoardSimulation& simulation, const std::vector<int>& images,
         const Camera& truth, const BoardShape& shape, CoverageTally& tally) {
  const double distance_m = median_distance_m(c.fit, shape, 0);
  const double focal_error = c.camera.fx / truth.fx - 1.0;
  tally.focal_error += focal_error;
  tally.focal_squares += focal_error * focal_error;
  for (CoveragePlace& place : tally.places) {
    const auto direction = unproject(truth, place.pixel);
    const auto found = found_pixel(c, simulation, images, distance_m * *direction);
    const auto C = pixel_covariance(c.covariance, c.fit.bundle, c.freedom, 0, place.pixel, distance_m);
    if (!found || !C) continue;
    const Eigen::Vector2d error = *found - place.pixel;
    place.covered += error.dot(C->inverse() * error) < k90Percent;
    place.squares += error.squaredNorm();
    place.stated += C->trace();
    ++place.counted;
  }
}

void try_set(unsigned seed, CoverageTally& tally, std::mutex& mutex) {
  const BoardSimulationOptions options = scene(seed);
  const BoardSimulation simulation(options);
  std::vector<BoardView> views;
  std::vector<int> images;
  for (int i = 0; i < simulation.count(); ++i) {
    auto view = detect_board(simulation.image(i), options.board);
    if (!view) continue;
    images.push_back(i);
    views.push_back(std::move(*view));
  }
  const auto c = calibrate_camera({options.camera.width, options.camera.height}, options.board, views);
  const std::scoped_lock lock(mutex);
  ++tally.sets;
  if (c.outcome != CameraCalibrationOutcome::Calibrated) {
    ++tally.failed;
    return;
  }
  add(c, simulation, images, options.camera, shape_of(options.board), tally);
}

}  // namespace

ExperimentSection calibration_coverage(const ExperimentContext& context) {
  CoverageTally tally;
  std::mutex mutex;
  tbb::parallel_for(0, context.runs, [&](int set) {
    if (context.stop.stop_requested()) return;
    try_set(context.seed * 100'003u + static_cast<unsigned>(set), tally, mutex);
    const std::scoped_lock lock(mutex);
    if (context.progress) context.progress({"coverage", tally.sets, context.runs, ""});
  });
  ExperimentSection section{
      "coverage",
      "Whether 90 % regions hold the truth",
      {"Sets of 20 rendered images of a chessboard through a known lens, with blur and noise, each "
       "calibrated by the automatic setting."},
      {},
      {},
      {}};
  const int good = std::max(1, tally.sets - tally.failed);
  ReportTable table{"Coverage", {"place", "held", "error, RMS (px)", "stated (px)"}, {}};
  for (const CoveragePlace& place : tally.places) {
    const double covered = static_cast<double>(place.covered) / std::max(1, place.counted);
    const double error_px = std::sqrt(place.squares / std::max(1, place.counted));
    const double stated_px = std::sqrt(place.stated / std::max(1, place.counted));
    section.summary["places"][place.name] = {{"covered", covered}, {"error_px", error_px}, {"stated_px", stated_px}};
    table.rows.push_back({place.name, fmt::format("{:.1f} %", 100 * covered), fmt::format("{:.4f}", error_px),
                          fmt::format("{:.4f}", stated_px)});
  }
  const double bias = tally.focal_error / good;
  const double spread = std::sqrt(tally.focal_squares / good);
  section.summary["sets"] = tally.sets;
  section.summary["failed"] = tally.failed;
  section.summary["focal_bias"] = bias;
  section.summary["focal_spread"] = spread;
  section.remarks.push_back(
      fmt::format("{} sets, {} without a result; focal length off by {:.4f} % in the mean, {:.3f} % "
                  "RMS",
                  tally.sets, tally.failed, 100 * bias, 100 * spread));
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
