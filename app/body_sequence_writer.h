// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "app/result_directory.h"
#include "datasets/body_scene.h"
#include "io/reading_file.h"
#include "io/trajectory_writer.h"

namespace alidade {

/// Writes a scene's frames as they come: body.csv, detectors.yaml, observations.csv and the true poses, T_world_body at
/// the frames' times: truth.tum, or truth_NAME.tum of each of several bodies. Throws DeviceError where the file system
/// refuses.
class BodySequenceWriter {
 public:
  BodySequenceWriter(const ResultDirectory& directory, const std::vector<LineDetector>& detectors,
                     const std::vector<RigidBody>& bodies);

  /// `T_world_body`: one per body.
  void add(const BodySceneFrame& frame, const std::vector<Eigen::Isometry3d>& T_world_body);

  /// Once, and last; what was added until then is a whole, shorter sequence.
  void finish();

 private:
  ReadingWriter readings_;
  std::vector<std::unique_ptr<TumWriter>> truth_;
};

/// The name of the file of a body's true poses.
std::string truth_file(const std::vector<RigidBody>& bodies, std::size_t body);

}  // namespace alidade
