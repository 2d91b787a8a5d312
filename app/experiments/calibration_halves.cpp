// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/board_images.h"
#include "app/experiments/calibration_experiment.h"
#include "calib/cameras/camera_calibration.h"
#include "calib/cameras/projection_difference.h"
#include "core/errors.h"

namespace alidade {
namespace {

constexpr double k90Percent = 4.605;  // chi square of two degrees of freedom

}  // namespace

ExperimentSection calibration_halves(const std::string& source, const std::string& board,
                                     const ExperimentContext& context) {
  const BoardChoice choice = choose_board(board, source);
  RunContext reading;
  reading.stop = context.stop;
  reading.progress = context.progress;
  reading.warn = [](const std::string&) {};
  const BoardImages images = read_board_images(source, choice.board, reading);
  std::array<std::vector<BoardView>, 2> halves;
  for (std::size_t i = 0; i < images.views.size(); ++i) halves[i % 2].push_back(images.views[i]);
  std::array<CameraCalibration, 2> calibrations;
  ReportTable table{"Halves", {"half", "images", "lens", "RMS (px)", "held out (px)", "fx (px)", "of it"}, {}};
  for (std::size_t h = 0; h < 2; ++h) {
    calibrations[h] = calibrate_camera(images.image, choice.board, halves[h]);
    const CameraCalibration& c = calibrations[h];
    if (c.outcome != CameraCalibrationOutcome::Calibrated) {
      throw InputError(source, 0, fmt::format("half {}: no calibration: {}", h + 1, explain(c)), "");
    }
    const double sigma = intrinsics_sigma(c.covariance, BundleLayout(c.fit.bundle, c.freedom), 0)[0];
    table.rows.push_back({std::to_string(h + 1), std::to_string(halves[h].size()), std::string(name_of(c.model.lens)),
                          fmt::format("{:.3f}", c.rms_px), fmt::format("{:.3f}", c.held_out_rms_px.value_or(NAN)),
                          fmt::format("{:.2f} ± {:.2f}", c.camera.fx, sigma),
                          fmt::format("{:.4f}", sigma / c.camera.fx)});
  }
  const auto gaps = compare_projections(calibrations[0], calibrations[1], choice.board);
  double squares = 0;
  int within = 0;
  for (const ProjectionGap& gap : gaps) {
    squares += gap.gap_px.squaredNorm();
    within += gap.chi2 < k90Percent;
  }
  const double count = std::max<double>(1, static_cast<double>(gaps.size()));
  ExperimentSection section{"halves", "Two halves of the images", {}, {table}, {}, {}};
  section.summary["share_within"] = within / count;
  section.summary["gap_rms_px"] = std::sqrt(squares / count);
  section.remarks.push_back(
      fmt::format("the two calibrations see a direction {:.3f} px apart (RMS over the image), "
                  "within their 90 % regions over {:.1f} % of it",
                  std::sqrt(squares / count), 100.0 * within / count));
  return section;
}

}  // namespace alidade
