// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "camera/receiver.h"
#include "uav/flight/flight_path.h"

namespace alidade {

/// The receivers' clocks as a flight showed them to be between two of its moments: straight lines through what was to
/// be added to their times, beside what is known of them before. Their reference is the middle of that time by the
/// clock itself. A clock that walks off farther than a line wants a shorter time. In the order of the receivers. Throws
/// std::invalid_argument where the path is not of these receivers, or has fewer than two steps in that time.
std::vector<ReceiverClock> clocks_in_operation(std::span<const Receiver> receivers, const FlightPath& path,
                                               Timestamp begin, Timestamp end);

}  // namespace alidade
