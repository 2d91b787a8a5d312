// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.h"

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "core/errors.h"

namespace alidade {
namespace {

constexpr std::size_t kBufferSize = 1 << 16;

std::string remedy_for(int error) {
  if (error == ENOSPC || error == EDQUOT) return "free some space and run it again";
  if (error == ENOENT) return "create the folder first";
  if (error == EACCES || error == EPERM || error == EROFS) return "choose a folder that you may write to";
  return "";
}

[[noreturn]] void refuse(const std::filesystem::path& path, const char* operation, int error) {
  throw DeviceError(path, operation, std::generic_category().message(error), remedy_for(error));
}

// A full disk or a broken network share may speak up only here. EINVAL: a pipe or device, which has nothing to sync.
// Zero, or the errno of what went wrong; the descriptor is closed in any case.
int sync_and_close(int descriptor) {
  const int error = ::fsync(descriptor) != 0 && errno != EINVAL ? errno : 0;
  const int close_error = ::close(descriptor) != 0 ? errno : 0;
  return error != 0 ? error : close_error;
}

}  // namespace

std::filesystem::path part_name(const std::filesystem::path& path) {
  return path.string() + ".part";
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), part_(part_name(path_)) {
  descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("cannot be created", errno);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(part_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  if (descriptor_ < 0) throw std::invalid_argument("AtomicFile::write after commit");
  buffer_.append(bytes);
  if (buffer_.size() >= kBufferSize) flush();
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot be written", errno);
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

void AtomicFile::commit() {
  if (descriptor_ < 0) throw std::invalid_argument("AtomicFile::commit twice");
  flush();
  if (const int error = sync_and_close(std::exchange(descriptor_, -1))) fail("cannot be written", error);
  if (::rename(part_.c_str(), path_.c_str()) != 0) fail("cannot take its name", errno);
}

void AtomicFile::fail(const char* operation, int error) {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  ::unlink(part_.c_str());
  refuse(path_, operation, error);
}

void commit_part(const std::filesystem::path& path) {
  const std::filesystem::path part = part_name(path);
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) refuse(path, "cannot be written", errno);
  if (const int error = sync_and_close(descriptor)) refuse(path, "cannot be written", error);
  if (::rename(part.c_str(), path.c_str()) != 0) refuse(path, "cannot take its name", errno);
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace alidade
