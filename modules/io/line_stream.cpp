// SPDX-License-Identifier: Apache-2.0
#include "io/line_stream.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "core/errors.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

constexpr std::size_t kBlock = 1 << 16;
constexpr std::size_t kLongestLine = 1 << 20;
constexpr int kStopCheckMs = 100;  // how long Ctrl-C may wait while a feed is silent

int open_stream(const std::filesystem::path& path) {
  if (path == "-") return STDIN_FILENO;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError(path, 0, "is a folder, a file is wanted", "");
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor >= 0) return descriptor;
  throw InputError(path, 0, "cannot be opened: " + std::generic_category().message(errno), "check the name");
}

}  // namespace

LineStream::LineStream(const std::filesystem::path& path, std::stop_token stop)
    : name_(path == "-" ? "standard input" : path.string()),
      stop_(std::move(stop)),
      descriptor_(open_stream(path)),
      buffer_(2 * kBlock) {}

LineStream::~LineStream() {
  if (descriptor_ != STDIN_FILENO) ::close(descriptor_);
}

// Reads what there is behind what is left; false at the end of the stream or when a stop is wanted.
bool LineStream::refill() {
  if (begin_ > 0) std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (end_ > kLongestLine) throw InputError(name_, number_ + 1, "a line is longer than 1 MB", "is it a text?");
  if (buffer_.size() - end_ < kBlock) buffer_.resize(buffer_.size() + kBlock);
  while (!stop_.stop_requested()) {
    pollfd waiting{descriptor_, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, kStopCheckMs);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t count = ::read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      throw InputError(name_, number_ + 1, "cannot be read: " + std::generic_category().message(errno), "");
    }
    end_ += static_cast<std::size_t>(count);
    read_ += count;
    at_end_ = count == 0;
    return count > 0;
  }
  return false;
}

std::optional<StreamLine> LineStream::next() {
  std::size_t searched = 0;  // bytes after begin_ that hold no line break
  while (true) {
    const char* start = buffer_.data() + begin_;
    const auto* found = static_cast<const char*>(std::memchr(start + searched, '\n', end_ - begin_ - searched));
    if (!found) {
      searched = end_ - begin_;
      if (refill()) continue;
      if (!at_end_ || begin_ == end_) return std::nullopt;
      start = buffer_.data() + begin_;
      found = buffer_.data() + end_;
    }
    const bool has_end = found != buffer_.data() + end_;
    const std::string_view text = trim({start, static_cast<std::size_t>(found - start)});
    begin_ = static_cast<std::size_t>(found - buffer_.data()) + (has_end ? 1 : 0);
    searched = 0;
    ++number_;
    if (!text.empty() && text.front() != '#') return StreamLine{number_, text, has_end};
  }
}

}  // namespace alidade
