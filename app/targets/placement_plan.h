// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/options_yaml.h"
#include "app/result_directory.h"
#include "camera/receiver.h"
#include "uav/batch/placement.h"

namespace alidade {

/// What `track targets --plan` can be asked for; vectors as numbers with commas between.
struct PlanOptions {
  std::string least_m = "-100,-100,10", greatest_m = "100,100,90";  ///< corners of the volume
  std::string v_m_s = "15,0,0";
  std::string delays_s = "0";
  PlacementOptions placement;
};

/// Binds them to flags and keys of --config below `plan`. `options` must outlive `fields`.
void bind(OptionFields& fields, PlanOptions& options);

/// The placement asked for. Throws std::invalid_argument naming what is impossible.
PlacementOptions placement_of(const PlanOptions& options);

/// The content of summary.json: how well targets are located in the volume, median and worst, and where not at all.
nlohmann::json summary_of(const PlacementMap& map);

/// Writes placement.csv (x_m, y_m, z_m, receivers, rms_m), placement.png (up to four heights) and report.html; the
/// commit is the caller's.
void write_plan(const PlacementMap& map, std::span<const Receiver> receivers, const ResultDirectory& directory,
                const std::vector<std::string>& arguments, const std::string& options_yaml);

}  // namespace alidade
