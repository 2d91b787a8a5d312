// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "calib/boards/board_view.h"
#include "calib/bundle/bundle_covariance.h"
#include "calib/cameras/held_out.h"
#include "calib/cameras/residual_field.h"
#include "core/progress.h"

namespace alidade {

struct CameraCalibrationOptions {
  std::optional<LensModel> lens;  ///< empty: the one with the least held-out error
  /// Whether the corners of the board are found too; empty: where that lowers the held-out error.
  std::optional<bool> free_corners;
  int folds = 4;                  ///< of the cross-validation
  double simpler_within = 1.02;   ///< a lens of fewer parameters is taken where its held-out error is at most this many
                                  ///< times the least
  double repeated_view_px = 1.0;  ///< views whose corners lie closer than this show nothing new
  double least_tilt_deg = 8.0;    ///< between two boards: below it the focal length is a guess
  double worst_focal_sigma = 0.05;  ///< standard deviation of fx (a share of it) above which there is no result
  BundleFitOptions fit;
};

/// Throws std::invalid_argument naming the field, its value and the bound.
void validate(const CameraCalibrationOptions& options);

enum class CameraCalibrationOutcome {
  Calibrated,
  TooFewViews,    ///< fewer than three that differ
  TooFewCorners,  ///< fewer than twice as many coordinates as parameters
  NoTilt,         ///< all boards face the camera alike
  Undetermined,   ///< the focal length or the equations are
  Stopped,
};

enum class ViewUse { Used, PartlyUsed, Rejected, Repeated };

/// What became of a view and why.
struct ViewVerdict {
  ViewUse use = ViewUse::Used;
  double rms_px = 0;  ///< of all its corners
  int outliers = 0;   ///< corners that were cut
  int repeats = -1;   ///< Repeated: the index of the view that it repeats
};

struct CameraCalibration {
  CameraCalibrationOutcome outcome = CameraCalibrationOutcome::Calibrated;
  Camera camera;
  CameraModel model;
  BundleFreedom freedom;
  BundleFit fit;  ///< of the views that are not Repeated; its frames are theirs in order
  BundleCovariance covariance;
  std::vector<LensTrial> trials;      ///< of the lenses that were tried
  std::vector<ViewVerdict> verdicts;  ///< one per view given
  std::vector<int> frame_of_view;     ///< into fit.views and T_rig_board; -1: Repeated
  ResidualField residuals;
  double rms_px = 0;      ///< of the corners that were used
  double rms_all_px = 0;  ///< of all
  std::optional<double> held_out_rms_px;
  double tilt_spread_rad = 0;
  int distinct_views = 0;
};

/// The intrinsics of the camera that took these views of a board, robustly, with covariance, the lens chosen by how it
/// does on views that it was not fitted to. Views name their images; ids out of the board's throw
/// std::invalid_argument. Deterministic.
CameraCalibration calibrate_camera(const ImageExtent& image, const Board& board, std::span<const BoardView> views,
                                   const CameraCalibrationOptions& options = {}, const ProgressSink& progress = {},
                                   const std::stop_token& stop = {});

/// Why there is no result and what to do, in a sentence; for Calibrated empty.
std::string explain(const CameraCalibration& calibration);

/// Whether what the lens leaves is hardly more than noise: a systematic part of at most a third of it.
bool lens_fits(const ResidualField& field);

}  // namespace alidade
