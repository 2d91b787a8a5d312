// SPDX-License-Identifier: Apache-2.0
#include "io/feed_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace alidade {

FeedReader::FeedReader(OpenFile descriptor, FeedAddress::Kind kind, std::size_t capacity,
                       std::function<std::string(std::uint64_t)> loss_notice)
    : descriptor_(std::move(descriptor)), kind_(kind), loss_notice_(std::move(loss_notice)), lines_(capacity) {}

short FeedReader::wanted_events() const {
  const bool hears = kind_ != FeedAddress::Kind::StandardOutput && !is_silent_;
  return static_cast<short>((hears ? POLLIN : 0) | (is_served() ? 0 : POLLOUT));
}

void FeedReader::react(short events) {
  const bool failed = (events & (POLLERR | POLLHUP | POLLNVAL)) != 0;
  if (kind_ == FeedAddress::Kind::Udp) {
    if (failed || (events & POLLIN) != 0) discard_input();  // nobody took the last datagram; somebody may take the next
  } else if (failed) {
    is_gone_ = true;
  } else if ((events & POLLIN) != 0) {
    discard_input();
  }
  if ((events & POLLOUT) != 0) write_some();
}

// The next line to write; what was lost is told of in its place.
bool FeedReader::take_line() {
  if (written_ < line_.size()) return true;
  const std::uint64_t lost = lines_.take_lost();
  lost_ += lost;
  std::optional<std::string> next = lost > 0 ? loss_notice_(lost) : lines_.pop();
  if (!next) return false;
  line_ = std::move(*next);
  line_ += '\n';
  written_ = 0;
  return true;
}

long FeedReader::write_block(const char* bytes, std::size_t size) const {
  if (kind_ != FeedAddress::Kind::StandardOutput) return ::send(descriptor(), bytes, size, MSG_NOSIGNAL);
  // A pipe that poll calls ready takes this much; more would block.
  return ::write(descriptor(), bytes, std::min<std::size_t>(size, PIPE_BUF));
}

void FeedReader::write_some() {
  while (!is_gone_ && take_line()) {
    const long count = write_block(line_.data() + written_, line_.size() - written_);
    if (count >= 0) {
      written_ += static_cast<std::size_t>(count);
      if (kind_ == FeedAddress::Kind::StandardOutput) return;
      continue;
    }
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == EWOULDBLOCK) return;
    if (kind_ == FeedAddress::Kind::Udp) {
      written_ = line_.size();
    } else {
      is_gone_ = true;
    }
  }
}

void FeedReader::discard_input() {
  std::array<char, 4096> ignored;
  while (!is_gone_) {
    const ssize_t count = ::recv(descriptor(), ignored.data(), ignored.size(), MSG_DONTWAIT);
    if (count > 0 || (count < 0 && errno == EINTR)) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (kind_ == FeedAddress::Kind::Udp) return;
    is_silent_ = true;
    is_gone_ = count < 0;
    return;
  }
}

}  // namespace alidade
