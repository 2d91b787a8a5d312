// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace alidade {

/// The frame ids of a stream without their wrap: GigE Vision counts in 16 bits, 65535 being followed by 1 since 0 means
/// nothing. Ids above that (extended ids, USB3 Vision) pass as they are, and so do those of a camera that counts anew.
class BlockIds {
 public:
  std::uint64_t unwrapped(std::uint64_t id);

 private:
  static constexpr std::uint64_t kCycle = 65535;
  std::uint64_t last_ = 0;  // unwrapped; 0: none yet
  bool has_extended_ids_ = false;
};

}  // namespace alidade
