// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "io/feed_socket.h"
#include "io/line_queue.h"

namespace alidade {

/// One that lines are written to, as fast as it takes them.
class FeedReader {
 public:
  /// `descriptor`: a socket that does not block; of Kind::StandardOutput any descriptor, written to only as much as it
  /// takes at once after poll. `loss_notice`: the line that tells of so many lost ones.
  FeedReader(OpenFile descriptor, FeedAddress::Kind kind, std::size_t capacity,
             std::function<std::string(std::uint64_t)> loss_notice);

  int descriptor() const { return descriptor_.number(); }
  LineQueue& lines() { return lines_; }

  /// Whether it has all that it was given.
  bool is_served() const { return lines_.empty() && written_ == line_.size(); }

  /// What poll shall look for: room for what waits, and what the reader says.
  short wanted_events() const;

  /// Does what poll says is possible, without waiting: writes, and reads what the reader says, of which nothing is
  /// kept. Sets is_gone.
  void react(short events);

  /// It closed, or failed.
  bool is_gone() const { return is_gone_; }

  /// Lines given up for it, of which it was told.
  std::uint64_t lost() const { return lost_; }

 private:
  bool take_line();
  void write_some();
  void discard_input();
  long write_block(const char* bytes, std::size_t size) const;

  OpenFile descriptor_;
  FeedAddress::Kind kind_;
  std::function<std::string(std::uint64_t)> loss_notice_;
  LineQueue lines_;
  std::string line_;         // that is being written
  std::size_t written_ = 0;  // bytes of it
  std::uint64_t lost_ = 0;
  bool is_silent_ = false;  // it will say no more, and may still listen
  bool is_gone_ = false;
};

}  // namespace alidade
