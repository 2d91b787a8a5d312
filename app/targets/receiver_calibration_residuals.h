// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "calib/receivers/known_track.h"
#include "camera/measurement.h"
#include "camera/receiver.h"

namespace alidade {

/// Where a target was, s of the common clock; empty where that is not known.
using PathLookup = std::function<std::optional<TrackPoint>(double t_s)>;

/// What a reading leaves: where a receiver sees the path, less where it read it.
struct SightResidualSample {
  double t_s = 0.0;  ///< of the common clock
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();
};

/// What a receiver's readings leave about a path.
struct ReceiverResiduals {
  std::int64_t readings = 0;                 ///< while the path is known
  std::optional<double> median_px;           ///< of the lengths; empty where half of them, or all, see nothing of it
  std::vector<SightResidualSample> samples;  ///< evenly thinned
};

/// Takes a camera's own readings; throws std::invalid_argument for a receiver without a camera.
ReceiverResiduals residuals_about(const PathLookup& path, const Receiver& receiver,
                                  std::span<const ReceiverReading> readings);

}  // namespace alidade
