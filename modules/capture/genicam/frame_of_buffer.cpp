// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/frame_of_buffer.h"

#include <span>

#include <arv.h>

#include "capture/genicam/camera_stream.h"
#include "capture/genicam/pixel_unpacking.h"

namespace alidade {
namespace {

// How the image lies in the buffer, as its header says.
struct Geometry {
  cv::Size size;
  std::size_t padding = 0;  // bytes after each row
  std::uint32_t format = 0;
};

std::optional<Geometry> geometry_of(ArvBuffer* buffer) {
  // Of a frame with chunks behind the image the header tells nothing.
  if (arv_buffer_get_payload_type(buffer) != ARV_BUFFER_PAYLOAD_TYPE_IMAGE) return std::nullopt;
  Geometry geometry;
  gint x_padding = 0, y_padding = 0;
  arv_buffer_get_image_region(buffer, nullptr, nullptr, &geometry.size.width, &geometry.size.height);
  arv_buffer_get_image_padding(buffer, &x_padding, &y_padding);
  geometry.padding = static_cast<std::size_t>(std::max(x_padding, 0));
  geometry.format = static_cast<std::uint32_t>(arv_buffer_get_image_pixel_format(buffer));
  return geometry;
}

cv::Mat image_of(ArvBuffer* buffer, std::size_t allocated, const CameraSetup& setup, bool is_complete) {
  size_t received = 0;
  const auto* const data = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, &received));
  std::size_t padding = 0;
  if (is_complete) {
    const auto geometry = geometry_of(buffer).value_or(Geometry{setup.facts.size, 0, setup.wire.code});
    if (geometry.size != setup.facts.size || geometry.format != setup.wire.code) return {};
    padding = geometry.padding;
  }
  const std::size_t bytes = is_complete ? std::min<std::size_t>(received, allocated) : allocated;
  return unpack_image(std::span(data, bytes), setup.wire, setup.facts.size, padding);
}

}  // namespace

HostTime host_time_of_realtime(std::int64_t realtime_ns) {
  const HostTime now = HostClock::now();
  const std::chrono::nanoseconds age(g_get_real_time() * 1000 - realtime_ns);
  const bool is_plausible = age >= std::chrono::nanoseconds::zero() && age <= std::chrono::seconds(1);
  return is_plausible ? now - age : now;
}

Frame frame_of_buffer(ArvBuffer* buffer, std::size_t allocated, const CameraSetup& setup, BlockIds& ids) {
  const bool is_complete = arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS;
  const guint64 id = arv_buffer_get_frame_id(buffer);
  Frame frame;
  frame.format = setup.wire.format;
  frame.image = image_of(buffer, allocated, setup, is_complete);
  frame.stamp.is_damaged = !is_complete || frame.image.empty();
  if (id == kNoFrameId) {  // the header is among what is missing
    frame.stamp.host_time = HostClock::now();
    return frame;
  }
  frame.stamp.sequence = ids.unwrapped(id);
  frame.stamp.device_time = Timestamp(std::chrono::nanoseconds(arv_buffer_get_timestamp(buffer)));
  frame.stamp.host_time = host_time_of_realtime(static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer)));
  frame.time = *frame.stamp.device_time;
  return frame;
}

}  // namespace alidade
