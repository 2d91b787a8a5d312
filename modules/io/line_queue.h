// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

namespace alidade {

/// Lines that wait for a reader, not more than `capacity` (at least 2): where there is no room the older half is given
/// up and counted, so that what is read is recent and losses are told of rarely.
class LineQueue {
 public:
  /// Throws std::invalid_argument for a capacity below 2.
  explicit LineQueue(std::size_t capacity);

  void push(std::string line);

  /// The oldest line; empty where there is none.
  std::optional<std::string> pop();

  bool empty() const { return lines_.empty(); }

  /// How many were given up since the last call: all of them older than the lines that wait.
  std::uint64_t take_lost() { return std::exchange(lost_, 0); }

  /// Counts lines that were lost elsewhere.
  void add_lost(std::uint64_t count) { lost_ += count; }

 private:
  std::size_t capacity_;
  std::deque<std::string> lines_;
  std::uint64_t lost_ = 0;
};

}  // namespace alidade
