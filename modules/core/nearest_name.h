// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace alidade {

/// Edits (insert, delete, replace, swap of neighbours) that turn `a` into `b`.
int edit_distance(std::string_view a, std::string_view b);

/// The known name that `word` was probably meant to be: the one with the fewest edits, the first of equals.
/// Empty where none is within a third of the longer name's length (at least one edit).
std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string_view> known);

/// "did you mean 'NAME'?", or, where nothing is near, "known are: a, b, c". For the remedy of an InputError.
std::string suggest_name(std::string_view word, std::span<const std::string_view> known);

}  // namespace alidade
