// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "evaluation/absolute_error.h"
#include "evaluation/association.h"
#include "evaluation/consistency.h"
#include "evaluation/path_error.h"
#include "evaluation/relative_error.h"
#include "geometry/alignment.h"

namespace alidade {

struct EvaluationOptions {
  AlignmentKind alignment = AlignmentKind::Similarity;  ///< one camera knows neither frame nor scale
  Step step = FrameStep{1};                             ///< over which the relative errors are taken
};

/// All that a trajectory's truth says about it.
struct Evaluation {
  Similarity alignment;      ///< from the estimate's frame to the truth's, by the associated centres
  PairedTrajectories pairs;  ///< the estimate aligned
  AbsoluteErrors absolute;
  RelativeErrors relative;
  PathErrors path;
  std::optional<Consistency> consistency;  ///< where the estimate has covariances
};

/// Aligns the estimate and compares it with the truth. Empty where the alignment is not determined: fewer than three
/// pairs, or centres on one line (see align_points). Throws std::invalid_argument for unequal lengths.
std::optional<Evaluation> evaluate(const PairedTrajectories& pairs, const EvaluationOptions& options = {});

}  // namespace alidade
