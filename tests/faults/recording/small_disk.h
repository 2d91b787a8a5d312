// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace alidade::test {

/// A file system in memory of a few megabytes, mounted on a folder while it lives. Needs root.
class SmallDisk {
 public:
  SmallDisk(std::filesystem::path folder, std::int64_t bytes);
  ~SmallDisk();
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  /// Whether this process may mount.
  bool is_mounted() const { return is_mounted_; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  bool is_mounted_;
};

}  // namespace alidade::test
