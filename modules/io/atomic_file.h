// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace alidade {

/// A file that is there whole or not at all: bytes go to NAME.part, which takes its name at commit.
/// Every call throws DeviceError where the file system refuses (full disk, no permission); whatever was not
/// committed when the object dies is removed.
class AtomicFile {
 public:
  /// Creates NAME.part; its folder must exist.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);

  /// Brings the bytes to the disk and the file to its name, replacing what had it. At most once, and last.
  void commit();

 private:
  void flush();
  [[noreturn]] void fail(const char* operation, int error);

  std::filesystem::path path_;
  std::filesystem::path part_;
  std::string buffer_;
  int descriptor_ = -1;
};

/// Where an unfinished file of this name lives: NAME.part.
std::filesystem::path part_name(const std::filesystem::path& path);

/// Brings NAME.part, written and closed by other means, to the disk and to its name. Throws DeviceError.
void commit_part(const std::filesystem::path& path);

/// Writes a whole file through AtomicFile.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace alidade
