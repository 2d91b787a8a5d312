// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_names.h"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace alidade {
namespace fs = std::filesystem;

std::vector<fs::path> lasting_names(const fs::path& node, const fs::path& root) {
  std::vector<fs::path> names;
  for (const char* folder : {"by-id", "by-path"}) {
    std::vector<fs::path> here;
    std::error_code absent;
    for (const auto& link : fs::directory_iterator(root / folder, absent)) {
      std::error_code dangling;
      if (fs::equivalent(link.path(), node, dangling) && !dangling) here.push_back(link.path());
    }
    std::sort(here.begin(), here.end());
    names.insert(names.end(), here.begin(), here.end());
  }
  return names;
}

std::string usb_serial(const fs::path& node, const fs::path& system) {
  std::error_code ignored;
  const fs::path real = fs::canonical(node, ignored);
  // "device" is the camera's interface; the USB device above it has the number.
  const fs::path interface = fs::canonical(system / "class/video4linux" / real.filename() / "device", ignored);
  if (ignored) return "";
  std::string serial;
  std::getline(std::ifstream(interface.parent_path() / "serial"), serial);
  return serial;
}

}  // namespace alidade
