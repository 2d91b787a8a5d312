// SPDX-License-Identifier: Apache-2.0
#include "io/line_queue.h"

#include <stdexcept>

namespace alidade {

LineQueue::LineQueue(std::size_t capacity) : capacity_(capacity) {
  if (capacity < 2) throw std::invalid_argument("LineQueue: room for two lines is needed");
}

void LineQueue::push(std::string line) {
  if (lines_.size() >= capacity_) {
    const std::size_t given_up = capacity_ / 2;
    lines_.erase(lines_.begin(), lines_.begin() + static_cast<std::ptrdiff_t>(given_up));
    lost_ += given_up;
  }
  lines_.push_back(std::move(line));
}

std::optional<std::string> LineQueue::pop() {
  if (lines_.empty()) return std::nullopt;
  std::string line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

}  // namespace alidade
