// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/recording/small_disk.h"

#include <string>
#include <utility>

#include <sys/mount.h>

namespace alidade::test {

SmallDisk::SmallDisk(std::filesystem::path folder, std::int64_t bytes) : folder_(std::move(folder)) {
  std::filesystem::create_directories(folder_);
  is_mounted_ = ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, ("size=" + std::to_string(bytes)).c_str()) == 0;
}

SmallDisk::~SmallDisk() {
  if (is_mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
}

}  // namespace alidade::test
