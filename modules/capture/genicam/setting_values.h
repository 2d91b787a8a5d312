// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace alidade {

/// Values of features as users write them: "-12" or "0x1F"; "0.5" or "1e-3"; "true", "on", "yes", "1" and their
/// opposites, in any case. Empty where the whole text is no such thing.
std::optional<std::int64_t> parse_integer_setting(std::string_view text);
std::optional<double> parse_float_setting(std::string_view text);
std::optional<bool> parse_boolean_setting(std::string_view text);

}  // namespace alidade
