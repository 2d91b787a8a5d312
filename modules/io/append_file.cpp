// SPDX-License-Identifier: Apache-2.0
#include "io/append_file.h"

#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include "io/atomic_file.h"

namespace alidade {
namespace {

constexpr std::size_t kMostParts = 8;

// Empty for an errno that means something else.
std::string limit_of(int error) {
  if (error == ENOSPC) return "disk full";
  if (error == EDQUOT) return "quota reached";
  return error == EFBIG ? "largest size of a file reached" : "";
}

// Writes all of the parts. Zero, or the errno of what went wrong.
int write_all(int descriptor, std::array<iovec, kMostParts>& parts, std::size_t count) {
  std::size_t first = 0;
  while (first < count) {
    ssize_t written = ::writev(descriptor, &parts[first], static_cast<int>(count - first));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    while (first < count && static_cast<std::size_t>(written) >= parts[first].iov_len) {
      written -= static_cast<ssize_t>(parts[first++].iov_len);
    }
    if (first == count) break;
    parts[first].iov_base = static_cast<char*>(parts[first].iov_base) + written;
    parts[first].iov_len -= static_cast<std::size_t>(written);
  }
  return 0;
}

}  // namespace

AppendFile::AppendFile(std::filesystem::path path, Start start) : path_(std::move(path)) {
  const int how = start == Start::Anew ? O_CREAT | O_TRUNC : 0;
  descriptor_ = ::open(part_name(path_).c_str(), O_WRONLY | O_CLOEXEC | how, 0666);
  if (descriptor_ < 0) fail(start == Start::Anew ? "cannot be created" : "cannot be written", errno);
  size_ = ::lseek(descriptor_, 0, SEEK_END);
}

AppendFile::~AppendFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AppendFile::append(std::initializer_list<std::string_view> parts) {
  if (parts.size() > kMostParts) throw std::invalid_argument("AppendFile::append: too many parts");
  std::array<iovec, kMostParts> pieces{};
  std::size_t count = 0;
  std::int64_t length = 0;
  for (const std::string_view part : parts) {
    length += static_cast<std::int64_t>(part.size());
    if (!part.empty()) pieces[count++] = {const_cast<char*>(part.data()), part.size()};
  }
  if (const int error = write_all(descriptor_, pieces, count)) {
    // What did fit of it goes. Where it cannot be cut off, the first fault is the one to tell.
    if (::ftruncate(descriptor_, size_) == 0) ::lseek(descriptor_, size_, SEEK_SET);
    fail("cannot be written", error);
  }
  size_ += length;
}

void AppendFile::overwrite(std::int64_t position, std::string_view bytes) {
  if (position + static_cast<std::int64_t>(bytes.size()) > size_) {
    throw std::invalid_argument("AppendFile::overwrite beyond the end");
  }
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), position);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written", errno);
    position += written;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AppendFile::cut(std::int64_t size) {
  if (::ftruncate(descriptor_, size) != 0 || ::lseek(descriptor_, size, SEEK_SET) < 0) fail("cannot be cut", errno);
  size_ = size;
}

void AppendFile::start_writeback() {
  ::sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE);  // a wish: what fails shows when it is written or closed
}

void AppendFile::commit() {
  if (descriptor_ < 0) throw std::invalid_argument("AppendFile::commit twice");
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot be written", errno);
  commit_part(path_);
}

void AppendFile::fail(const char* operation, int error) const {
  const std::string reason = std::generic_category().message(error);
  const std::string limit = limit_of(error);
  const std::string remedy = error == ENOSPC || error == EDQUOT  ? "free some space and run it again"
                             : error == EACCES || error == EROFS ? "choose a folder that you may write to"
                             : error == ENOENT                   ? "create the folder first"
                                                                 : "";
  if (!limit.empty()) throw DiskFull(path_, operation, reason, remedy, limit);
  throw DeviceError(path_, operation, reason, remedy);
}

}  // namespace alidade
