// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "capture/camera_listing.h"

namespace alidade {

/// A camera in lines for the terminal: what it is and how it is named, then its formats with sizes and rates; with
/// `is_whole` also the descriptions of the formats, and all controls or features.
std::vector<std::string> lines_of(const ListedCamera& camera, bool is_whole);

/// All of it as JSON: numbers as numbers, what is not known left out.
nlohmann::json to_json(const ListedCamera& camera);

}  // namespace alidade
