// SPDX-License-Identifier: Apache-2.0
#include "app/result_picture.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "evaluation/association.h"
#include "geometry/alignment.h"
#include "io/camera_file.h"
#include "io/map_file.h"
#include "io/trajectory_file.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

std::vector<Eigen::Vector3d> centres_of(const Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> centres;
  for (const auto& pose : trajectory) centres.push_back(pose.T_world_camera.translation());
  return centres;
}

// The truth in the frame of the estimate; empty where the two do not determine a similarity.
std::optional<Trajectory> into_frame_of(const Trajectory& estimate, const Trajectory& truth) {
  const PairedTrajectories pairs = associate_by_time(estimate, truth);
  const auto similarity = align_points(centres_of(pairs.truth), centres_of(pairs.estimate), AlignmentKind::Similarity);
  if (!similarity) return std::nullopt;
  return transform(*similarity, truth);
}

void add_truth(ResultPicture& result, const fs::path& path) {
  const Trajectory truth = read_trajectory(path).poses;
  result.picture.truth = result.picture.estimate.empty() ? truth : into_frame_of(result.picture.estimate, truth);
  if (result.picture.truth) return;
  result.warnings.push_back(
      fmt::format("the truth of {} is not drawn: fewer than 3 poses are near in time to the "
                  "estimate's, or all lie on one line",
                  path.string()));
}

}  // namespace

ResultPicture read_result_picture(const fs::path& result, const fs::path& truth) {
  ResultPicture drawn;
  if (!fs::is_directory(result)) {
    drawn.picture.estimate = read_trajectory(result).poses;
    if (!truth.empty()) add_truth(drawn, truth);
    return drawn;
  }
  if (fs::exists(result / "trajectory.tum")) drawn.picture.estimate = read_trajectory(result / "trajectory.tum").poses;
  if (fs::exists(result / "map.ply")) drawn.picture.map = read_map_ply(result / "map.ply");
  if (fs::exists(result / "camera.yaml")) drawn.picture.camera = read_camera(result / "camera.yaml");
  if (!truth.empty()) {
    add_truth(drawn, truth);
  } else if (fs::exists(result / "truth.tum")) {
    add_truth(drawn, result / "truth.tum");
  }
  if (drawn.picture.estimate.empty() && !drawn.picture.truth && drawn.picture.map.points.empty()) {
    throw InputError(result.string(), 0, "holds nothing to draw",
                     "give a result directory with trajectory.tum, truth.tum or map.ply, or a trajectory file");
  }
  return drawn;
}

}  // namespace alidade
