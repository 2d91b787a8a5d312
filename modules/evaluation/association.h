// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/trajectory.h"

namespace alidade {

/// Two trajectories of the same length: pose i of one belongs to pose i of the other.
struct PairedTrajectories {
  Trajectory estimate;
  Trajectory truth;
};

struct AssociationOptions {
  double max_time_difference_s = 0.01;  ///< half the period of a 50 Hz truth; the same as evo's
  double time_offset_s = 0.0;           ///< added to the estimate's times before they are compared
};

/// Pairs each pose of the trajectory with fewer poses with the pose of the other that is nearest in time, at most
/// `max_time_difference_s` away; each pose is used once, by the nearer. Both must be in order of time. Empty
/// trajectories where none are near. The poses keep their own times.
/// Source: evo (core/sync.py, associate_trajectories), which lets a pose be used twice.
PairedTrajectories associate_by_time(const Trajectory& estimate, const Trajectory& truth,
                                     const AssociationOptions& options = {});

/// The shortest time between any pose of the estimate (its times moved by `time_offset_s`) and any of the truth, s:
/// what to tell where nothing associates. Infinite where one is empty.
double shortest_time_apart_s(const Trajectory& estimate, const Trajectory& truth, double time_offset_s);

}  // namespace alidade
