// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recording_names.h"

#include "io/atomic_file.h"

namespace alidade {

std::filesystem::path find_recorded(const std::filesystem::path& folder, const char* name) {
  const std::filesystem::path part = part_name(folder / name);
  return std::filesystem::exists(part) ? part : folder / name;
}

}  // namespace alidade
