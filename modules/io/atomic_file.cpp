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
  // A full disk or a broken network share may speak up only here. EINVAL: a pipe or device, which has nothing to sync.
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail("cannot be written", errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot be closed", errno);
  if (::rename(part_.c_str(), path_.c_str()) != 0) fail("cannot take its name", errno);
}

void AtomicFile::fail(const char* operation, int error) {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  ::unlink(part_.c_str());
  throw DeviceError(path_, operation, std::generic_category().message(error), remedy_for(error));
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace alidade
