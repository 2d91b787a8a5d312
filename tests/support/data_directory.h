// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace alidade::test {

/// A folder of the real recordings: under $ALIDADE_DATA, else ../shared/data beside the repository. Tests skip where it
/// does not exist: if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there".
inline std::filesystem::path data_directory(std::string_view name) {
  if (const char* root = std::getenv("ALIDADE_DATA")) return std::filesystem::path(root) / name;
  return std::filesystem::path(ALIDADE_SOURCE_DIR).parent_path() / "shared/data" / name;
}

}  // namespace alidade::test
