// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_smoother.h"

#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include "estimation/state_smoother.h"

namespace alidade {

BodySmoother::BodySmoother(int lag) : lag_(static_cast<std::size_t>(lag)) {
  if (lag < 1) throw std::invalid_argument(fmt::format("lag must be >= 1, got {}", lag));
}

std::vector<BodyEstimate> BodySmoother::add(BodyEstimate estimate) {
  std::vector<BodyEstimate> settled;
  if (!estimate.step) settled = finish();
  chain_.push_back(std::move(estimate));
  // The pass over 2 lag batches settles one lag: each batch is passed twice.
  if (chain_.size() >= 2 * lag_) settled = settle(lag_);
  return settled;
}

std::vector<BodyEstimate> BodySmoother::finish() {
  return settle(chain_.size());
}

std::vector<BodyEstimate> BodySmoother::settle(std::size_t count) {
  std::vector<MotionStep> steps;
  for (const BodyEstimate& e : chain_) steps.push_back(e.step ? *e.step : MotionStep{e.state, e.state, {}, 0.0});
  const std::vector<SmoothedState> smoothed = smooth(steps);
  const auto end = chain_.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<BodyEstimate> settled(std::make_move_iterator(chain_.begin()), std::make_move_iterator(end));
  chain_.erase(chain_.begin(), end);
  for (std::size_t i = 0; i < count; ++i) {
    if (settled[i].status == BodyStatus::Tracked) settled[i].state = smoothed[i].state;
  }
  return settled;
}

}  // namespace alidade
