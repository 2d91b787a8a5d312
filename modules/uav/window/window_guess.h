// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "uav/window/window_scans.h"

namespace alidade {

/// A straight motion through few bearings, quickly: where at two moments, and how surely.
struct MotionGuess {
  double t0_s = 0.0, t1_s = 0.0;
  Eigen::Vector3d p0 = Eigen::Vector3d::Zero(), p1 = Eigen::Vector3d::Zero();  ///< m, from the window's anchor
  double variance0_m2 = 0.0, variance1_m2 = 0.0;                               ///< of a coordinate
};

/// Through three bearings of three moments in order of time: three equations of the three ranges, because the middle
/// place divides the way between the others as its time does. Empty where they tell no place within the window's
/// options: lines of sight near to one plane, behind a receiver, too far, too fast.
std::optional<MotionGuess> guess_of_three(const BearingWindow& window, const std::array<std::size_t, 3>& bearings);

/// Through two pairs of bearings, each pair by two receivers at about the same time: the lines of sight of a pair meet
/// once the second's is moved by what the target flies between. Empty as above, and where they do not meet.
/// Source: UAV paper eqs. 4, 5 and 9.
std::optional<MotionGuess> guess_of_pairs(const BearingWindow& window, const std::array<std::size_t, 4>& bearings);

/// Whether two lines of sight pass each other as near as a target may fly between their times. Source: UAV paper eq. 9.
bool may_meet(const BearingWindow& window, std::size_t first, std::size_t second);

/// Free bearings near a guess, at most one per scan, and how much they speak for it.
struct Support {
  std::vector<std::size_t> bearings;
  double log_ratio = 0.0;  ///< of the guess being a target, by scans with and without a bearing near it
};

/// Among which bearings support is sought, and how much of it is enough: log-likelihood ratios.
struct SupportSearch {
  const std::vector<char>& is_free;  ///< by bearing
  double chance;                     ///< of a free bearing near a wrong guess
  double refuted;                    ///< a guess below it is given up at once
  double supported;                  ///< what a guess needs in the end
};

/// `scans` in the order in which they are asked; empty as soon as they speak against the guess.
std::optional<Support> find_support(const BearingWindow& window, const MotionGuess& guess,
                                    std::span<const std::size_t> scans, const SupportSearch& search);

}  // namespace alidade
