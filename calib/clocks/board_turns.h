// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/bundle/board_bundle.h"
#include "calib/clocks/board_film.h"

namespace alidade {

/// Where a board stood before a camera while it was filmed, in that camera's clock.
struct PlacedFilm {
  std::vector<double> time_s;
  std::vector<Eigen::Isometry3d> T_camera_board;
};

/// Places the board in views that lie at least `step_s` apart; those in which it cannot be placed are left out.
PlacedFilm place_film(const CameraFilm& film, const BoardShape& shape, const BoardWarp& warp, double step_s);

/// How far the board turned in all, rad: 90 % of the poses lie within it of the first one.
double turn_range_rad(const PlacedFilm& film);

/// How fast the board turned from one pose to the next, at the time between them. Poses more than `most_gap_s` apart
/// say nothing.
struct TurnRate {
  double time_s = 0;
  double rate_rad_s = 0;
};
std::vector<TurnRate> turn_rates(const PlacedFilm& film, double most_gap_s);

/// An offset at which two cameras saw the board turn alike: added to the second one's times it gives the first one's.
struct TurnMatch {
  double offset_s = 0;
  double correlation = 0;
  double overlap_s = 0;
};

struct TurnMatchOptions {
  double step_s = 0.04;          ///< of the offsets; hands turn a board slowly, so that the peak is far wider
  double least_overlap_s = 3.0;  ///< shorter films of smooth motion resemble each other by chance
  double apart_s = 0.2;          ///< of one match from the next
  int most = 6;
};

/// The offsets at which the turn rates of two films correlate, from the most significant (Fisher's z) on. The speed of
/// turning is the same from everywhere, so neither poses of the cameras nor a start is needed; motion that repeats
/// itself has several.
std::vector<TurnMatch> match_turns(std::span<const TurnRate> first, std::span<const TurnRate> second,
                                   const TurnMatchOptions& options = {});

/// How the second camera stands to the first at an offset, and by how many of the moments at which the board moves.
struct PoseAgreement {
  Eigen::Isometry3d T_first_second = Eigen::Isometry3d::Identity();
  double share = 0;  ///< of the moments whose pose is within 0.1 rad and a tenth of the board's distance of it
  int moments = 0;
};

/// Empty where fewer than six moments are shared.
std::optional<PoseAgreement> agree_on_pose(const PlacedFilm& first, const PlacedFilm& second, double offset_s,
                                           double most_gap_s);

}  // namespace alidade
