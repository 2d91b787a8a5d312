// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "camera/marker_sign.h"

namespace alidade {

/// Rows in which two codes of equal length differ at the shift where they differ least. Throws std::invalid_argument
/// where the lengths differ or a code is empty.
int cyclic_distance(std::string_view a, std::string_view b);

/// The same of a code from its own shifts; 0: it repeats within its length, the length for a code of one row.
int cyclic_distance(std::string_view code);

struct BlinkCodeOptions {
  int distance = 4;      ///< between any two codes, and of a code from its own shifts: one wrong row is then corrected
  int longest_dark = 2;  ///< rows in which the marker cannot be followed
};

/// `count` codes of equal, least possible length that remain apart under all shifts (necklaces), those that are lit
/// longest first: each as (count, distance, dark rows) alone determine, always the same. Throws std::invalid_argument
/// where count < 1, the options are not positive or no 20 rows suffice.
std::vector<std::string> blink_codes(int count, const BlinkCodeOptions& options = {});

/// Says why markers cannot be told apart, or what is impossible about one ("marker 3: the code must consist of 0 and 1,
/// got '10x'"); empty where nothing is.
std::optional<std::string> find_fault(std::span<const MarkerSign> signs);

}  // namespace alidade
