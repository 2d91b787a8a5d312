// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_residuals.h"

#include <algorithm>
#include <limits>

#include "app/thinned.h"
#include "calib/receivers/receiver_parameters.h"
#include "core/median.h"

namespace alidade {

ReceiverResiduals residuals_about(const PathLookup& path, const Receiver& receiver,
                                  std::span<const ReceiverReading> readings) {
  constexpr std::size_t kMostSamples = 4000;
  Thinned<SightResidualSample> samples(kMostSamples);
  std::vector<double> lengths;
  const ReceiverChange none = ReceiverChange::Zero();
  for (const ReceiverReading& reading : readings) {
    const double t_s = sight_time(receiver, none, reading).t_s;
    const auto point = path(t_s);
    if (!point) continue;
    const auto seen = sight_residual(receiver, none, reading, *point);
    lengths.push_back(seen ? seen->residual_px.norm() : std::numeric_limits<double>::infinity());
    if (seen) samples.add({t_s, reading.value, seen->residual_px});
  }
  ReceiverResiduals result;
  result.readings = static_cast<std::int64_t>(lengths.size());
  result.samples = samples.values();
  if (lengths.empty()) return result;
  const double middle_px = median(std::move(lengths));
  if (middle_px < std::numeric_limits<double>::infinity()) result.median_px = middle_px;
  return result;
}

}  // namespace alidade
