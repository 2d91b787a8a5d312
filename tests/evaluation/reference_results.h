// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "geometry/alignment.h"

namespace alidade {

/// One run of the evaluation tool evo, as its output records it.
struct ReferenceCase {
  std::string command;  ///< the heading, without "## "
  std::filesystem::path truth, estimate;
  AlignmentKind alignment = AlignmentKind::None;
  bool relative = false;                                     ///< evo_rpe over one frame; else evo_ape
  bool angle = false;                                        ///< degrees; else metres
  std::vector<std::pair<std::string, std::string>> printed;  ///< statistic and value, as evo printed it
};

/// A statistic of a case: as evo printed it, and as we print it with as many digits.
struct ReferenceValue {
  std::string statistic, evo, ours;
};

/// The cases of `folder`/reference-results.txt. Throws InputError for a line that is neither heading nor value.
std::vector<ReferenceCase> read_reference_cases(const std::filesystem::path& folder);

/// Evaluates a case with our own reader, association, alignment and errors.
std::vector<ReferenceValue> compare(const ReferenceCase& reference);

}  // namespace alidade
