// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/trajectory.h"
#include "io/text_rows.h"

namespace alidade {

/// The files of a folder whose names end in `suffix`, sorted by name.
std::vector<std::filesystem::path> files_ending_in(const std::filesystem::path& folder, std::string_view suffix);

/// The rotation nearest to R. Throws InputError naming path and line where R is no rotation up to rounding (1e-2).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R, const std::filesystem::path& path, int line);

/// 7-Scenes `*.pose.txt`: 4×4 camera→world, m; the time is the number in the name / 30 s. In order of time.
Trajectory read_seven_scenes(const std::vector<std::filesystem::path>& files);

/// Strecha `*.camera`: K, distortion, R (camera→world), centre, size; the time is the index in `files`, s.
Trajectory read_strecha(const std::vector<std::filesystem::path>& files);

}  // namespace alidade
