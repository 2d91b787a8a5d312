// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

namespace alidade {

/// The numbers of a text with commas between: "0, 0.1, 0.2". Throws std::invalid_argument naming the option and the
/// word that is none: "delays_s must be numbers with commas between, got 'x'".
std::vector<double> parse_numbers(std::string_view option, std::string_view text);

}  // namespace alidade
