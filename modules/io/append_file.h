// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "core/errors.h"

namespace alidade {

/// The file system takes no more: the disk, a quota or the largest size of a file is reached.
class DiskFull : public DeviceError {
 public:
  DiskFull(const std::string& device, const std::string& operation, const std::string& reason,
           const std::string& remedy, std::string limit)
      : DeviceError(device, operation, reason, remedy), limit_(std::move(limit)) {}

  const std::string& limit() const { return limit_; }  ///< which one: "disk full", "quota reached"

 private:
  std::string limit_;
};

/// A file that grows by whole pieces and may be read, and outlive this process, at any moment: NAME.part until commit()
/// names it. Where a piece does not fit the file stays as it was. Never removed; without commit() NAME.part stays.
class AppendFile {
 public:
  enum class Start { Anew, AtEnd };

  /// Opens NAME.part: empty, or at the end of what it holds. Throws DeviceError, as all below do.
  explicit AppendFile(std::filesystem::path path, Start start = Start::Anew);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  const std::filesystem::path& path() const { return path_; }  ///< the name it will have
  std::int64_t size() const { return size_; }                  ///< bytes

  /// Appends the parts in one write(2) if the kernel takes it, all or nothing. Throws DiskFull, DeviceError.
  void append(std::initializer_list<std::string_view> parts);

  /// Replaces bytes that are there.
  void overwrite(std::int64_t position, std::string_view bytes);

  /// Gives up what comes after the first `size` bytes.
  void cut(std::int64_t size);

  /// Asks the kernel to bring what was written to the disk, and does not wait for it.
  void start_writeback();

  /// Brings the file to the disk and to its name. At most once, and last.
  void commit();

 private:
  [[noreturn]] void fail(const char* operation, int error) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;
};

}  // namespace alidade
