// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace alidade {

/// What a GigE Vision camera says of itself when asked who is there.
struct GigeIdentity {
  std::string host_address;  ///< of this machine, on the side of the camera
  std::string maker, model, serial, user_name;
};

/// Asks whoever is at that IPv4 address, three times within `patience`; empty where nobody answers.
std::optional<GigeIdentity> ask_gige_camera(const std::string& address, std::chrono::milliseconds patience);

/// Whether the camera at that address lets us control it: it is asked for control, which is then given back. False
/// where another program has it, or no answer came within `patience`. (Reading who has it instead would prolong the
/// claim of a program that died, with some cameras.)
bool may_control_gige_camera(const std::string& address, std::chrono::milliseconds patience);

}  // namespace alidade
