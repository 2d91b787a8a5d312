// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/packet_size.h"

#include <algorithm>
#include <cstdint>

#include <arv.h>
#include <fmt/format.h>

#include "capture/genicam/camera_features.h"

namespace alidade {
namespace {

constexpr std::int64_t kLoopbackMtu = 65532;  // the longest IPv4 packet that is a multiple of four

struct SizeRange {
  gint64 least = 0, most = 0;
};

SizeRange size_range(ArvDevice* device) {
  SizeRange range;
  arv_device_get_integer_feature_bounds(device, "GevSCPSPacketSize", &range.least, &range.most, AravisFault().out());
  return range;
}

void write_size(ArvCamera* camera, std::int64_t bytes, const std::string& source) {
  AravisFault fault;
  arv_camera_gv_set_packet_size(camera, static_cast<gint>(bytes), fault.out());
  fault.check(source, "set the packet size");
}

}  // namespace

void choose_packet_size(ArvCamera* camera, const std::string& address, std::optional<int> wanted_bytes,
                        const std::string& source) {
  ArvDevice* const device = arv_camera_get_device(camera);
  arv_gv_device_set_packet_size_adjustment(ARV_GV_DEVICE(device), ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
  const SizeRange range = size_range(device);
  if (wanted_bytes) {
    if (*wanted_bytes < range.least || *wanted_bytes > range.most) {
      throw CameraError(CameraTrouble::Refused, source, "set the packet size",
                        fmt::format("{} bytes are out of range", *wanted_bytes),
                        fmt::format("it takes {} to {}", range.least, range.most));
    }
    write_size(camera, *wanted_bytes, source);
  } else if (has_feature(device, "GevSCPSFireTestPacket")) {
    AravisFault fault;
    arv_camera_gv_auto_packet_size(camera, fault.out());
    fault.check(source, "find the largest packet size");
  } else if (address.starts_with("127.")) {
    write_size(camera, std::min<std::int64_t>(kLoopbackMtu, range.most), source);
  }
}

}  // namespace alidade
