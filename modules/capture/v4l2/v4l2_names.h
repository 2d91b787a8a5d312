// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace alidade {

/// The names of a device node that last over reboots, best first: of the camera itself (ROOT/by-id), then of the socket
/// it is plugged into (ROOT/by-path). Empty where the system gives none.
std::vector<std::filesystem::path> lasting_names(const std::filesystem::path& node,
                                                 const std::filesystem::path& root = "/dev/v4l");

/// The serial number of the USB camera at that node; empty where it has none.
std::string usb_serial(const std::filesystem::path& node, const std::filesystem::path& system = "/sys");

}  // namespace alidade
