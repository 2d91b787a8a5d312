// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"

namespace alidade {

/// The images of a folder, in natural order of their names. Throws InputError where there is no such folder or no image
/// in it.
std::vector<std::filesystem::path> list_images(const std::filesystem::path& folder);

/// The times that the names of images spell, if all do and they increase: seconds ("1305031229.528748.png", TUM) or
/// nanoseconds (16 digits and more, EuRoC). Empty otherwise.
std::optional<std::vector<Timestamp>> times_in_names(std::span<const std::filesystem::path> images);

}  // namespace alidade
