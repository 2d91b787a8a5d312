// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "calib/bundle/bundle_fit.h"
#include "calib/clocks/board_film.h"

namespace alidade {

/// How two cameras stand to each other in space and time.
struct CameraTie {
  double offset_s = 0;  ///< added to the second camera's times it gives the first one's
  Eigen::Isometry3d T_first_second = Eigen::Isometry3d::Identity();
};

/// The board that both filmed.
struct FilmedBoard {
  BoardShape shape;
  BoardWarp warp{};
};

struct ClockRefinementOptions {
  int most_moments = 300;     ///< evenly from the film; more take time and tell little
  double most_step_s = 0.04;  ///< of the offset at once: about a frame, since beyond it pixels do not move straight
  BundleFitOptions fit{};
};

struct RefinedTie {
  CameraTie tie;
  /// Of the offset, then of xi in T_first_second * exp(xi); s², m², rad². For lenses that are known exactly.
  Eigen::Matrix<double, 7, 7> covariance = Eigen::Matrix<double, 7, 7>::Zero();
  int moments = 0;    ///< that both saw
  double rms_px = 0;  ///< of the corners that were used
  double scale = 1;   ///< standard deviation of one coordinate in units of the corners' sigma_px, from the median
  bool converged = false;
};

/// The offset of the second camera's clock, its pose and the board's pose at moments of the first film that together
/// leave the least weighted squares, from a start within a few frames: the second camera's corners are those of its
/// film at that moment, which move by the corner's velocity per second of offset. Moments share no frame of the second
/// film, so that their errors are independent. Both shutters are taken as global. Empty where the films share fewer
/// than four moments or the equations determine no offset. Deterministic.
/// Source: after Furgale, Rehder and Siegwart 2013, "unified temporal and spatial calibration for multi-sensor
/// systems", with the board's pose free at every moment in place of a spline.
std::optional<RefinedTie> refine_tie(const FilmedBoard& board, const CameraFilm& first, const CameraFilm& second,
                                     const CameraTie& start, const ClockRefinementOptions& options = {});

}  // namespace alidade
