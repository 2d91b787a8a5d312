// SPDX-License-Identifier: Apache-2.0
#include "uav/flight/receiver_clocks.h"

#include <stdexcept>

namespace alidade {
namespace {

struct Line {
  double value = 0.0, slope = 0.0;  // at the middle; per s
  double scatter2 = 0.0;            // mean square about the line
  double variance = 0.0;            // mean stated variance of a value
};

Line line_of(std::span<const FlightStep> steps, std::size_t receiver, Timestamp middle) {
  double tt = 0.0, tv = 0.0, t1 = 0.0, v1 = 0.0, variance = 0.0;
  const auto n = static_cast<double>(steps.size());
  for (const FlightStep& step : steps) {
    const double t = to_seconds(step.state.time - middle);
    const ReceiverError& error = step.receivers[receiver];
    t1 += t / n, v1 += error.clock_s / n;
    tt += t * t, tv += t * error.clock_s;
    variance += error.clock_sigma_s * error.clock_sigma_s / n;
  }
  Line line;
  line.slope = (tv - n * t1 * v1) / (tt - n * t1 * t1);
  line.value = v1 - line.slope * t1;
  line.variance = variance;
  for (const FlightStep& step : steps) {
    const double off =
        step.receivers[receiver].clock_s - line.value - line.slope * to_seconds(step.state.time - middle);
    line.scatter2 += off * off / n;
  }
  return line;
}

}  // namespace

std::vector<ReceiverClock> clocks_in_operation(std::span<const Receiver> receivers, const FlightPath& path,
                                               Timestamp begin, Timestamp end) {
  std::size_t first = 0, last = path.steps.size();
  while (first < last && path.steps[first].state.time < begin) ++first;
  while (last > first && path.steps[last - 1].state.time > end) --last;
  if (last - first < 2) throw std::invalid_argument("clocks_in_operation: fewer than two steps");
  const std::span<const FlightStep> steps = std::span(path.steps).subspan(first, last - first);
  const Timestamp middle = begin + (end - begin) / 2;
  std::vector<ReceiverClock> clocks;
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    if (steps.front().receivers.size() != receivers.size()) {
      throw std::invalid_argument("clocks_in_operation: the path is not of these receivers");
    }
    const Line line = line_of(steps, k, middle);
    ReceiverClock clock = receivers[k].clock;
    clock.reference = own_time(receivers[k].clock, middle);
    clock.offset_s = to_seconds(middle - clock.reference) + line.value;
    clock.rate += line.slope * (1.0 + clock.rate);
    const double span_s = to_seconds(steps.back().state.time - steps.front().state.time);
    // Values far apart err nearly by themselves, those next to each other alike: as two at the ends do.
    const double variance = line.variance + line.scatter2;
    clock.covariance << variance, 0.0, 0.0, 2.0 * variance / (span_s * span_s);
    clocks.push_back(clock);
  }
  return clocks;
}

}  // namespace alidade
