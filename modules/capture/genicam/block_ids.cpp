// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/block_ids.h"

namespace alidade {

std::uint64_t BlockIds::unwrapped(std::uint64_t id) {
  constexpr std::uint64_t kLongestGap = kCycle / 4;  // beyond it the camera rather counts anew
  has_extended_ids_ |= id > kCycle;
  if (last_ == 0 || id == 0 || has_extended_ids_) return last_ = id;
  const std::uint64_t last_short = (last_ - 1) % kCycle + 1;
  const std::uint64_t ahead = (id + kCycle - last_short) % kCycle;
  const bool is_next = ahead > 0 && ahead <= kLongestGap;
  return last_ = is_next ? last_ + ahead : id;
}

}  // namespace alidade
