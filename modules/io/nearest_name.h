// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace alidade {

/// The known name that takes the fewest insertions, deletions and exchanges of letters to reach from `name`.
/// Empty where `known` is, or where none is near enough to be what was meant (more than half of the letters differ).
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

/// "did you mean 'x'?" for the nearest known name, else "known are: a, b, c".
std::string suggest_name(std::string_view name, std::span<const std::string_view> known);

}  // namespace alidade
