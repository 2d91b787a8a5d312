// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "camera/measurement.h"

namespace alidade {

/// What one receiver saw in one look at the sky: no two of its bearings are of the same target.
struct BearingScan {
  int receiver = 0;
  std::vector<Bearing> bearings;  ///< in order of time; at least one

  Timestamp begin() const { return bearings.front().time; }
  Timestamp end() const { return bearings.back().time; }
};

/// An order of bearings that does not depend on the order in which they arrived: by time, then receiver, then what
/// they say.
bool comes_before(const Bearing& a, const Bearing& b);

/// The scans of bearings that are in order: a receiver's next scan begins with its first bearing later than `scan_s`
/// after the begin of the scan before. By their begin, then receiver.
std::vector<BearingScan> scans_of(std::span<const Bearing> in_order, double scan_s);

}  // namespace alidade
