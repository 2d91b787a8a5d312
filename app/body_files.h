// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/result_directory.h"
#include "geometry/rigid_body.h"
#include "io/table.h"
#include "io/trajectory_writer.h"
#include "io/trc_file.h"
#include "marker1d/body_tracker.h"

namespace alidade {

/// What a method tells of a body that it tracks.
enum class PoseDetail {
  Pose,    ///< position and attitude
  Motion,  ///< with velocities and covariance
};

/// "lost", "ambiguous", "tracked".
std::string to_string(BodyStatus status);

/// Markers of several bodies as frames of one TRC file, whichever body is told of first.
class MarkerFrames {
 public:
  MarkerFrames(const std::filesystem::path& path, std::span<const RigidBody> bodies);

  /// Where body number `body` was at `time` (empty: nobody knows). Each body is told of each time, in order; a frame is
  /// written once all are, so that memory does not grow.
  void add(std::size_t body, Timestamp time, const std::optional<Eigen::Isometry3d>& T_world_body);

  /// Writes the frames that not all bodies were told of, too.
  void commit();

 private:
  struct Frame {
    std::vector<std::optional<Eigen::Vector3d>> p_world;
    std::size_t told = 0;  // bodies
  };
  void write_front();

  std::vector<RigidBody> bodies_;
  std::vector<std::size_t> first_;  // column of each body's first marker, and the number of all
  std::map<Timestamp, Frame> waiting_;
  TrcWriter writer_;
};

/// The files of poses that a body track leaves, written as estimates come: poses.csv (every batch of every body),
/// candidates.csv (of ambiguous batches, where there are any), markers.trc, and the tracked poses as trajectory.tum
/// with covariance.csv, or, of several bodies, NAME.tum with NAME.covariance.csv. Calls throw DeviceError where the
/// file system refuses.
class BodyFiles {
 public:
  /// Refers to the directory.
  BodyFiles(const ResultDirectory& directory, std::span<const RigidBody> bodies, PoseDetail detail);

  /// The estimates of each body come in order of time, and all bodies are told of every time. `readings`: how many the
  /// batch had.
  void add(std::size_t body, const BodyEstimate& estimate, std::size_t readings);

  void commit();

 private:
  void write_candidates(const std::string& name, const BodyEstimate& estimate);

  const ResultDirectory& directory_;
  PoseDetail detail_;
  std::vector<std::string> names_;
  TableWriter poses_;
  std::optional<TableWriter> candidates_;
  std::deque<TrajectoryWriter> trajectories_;
  MarkerFrames markers_;
};

}  // namespace alidade
