// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/trajectory.h"
#include "io/atomic_file.h"

namespace alidade {

/// Writes a TUM trajectory pose by pose, in memory that does not grow: `timestamp tx ty tz qx qy qz qw` under a header
/// line, times exact in ns, numbers with as many digits as give back the same double. There once commit() returned;
/// every call throws DeviceError as AtomicFile does.
class TumWriter {
 public:
  /// `what`: whose poses they are, a word for the header ("camera", "body").
  explicit TumWriter(const std::filesystem::path& path, std::string_view what = "camera");

  void write(const StampedPose& pose);
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
};

/// Writes covariances pose by pose: `t_ns` and the upper triangle (21 entries) of each pose that has one; frame, order
/// and units in the header. Otherwise as TumWriter.
class CovarianceWriter {
 public:
  explicit CovarianceWriter(const std::filesystem::path& path, std::string_view what = "camera");

  void write(const StampedPose& pose);
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
};

/// A trajectory and, at covariance_path(path), the covariances of those poses that have one.
class TrajectoryWriter {
 public:
  explicit TrajectoryWriter(const std::filesystem::path& path, std::string_view what = "camera");

  void write(const StampedPose& pose);
  void commit();

 private:
  TumWriter poses_;
  CovarianceWriter covariances_;
};

}  // namespace alidade
