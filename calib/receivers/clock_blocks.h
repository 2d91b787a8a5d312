// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "calib/receivers/known_track.h"
#include "calib/receivers/receiver_parameters.h"

namespace alidade {

struct ClockBlockOptions {
  double block_s = 20.0;       ///< long enough for a target to turn, so that late is told from askew
  double loss_sigmas = 3.0;    ///< readings farther off count less (Cauchy), in units of the block's scatter
  double correlation_s = 0.5;  ///< readings within it err alike
  double most_sigma_s = 0.02;  ///< a block that tells less is left out: the target hardly moves
};

/// By how much a receiver's clock is late in a stretch of time, beside what is stated.
struct ClockBlock {
  Timestamp middle{};  ///< by the receiver's own clock
  double late_s = 0.0;
  double sigma_s = 0.0;
};

/// Block by block what is to be added to the times of a receiver's readings so that it sees a target of known track
/// where it is; in each block its directions may be off by a constant beside. In order of time.
std::vector<ClockBlock> clock_blocks(const Receiver& receiver, std::span<const ReceiverReading> readings,
                                     const KnownTrack& track, const ClockBlockOptions& options = {});

}  // namespace alidade
