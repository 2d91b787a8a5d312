// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "marker1d/body_tracker.h"

namespace alidade {

/// Lets what comes after speak for what was before, in bounded memory: of every estimate that follows on the one before
/// it, the state given at least `lag` batches more (Rauch, Tung and Striebel 1965). Others pass as they are.
class BodySmoother {
 public:
  /// Throws std::invalid_argument for a lag below 1.
  explicit BodySmoother(int lag);

  /// Takes the next estimate and returns those that are settled by it, in order of time.
  std::vector<BodyEstimate> add(BodyEstimate estimate);

  /// All that are left.
  std::vector<BodyEstimate> finish();

 private:
  std::vector<BodyEstimate> settle(std::size_t count);

  std::size_t lag_;
  std::vector<BodyEstimate> chain_;  // each follows on the one before
};

}  // namespace alidade
