// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace alidade {

/// Which detection, if any, is of each true object: one to one, the nearest pairs first, none farther apart than
/// `most_px`. The index of the detection for each truth.
std::vector<std::optional<std::size_t>> match_detections(std::span<const Eigen::Vector2d> truth,
                                                         std::span<const Eigen::Vector2d> detections, double most_px);

}  // namespace alidade
