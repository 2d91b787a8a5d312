// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/board_images.h"
#include "calib/bundle/projection_uncertainty.h"
#include "calib/cameras/camera_calibration.h"
#include "calib/cameras/opencv_calibration.h"
#include "view/report.h"

namespace alidade {

/// A place in the image and how far a calibration's errors move what is seen there.
struct UncertainPlace {
  std::string name;  ///< "centre", "edge", "corner"
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  std::optional<double> near_px;  ///< standard deviation (larger axis) at the boards' distance
  std::optional<double> far_px;   ///< ten times as far
};

/// A calibration of one camera as it was run, for those who tell of it.
struct CameraCalibrationRun {
  BoardChoice board;
  BoardImages images;
  CameraCalibration result;
  std::optional<OpencvCalibration> opencv;  ///< from the same corners
  double calibration_s = 0;
  std::vector<std::string> warnings;
};

/// Centre, the middle of the right edge and the corner (a fiftieth of the width inside).
std::array<UncertainPlace, 3> uncertain_places(const BundleCovariance& covariance, const BundleFit& fit,
                                               const BundleFreedom& freedom, const BoardShape& shape, int camera);

/// What became of a view in words: "used", "3 of 54 corners cut", "rejected: most corners lie off, 1.2 px", ...
std::string describe(const ViewVerdict& verdict, const BoardView& view, const std::vector<BoardView>& views);

/// Adds what the user should know: guesses, views that were rejected, a lens that does not fit, poor coverage.
void add_warnings(CameraCalibrationRun& run);

/// One sentence that judges the calibration, and whether it is good.
struct CalibrationVerdict {
  bool is_good = false;
  std::string text;
};
CalibrationVerdict verdict_of(const CameraCalibrationRun& run);

/// The figures of a calibration, with a verdict each, for the report and the terminal.
std::vector<ReportRow> figure_rows(const CameraCalibrationRun& run);

/// The content of summary.json.
nlohmann::json summary_of(const CameraCalibrationRun& run);

}  // namespace alidade
