// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "geometry/trajectory.h"

namespace alidade {

/// How a trajectory was written down.
enum class TrajectoryFormat { Tum, Kitti, Euroc, SevenScenes, Strecha };

/// A trajectory as it was found. Rotations are made exactly orthonormal.
struct TrajectoryFile {
  std::filesystem::path path;  ///< the file, or the folder of one file per pose, that was read
  TrajectoryFormat format = TrajectoryFormat::Tum;
  /// False for a KITTI file, whose poses are counted and not timed: pose i is given the time i seconds.
  bool has_times = true;
  Trajectory poses;  ///< at least one
};

/// Reads a trajectory, its format recognised from the content:
/// - TUM: `timestamp[s] tx ty tz qx qy qz qw`;  EuRoC: `t[ns], x, y, z, qw, qx, qy, qz, ...` (the pose of its body
/// frame);
/// - KITTI: 12 numbers, the rows of [R t]; times index seconds;
/// - a folder of 7-Scenes `*.pose.txt` (4×4 camera→world; time = number in the name / 30 s), or of Strecha `*.camera`
///   (camera→world and centre; time = index in natural order, s; also in `gt_dense_cameras/`);
/// - a dataset or result folder that holds `trajectory.tum`, `truth.tum`, `groundtruth.txt` (TUM), `poses.txt` (KITTI;
///   times from `times.txt`, else 10 Hz), EuRoC's `data.csv`; or a KITTI odometry sequence with `../../poses/NN.txt`.
/// Throws InputError with path and line for what is not finite, not a rotation, of another number of columns than the
/// row before, or not in order of time. A time may be repeated once: loggers round.
TrajectoryFile read_trajectory(const std::filesystem::path& path);

/// Writes a whole trajectory through TumWriter (io/trajectory_writer.h). Throws DeviceError.
void write_trajectory_tum(const std::filesystem::path& path, const Trajectory& trajectory);

/// Where the covariances of a trajectory file stand: `covariance.csv` beside `trajectory.tum`, else
/// `NAME.covariance.csv` beside `NAME.tum`.
std::filesystem::path covariance_path(const std::filesystem::path& trajectory_path);

/// Writes `t_ns` and the upper triangle (21 entries) of each covariance, of the poses that have one; frame, order and
/// units in the header. Throws DeviceError.
void write_covariances(const std::filesystem::path& path, const Trajectory& trajectory);

/// `trajectory` with the covariances of a file by write_covariances, joined by time. Throws InputError for a malformed
/// file, a time that the trajectory does not have, or a matrix that is not positive semi-definite.
Trajectory read_covariances(const std::filesystem::path& path, Trajectory trajectory);

}  // namespace alidade
