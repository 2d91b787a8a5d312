// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <nlohmann/json_fwd.hpp>

namespace alidade::test {

/// What the trials of recordings come to, one object each, with the members that its keys name. `folder` is for the
/// recordings, which are removed again.

/// `count` recordings of all pixel formats in turn, killed after 10 to 1000 ms.
nlohmann::json kill_trials(const std::filesystem::path& folder, int count, unsigned seed);

/// `count` recordings onto disks of 1 to 6 MB. A "skipped" member says why there is nothing else.
nlohmann::json full_disk_trials(const std::filesystem::path& folder, int count, unsigned seed);

/// Every pixel format by every codec, recorded and read again.
nlohmann::json exactness_trials(const std::filesystem::path& folder);

}  // namespace alidade::test
