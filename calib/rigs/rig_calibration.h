// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "calib/cameras/camera_calibration.h"

namespace alidade {

/// What one camera of a rig saw. `frame` of a view is the moment, the same number for all cameras that looked then.
struct RigCameraViews {
  std::string name;
  ImageExtent image;
  std::vector<BoardView> views;
};

enum class RigCalibrationOutcome {
  Calibrated,
  CameraFailed,  ///< a camera alone has no calibration
  Untied,        ///< a camera shares no moment with the others
  Disagreeing,   ///< what the cameras show at one moment is not one board
  Undetermined,
  Stopped,
};

/// How well the rays of two cameras to the same corners meet.
struct PairError {
  int first = 0, second = 0;
  int corners = 0;             ///< that both saw at the same moment
  double epipolar_rms_px = 0;  ///< distance of a corner from the other's epipolar line, both ways
  double baseline_m = 0;
  double baseline_sigma_m = 0;
};

struct RigCalibration {
  RigCalibrationOutcome outcome = RigCalibrationOutcome::Calibrated;
  std::vector<CameraCalibration> alone;  ///< each camera by itself; the joint fit starts from there
  std::vector<int> failed;               ///< CameraFailed, Untied, Disagreeing: which
  BundleFreedom freedom;
  BundleFit fit;  ///< jointly; frames as the given views number them
  BundleCovariance covariance;
  std::vector<double> camera_rms_px;     ///< of the corners used, by camera
  std::vector<ResidualField> residuals;  ///< by camera
  std::vector<PairError> pairs;          ///< that share moments
  double rms_px = 0, rms_all_px = 0;
  double solve_s = 0;  ///< processor time of the joint fit
};

/// Intrinsics and poses of several cameras, jointly, from views of one board; not all need see it at once. The rig is
/// the first camera's frame. Deterministic.
RigCalibration calibrate_rig(const Board& board, std::span<const RigCameraViews> cameras,
                             const CameraCalibrationOptions& options = {}, const ProgressSink& progress = {},
                             const std::stop_token& stop = {});

/// Why there is no result and what to do, naming the camera; for Calibrated empty.
std::string explain(const RigCalibration& calibration, std::span<const RigCameraViews> cameras);

/// Covariance (m², rad²) of xi in T_rig_camera * exp(xi) of camera `index`, >= 1.
Matrix6d camera_pose_covariance(const RigCalibration& calibration, int index);

}  // namespace alidade
