// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace alidade {

/// The pairs of a row and a column, each in one pair at most, whose gains add up to the most: per row its column, empty
/// where the row is better left alone. A pair whose gain is not above 0 is never made; −∞ is allowed. O(n² m) with n
/// the lesser of both sizes. Throws std::invalid_argument for NaN and +∞.
/// Source: Kuhn 1955 (the Hungarian method), by shortest augmenting paths as in Jonker and Volgenant 1987.
std::vector<std::optional<Eigen::Index>> best_assignment(const Eigen::MatrixXd& gain);

}  // namespace alidade
