// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "geometry/rigid_body.h"

namespace alidade {

/// Reads rigid bodies from a CSV file: columns `marker` (its id), `x_m`, `y_m`, `z_m` (in the body's frame), and
/// `body` (name) where there are several; without it there is one body, named after the file. Bodies come in the order
/// of their first marker. Throws InputError with the line for a file without markers, a column that is missing, an id
/// that two markers have, and what is no finite number.
std::vector<RigidBody> read_bodies(const std::filesystem::path& path);

/// Writes bodies that read_bodies gives back exactly. Throws DeviceError as AtomicFile does.
void write_bodies(const std::filesystem::path& path, std::span<const RigidBody> bodies);

}  // namespace alidade
