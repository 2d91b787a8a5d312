// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "estimation/motion_step.h"

namespace alidade {

/// The noise of a motion, learned from the motion as it goes on: from what the last batches said, by expectation and
/// maximisation (Shumway and Stoffer 1982), at first often, then ever more seldom.
class MotionLearner {
 public:
  const MotionProcess& motion() const { return motion_; }
  bool is_started() const { return !motion_.empty(); }

  /// At batches `dt` seconds apart, of something that is moved by hand or flies.
  void start(double dt);

  /// What the batch said of a motion whose state was `before`. Returns whether anything new has been learned.
  bool add(const MotionState& before, MotionLikelihood likelihood);

  /// The motion was interrupted: what comes is not its continuation.
  void interrupt();

 private:
  MotionProcess motion_;
  MotionState first_;  // before recent_
  std::vector<MotionLikelihood> recent_;
  int count_ = 0, next_ = 0;  // batches seen; when to learn
};

}  // namespace alidade
