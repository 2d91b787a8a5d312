// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <Eigen/Geometry>
#include <yaml-cpp/yaml.h>

// Poses and covariances as our YAML files say them, for rigs of detectors and of cameras alike.
namespace alidade {

/// {translation_m: [x, y, z], quaternion_wxyz: [w, x, y, z]}. Throws InputError with the line for anything else, also
/// where the quaternion's length is not 1.
Eigen::Isometry3d read_pose(const std::filesystem::path& path, const YAML::Node& node);

/// What read_pose reads, rotations to the last digit but one.
std::string format_pose(const Eigen::Isometry3d& T);

/// The symmetric size×size matrix whose upper triangle is listed row by row. Throws InputError with the line for
/// another number of values and where the matrix is no covariance (has a negative variance in some direction).
Eigen::MatrixXd read_covariance(const std::filesystem::path& path, const YAML::Node& node, int size);

/// What read_covariance gives back exactly.
std::string format_covariance(const Eigen::MatrixXd& covariance);

}  // namespace alidade
