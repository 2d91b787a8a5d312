// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/trajectory.h"

namespace alidade {

/// The files of a folder whose names end in `suffix`, in natural order of their names.
std::vector<std::filesystem::path> files_ending_in(const std::filesystem::path& folder, std::string_view suffix);

/// The rotation nearest to R. Throws InputError naming path and line where R is no rotation up to rounding (1e-2).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R, const std::filesystem::path& path, int line);

/// T_world_camera of a 7-Scenes `*.pose.txt`, four rows of four numbers, m. Empty where the set's authors wrote
/// "-1.#IND", nan or inf: the fusion had lost track. Throws InputError.
std::optional<Eigen::Isometry3d> read_pose_matrix(const std::filesystem::path& path);

/// T_world_camera of a Strecha `*.camera`: after K and the distortion R (camera→world) and the centre, m. Throws
/// InputError.
Eigen::Isometry3d read_strecha_pose(const std::filesystem::path& path);

/// The poses of 7-Scenes files that have one, in order of time: the number in the name / 30 s.
Trajectory read_seven_scenes(const std::vector<std::filesystem::path>& files);

/// The poses of Strecha files; the time is the index in `files`, s.
Trajectory read_strecha(const std::vector<std::filesystem::path>& files);

}  // namespace alidade
