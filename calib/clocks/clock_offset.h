// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "calib/clocks/board_turns.h"
#include "calib/clocks/clock_refinement.h"

namespace alidade {

struct ClockOffsetOptions {
  double pose_step_s = 0.06;     ///< between poses that turn rates come from: shorter, and noise looks like turning
  double pose_gap_s = 0.3;       ///< between poses beyond it nothing is known of the board
  double least_turn_rad = 0.15;  ///< a board that turns less in all tells no time
  double least_share = 0.5;      ///< of the moments that agree on how the cameras stand to each other
  double other_share = 0.8;      ///< another offset at which so many as at the best one agree is as good
  double worst_scale = 10.0;     ///< residuals in units of sigma_px: frames of different moments leave tens of pixels
  double worst_sigma_s = 0.005;  ///< a standard deviation above it is no result
  TurnMatchOptions matches{};
  ClockRefinementOptions refinement{};
};

/// Throws std::invalid_argument naming the field, its value and the bound.
void validate(const ClockOffsetOptions& options);

enum class ClockOffsetOutcome {
  Found,
  TooFewViews,     ///< of the board in either film
  HardlyMoves,     ///< the board
  NoCommonMotion,  ///< the films do not overlap, or too little
  Ambiguous,       ///< the motion repeats itself
  Undetermined,    ///< the offset is found too loosely
};

struct ClockOffset {
  ClockOffsetOutcome outcome = ClockOffsetOutcome::Found;
  double offset_s = 0;  ///< added to the second camera's times it gives the first one's
  double sigma_s = 0;
  Eigen::Isometry3d T_first_second = Eigen::Isometry3d::Identity();
  Matrix6d pose_covariance = Matrix6d::Zero();  ///< of xi in T_first_second * exp(xi), m², rad²
  int moments = 0;
  double rms_px = 0;
};

/// By how much the clocks of two cameras differ that filmed a board that moved before them, each with its own frame
/// rate: first from how fast the board turned (the same from everywhere), whatever the offset, then by refine_tie.
/// Both lenses are taken as known, both clocks as equally fast, both shutters as global. Deterministic.
ClockOffset find_clock_offset(const FilmedBoard& board, const CameraFilm& first, const CameraFilm& second,
                              const ClockOffsetOptions& options = {});

/// Why there is no offset and what to do, in a sentence; for Found empty.
std::string explain(ClockOffsetOutcome outcome);

}  // namespace alidade
