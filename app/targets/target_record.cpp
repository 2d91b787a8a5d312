// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_record.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace alidade {

void TargetTally::add(const TargetRow& row) {
  if (rows++ == 0) first = row.time;
  last = row.time;
  sightings = row.sightings;
  speed_sum_m_s += row.v_world.norm();
  if (row.covariance) position_sigma_sum_m += std::sqrt(row.covariance->topLeftCorner<3, 3>().trace());
  temperature_k = row.temperature_k;
  temperature_sigma_k = row.temperature_sigma_k;
  samples.add(row);
}

TargetRecord::TargetRecord(const ResultDirectory& directory, std::vector<Receiver> receivers)
    : directory_(directory), rows_(directory.path("tracks.csv")) {
  run_.receivers = std::move(receivers);
}

void TargetRecord::observe(const Bearing& bearing) {
  run_.first = run_.bearings == 0 ? bearing.time : std::min(run_.first, bearing.time);
  run_.last = run_.bearings == 0 ? bearing.time : std::max(run_.last, bearing.time);
  ++run_.bearings;
  ++run_.bearings_of_receiver[bearing.receiver];
  run_.sights.add({bearing.origin_world, bearing.direction_world});
}

void TargetRecord::add(const TargetRow& row) {
  rows_.write(row);
  auto path = paths_.find(row.target);
  if (path == paths_.end()) {
    path = paths_.try_emplace(row.target, directory_.path(fmt::format("tracks/target_{}.tum", row.target)), "target")
               .first;
  }
  StampedPose pose;
  pose.time = row.time;
  pose.T_world_camera.translation() = row.p_world;
  path->second.write(pose);
  run_.targets[row.target].add(row);
}

TargetRun TargetRecord::commit() {
  rows_.commit();
  for (auto& [target, path] : paths_) path.commit();
  return std::move(run_);
}

}  // namespace alidade
