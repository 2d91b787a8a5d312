// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "view/scene.h"

namespace alidade {

/// Whether a directory holds tracks of targets, or a simulated flight.
bool is_target_result(const std::filesystem::path& result);

/// What there is to see in it: receivers.yaml, tracks.csv and truth.csv, each where it is there. `truth`, where not
/// empty, is a file of true paths to show instead of truth.csv. Throws InputError where one is damaged.
Scene read_target_scene(const std::filesystem::path& result, const std::filesystem::path& truth);

}  // namespace alidade
