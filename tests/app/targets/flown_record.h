// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/targets/target_record.h"
#include "tests/support/temporary_directory.h"

namespace alidade::test {

inline Timestamp at(double seconds) {
  return Timestamp(from_seconds(seconds));
}

/// Two receivers, of which the first reads everything that is observed.
inline std::vector<Receiver> hill_and_roof() {
  std::vector<Receiver> receivers(2);
  receivers[0].name = "hill";
  receivers[1].id = 1;
  receivers[1].name = "roof";
  receivers[1].T_world_receiver.translation() = Eigen::Vector3d(100, 0, 0);
  return receivers;
}

/// A row of a target that flies along x with 10 m/s, 5 m beside the one before, at 50 m height.
inline TargetRow row_of(int target, double t_s) {
  TargetRow row;
  row.time = at(t_s);
  row.target = target;
  row.state = "confirmed";
  row.p_world = Eigen::Vector3d(10.0 * t_s, 5.0 * target, 50.0);
  row.v_world = Eigen::Vector3d(10, 0, 0);
  row.covariance = 0.04 * Matrix6d::Identity();
  row.sightings = static_cast<std::int64_t>(1 + t_s);
  return row;
}

/// The record of `targets` such targets over `rows` seconds. Its files are in folder/out.
inline TargetRun flown_record(const TemporaryDirectory& folder, int targets, int rows) {
  ResultDirectory directory(folder / "out", "track targets");
  TargetRecord record(directory, hill_and_roof());
  for (int i = 0; i < rows; ++i) {
    Bearing bearing;
    bearing.time = at(i + 2.0);
    record.observe(bearing);
    for (int target = 1; target <= targets; ++target) record.add(row_of(target, i));
  }
  TargetRun run = record.commit();
  directory.commit(nlohmann::json::object());
  return run;
}

}  // namespace alidade::test
