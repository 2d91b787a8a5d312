// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "datasets/target_scene.h"

namespace alidade {

/// When a receiver looks at each of the paths' targets in the period that begins at `begin`, by the options' scan law;
/// empty for one that it does not come to within the period. A moving target is met where it is then.
std::vector<std::optional<Timestamp>> scan_times(const TargetSceneOptions& options, const Receiver& receiver,
                                                 std::span<const TargetPath> paths, Timestamp begin);

/// The last moment of each receiver's period at which it sees anything.
std::vector<Timestamp> scan_ends(const TargetSceneOptions& options, Timestamp begin);

}  // namespace alidade
