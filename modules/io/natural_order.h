// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace alidade {

/// Whether a stands before b when runs of digits count as numbers: frame2 before frame10.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace alidade
