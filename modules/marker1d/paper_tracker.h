// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/time.h"
#include "geometry/rigid_body.h"
#include "marker1d/marker_plane.h"
#include "marker1d/paper_motion.h"
#include "marker1d/paper_pose.h"

namespace alidade {

// The seed paper's method, the baseline beside ours: its rules are kept where better ones are known.
// Source: marker1d paper page, "The seed's algorithm".

struct PaperTrackerOptions {
  int least_planes = 6;    ///< fewer are filled up by extrapolated marker positions
  double rejection = 3.0;  ///< planes farther off than this many mean distances are left out of the second solution
  int memory = 100;  ///< poses by which velocity and acceleration are known; the paper is silent. Of 3 to 250, 100
                     ///< at 250 Hz gives the least errors under occlusion; with 3 they grow beyond all bounds
  double least_spread = 0.02;  ///< of the normals (PaperCost::spread); below, the frame is flagged: one block has 0.005
  bool is_weighted = false;    ///< planes count by MarkerPlane::weight; the paper's count alike
  PaperPoseOptions newton;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const PaperTrackerOptions& options);

enum class PaperOutcome {
  Solved,        ///< by the frame's own planes
  Padded,        ///< with planes through extrapolated markers
  Extrapolated,  ///< Newton found no minimum: the poses before go on
  Lost,          ///< there is nothing to extrapolate either
};

/// One frame's answer.
struct PaperStep {
  Timestamp time{};
  PaperOutcome outcome = PaperOutcome::Lost;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();  ///< not to be looked at where Lost
  bool is_degenerate = false;  ///< the normals hardly span space, as of one block alone: the pose is not to be trusted
  int plane_count = 0;         ///< of the frame, without padding
  int rejected_count = 0;
  int newton_steps = 0;   ///< of the first solution
  double unseen_s = 0.0;  ///< since the last frame that was Solved; 0 there
};

/// Pose after pose of one body, frame by frame. Frames may follow each other forward or backward in time.
class PaperTracker {
 public:
  /// Throws std::invalid_argument for a body without markers and as validate does.
  explicit PaperTracker(RigidBody body, const PaperTrackerOptions& options = {});

  /// Begins at a known pose, with nothing known of its motion.
  void start(Timestamp time, const Eigen::Isometry3d& T_world_body);

  /// Where the body is expected at `time`; empty before the first pose.
  std::optional<Eigen::Isometry3d> predicted(Timestamp time) const;

  /// The pose at a frame from its planes. Without a pose yet, or where Newton fails from the extrapolated one, it is
  /// sought from many starts. Throws std::invalid_argument for a plane of a marker that the body does not have.
  PaperStep step(Timestamp time, std::span<const MarkerPlane> planes);

 private:
  std::vector<MarkerPlane> with_padding(Timestamp time, std::span<const MarkerPlane> planes) const;
  // Both write down in `step` how it went.
  std::optional<Eigen::Isometry3d> solve_twice(std::span<const MarkerPlane> planes, PaperStep& step) const;
  std::optional<Eigen::Isometry3d> solve(const PaperSums& sums, const std::optional<Eigen::Isometry3d>& expected,
                                         PaperStep& step) const;
  double weight_of(const MarkerPlane& plane) const { return options_.is_weighted ? plane.weight : 1.0; }

  RigidBody body_;
  PaperTrackerOptions options_;
  PaperMotion motion_;
  std::optional<Timestamp> solved_;  // the last frame that was
};

/// A frame of a recording.
struct PaperFrame {
  Timestamp time{};
  std::vector<MarkerPlane> planes;
};

/// The poses of a recording refined by what came later: the method is run from the last frame back to the first, and
/// the two answers for a frame are averaged, each the less the longer before it had its last solved frame. A frame that
/// both ways solved from the same planes stays as it was. `forward`: the tracker's steps, one per frame
/// (std::invalid_argument).
std::vector<PaperStep> refine_backward(const RigidBody& body, std::span<const PaperFrame> frames,
                                       std::span<const PaperStep> forward, const PaperTrackerOptions& options = {});

}  // namespace alidade
