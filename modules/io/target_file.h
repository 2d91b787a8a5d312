// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/time.h"
#include "geometry/pose.h"
#include "io/table.h"

namespace alidade {

/// A target at one moment, as a file of tracks, or of true paths, says it.
struct TargetRow {
  Timestamp time{};
  int target = 0;                                                ///< its identity, the same in all rows of a track
  std::string state;                                             ///< "confirmed", "coasting", "true", ...
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();             ///< m
  Eigen::Vector3d v_world = Eigen::Vector3d::Zero();             ///< m/s
  std::optional<Matrix6d> covariance{};                          ///< of (p, v) in world axes; m², m²/s, m²/s²
  std::int64_t sightings = 0;                                    ///< bearings in it so far
  std::optional<double> temperature_k{}, temperature_sigma_k{};  ///< mean of its readings, and their spread
};

/// Writes rows that read_target_rows gives back exactly, as they come: t_ns, target, state, x_m, y_m, z_m, vx_m_s,
/// vy_m_s, vz_m_s, sightings, temperature_k, temperature_sigma_k, and the covariance's upper triangle by rows (c_x_x,
/// c_x_y, ..., c_vz_vz). The file is there once commit returned. Throws DeviceError as AtomicFile does.
class TargetFileWriter {
 public:
  explicit TargetFileWriter(const std::filesystem::path& path);
  void write(const TargetRow& row);
  void commit() { table_.commit(); }

 private:
  TableWriter table_;
};

/// The rows of a file, in its order. Wanted are the columns `t_ns` or `t_s`, `target`, `x_m`, `y_m`, `z_m`; those above
/// are taken where they are there, others passed over. Throws InputError with the line for a missing column and what is
/// no finite number, and for a file without rows.
std::vector<TargetRow> read_target_rows(const std::filesystem::path& path);

}  // namespace alidade
