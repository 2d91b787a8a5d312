// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/result_directory.h"
#include "app/thinned.h"
#include "camera/receiver.h"
#include "io/target_file.h"
#include "io/trajectory_writer.h"

namespace alidade {

/// What became of one target.
struct TargetTally {
  static constexpr std::size_t kMostSamples = 2000;

  std::int64_t rows = 0;
  Timestamp first{}, last{};
  std::int64_t sightings = 0;
  double position_sigma_sum_m = 0.0;  ///< over its rows: root of the covariance's trace
  double speed_sum_m_s = 0.0;
  std::optional<double> temperature_k, temperature_sigma_k;  ///< as last told
  Thinned<TargetRow> samples{kMostSamples};

  void add(const TargetRow& row);
};

/// Lines of sight of one moment, for a picture.
struct SkySample {
  Eigen::Vector3d origin_world, direction_world;
};

/// A track of targets as it was run, for those who tell of it.
struct TargetRun {
  static constexpr std::size_t kMostSights = 400;

  std::vector<Receiver> receivers;
  std::map<int, std::int64_t> bearings_of_receiver;
  std::map<int, TargetTally> targets;  ///< by identity
  std::int64_t bearings = 0;
  Timestamp first{}, last{};  ///< of the bearings
  Thinned<SkySample> sights{kMostSights};
  std::vector<std::string> warnings;

  // What the command adds:
  std::string source, method;
  std::int64_t without_direction = 0;
  double tracking_s = 0.0;  ///< reading, tracking and writing
  bool interrupted = false;
  std::optional<std::string> fault;  ///< what in the observations ended the run before their end
};

/// Takes bearings and estimates as they come and writes the estimates down: tracks.csv (all targets, with covariance
/// and identity) and a TUM file of each target's positions, tracks/target_N.tum (without attitude). Keeps only
/// statistics and thinned samples. Calls throw DeviceError where the file system refuses.
class TargetRecord {
 public:
  /// Refers to the directory.
  TargetRecord(const ResultDirectory& directory, std::vector<Receiver> receivers);

  void observe(const Bearing& bearing);

  /// The rows of each target come in order of time.
  void add(const TargetRow& row);

  const TargetRun& run() const { return run_; }

  /// Brings all files to their names; the record is not used afterwards.
  TargetRun commit();

 private:
  const ResultDirectory& directory_;
  TargetFileWriter rows_;
  std::map<int, TumWriter> paths_;
  TargetRun run_;
};

}  // namespace alidade
