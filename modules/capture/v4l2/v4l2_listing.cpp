// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_listing.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string>
#include <system_error>

#include "capture/v4l2/v4l2_controls.h"
#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_names.h"
#include "capture/v4l2/v4l2_offers.h"

namespace alidade {
namespace {

/// The N of "videoN"; empty for all other names.
std::optional<int> number_of(const std::string& name) {
  const std::string prefix = "video";
  const bool is_numbered = name.starts_with(prefix) && name.size() > prefix.size() && name.size() < 12 &&
                           std::all_of(name.begin() + 5, name.end(), [](unsigned char c) { return std::isdigit(c); });
  return is_numbered ? std::optional(std::stoi(name.substr(prefix.size()))) : std::nullopt;
}

/// Empty where it is no camera.
std::optional<ListedCamera> list_one(const std::string& path) {
  ListedCamera listed;
  listed.source = "v4l2:" + path;
  for (const auto& name : lasting_names(path)) listed.aliases.push_back("v4l2:" + name.string());
  listed.serial = usb_serial(path);
  try {
    const V4l2Device device(path);
    if (!device.identity().can_capture) return std::nullopt;
    listed.model = device.identity().model;
    listed.driver = device.identity().driver;
    listed.formats = v4l2_offers(device);
    listed.controls = list_v4l2_controls(device);
  } catch (const CameraError& error) {
    if (error.trouble() == CameraTrouble::Refused) return std::nullopt;
    listed.trouble = error.what();
  }
  return listed;
}

}  // namespace

std::vector<ListedCamera> list_v4l2(const std::filesystem::path& folder) {
  std::map<int, std::string> nodes;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator(folder, absent)) {
    if (const auto number = number_of(entry.path().filename())) nodes[*number] = entry.path().string();
  }
  std::vector<ListedCamera> cameras;
  for (const auto& [number, path] : nodes) {
    if (auto listed = list_one(path)) cameras.push_back(std::move(*listed));
  }
  return cameras;
}

}  // namespace alidade
