// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "camera/measurement.h"
#include "uav/target_state.h"

namespace alidade {

/// Where two lines of sight pass each other closest.
struct PairFix {
  double r1_m = 0.0, r2_m = 0.0;                      ///< ranges along the first and the second; may be negative
  double residual_m2 = 0.0;                           ///< J: the squared distance between the lines
  double angle_rad = 0.0;                             ///< between the lines, [0, π/2]
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< on the first line, m
  /// Of p_world from the bearings' noise, m²; to first order, about lines that meet.
  Eigen::Matrix3d covariance_world = Eigen::Matrix3d::Zero();
};

/// The ranges of a target from two bearings, by the closed form; `displacement_m` is how far it has moved from the
/// first bearing's time to the second's. Empty for lines that are parallel to 1e-6 rad. Throws std::invalid_argument
/// for a direction that is not of unit length, or for a NaN.
/// Source: UAV paper eqs. 4, 6 (no displacement), 8 and 9.
std::optional<PairFix> solve_pair(const Bearing& first, const Bearing& second,
                                  const Eigen::Vector3d& displacement_m = Eigen::Vector3d::Zero());

/// What a target is taken to do between the bearings of one period.
enum class PaperMotion { Still, Velocity, Acceleration };

/// The state of a target from bearings of one period, and how well it is determined.
struct PaperFix {
  /// At the first bearing's time. The covariance is from the bearings' noise, to first order; where the system is
  /// singular it is 1e8 (m², m²/s² ...) along what is not determined.
  TargetState state;
  std::vector<double> ranges_m;  ///< of each bearing; may be negative
  double residual_m2 = 0.0;  ///< ‖A X − B‖²; 0 but for rounding where there are as many equations as unknowns
  double condition = 0.0;    ///< greatest over least singular value of A
  bool is_ill_conditioned = false;  ///< condition above 1e4: what the bearings do not tell was set to 0 (A⁺ B)
};

/// How few bearings tell so much: 2, 3 and 5.
int least_bearings(PaperMotion motion);

/// The state of a target from one bearing each of n receivers at their own times: 3 (n − 1) equations in n ranges and
/// the 0, 3 or 6 unknowns of the motion; by least squares, by the pseudo-inverse where they are singular. Empty for
/// fewer than least_bearings. Throws as solve_pair does.
/// Source: UAV paper eqs. 8, 10 and 11 (matrices for n receivers and acceleration: derived).
std::optional<PaperFix> solve_conjugation(std::span<const Bearing> bearings, PaperMotion motion);

/// The same in the paper's two steps: the motion from all bearings, then the range from the first two with b₂ replaced
/// by b₂ − V Δt₂ (− A Δt₂²/2). The second step changes what the singular systems answer, and those alone; with four
/// and more bearings it is left out elsewhere, since it would forget what the others say of the range.
std::optional<PaperFix> solve_in_two_steps(std::span<const Bearing> bearings, PaperMotion motion);

}  // namespace alidade
