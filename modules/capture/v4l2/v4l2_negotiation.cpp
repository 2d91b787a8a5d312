// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_negotiation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <linux/videodev2.h>

#include "capture/v4l2/v4l2_choice.h"
#include "capture/v4l2/v4l2_offers.h"

namespace alidade {
namespace {

/// A v4l2_format of one or several planes in memory, read and written alike.
class FormatCall {
 public:
  explicit FormatCall(const V4l2Device& device) : device_(device), planar_(device.identity().is_multiplanar) {
    format_.type = device.identity().buffer_type;
    device.require(VIDIOC_G_FMT, &format_, "read the format");
  }

  int attempt(unsigned long request) { return device_.call(request, &format_); }
  void want(std::uint32_t code, cv::Size size);
  std::uint32_t code() const { return planar_ ? format_.fmt.pix_mp.pixelformat : format_.fmt.pix.pixelformat; }
  cv::Size size() const;
  std::vector<std::size_t> strides() const;

 private:
  const V4l2Device& device_;
  bool planar_;
  v4l2_format format_{};
};

void FormatCall::want(std::uint32_t code, cv::Size size) {
  const auto width = static_cast<std::uint32_t>(size.width);
  const auto height = static_cast<std::uint32_t>(size.height);
  format_.fmt = {};
  if (planar_) {
    format_.fmt.pix_mp.width = width;
    format_.fmt.pix_mp.height = height;
    format_.fmt.pix_mp.pixelformat = code;
    format_.fmt.pix_mp.field = V4L2_FIELD_NONE;
  } else {
    format_.fmt.pix.width = width;
    format_.fmt.pix.height = height;
    format_.fmt.pix.pixelformat = code;
    format_.fmt.pix.field = V4L2_FIELD_NONE;
  }
}

cv::Size FormatCall::size() const {
  return planar_ ? cv::Size(static_cast<int>(format_.fmt.pix_mp.width), static_cast<int>(format_.fmt.pix_mp.height))
                 : cv::Size(static_cast<int>(format_.fmt.pix.width), static_cast<int>(format_.fmt.pix.height));
}

std::vector<std::size_t> FormatCall::strides() const {
  if (!planar_) return {format_.fmt.pix.bytesperline};
  std::vector<std::size_t> strides;
  for (int i = 0; i < format_.fmt.pix_mp.num_planes; ++i)
    strides.push_back(format_.fmt.pix_mp.plane_fmt[i].bytesperline);
  return strides;
}

bool would_grant(const V4l2Device& device, std::uint32_t code, cv::Size size) {
  FormatCall format(device);
  format.want(code, size);
  return format.attempt(VIDIOC_TRY_FMT) == 0 && format.code() == code && format.size() == size;
}

std::vector<V4l2Candidate> candidates(const V4l2Device& device, std::span<const ListedFormat> offers,
                                      const CameraRequest& request, cv::Size size) {
  std::vector<V4l2Candidate> found;
  const auto wanted = request.pixel_format ? parse_v4l2_format_name(*request.pixel_format) : std::nullopt;
  if (request.pixel_format && !wanted) return found;
  for (const ListedFormat& offer : offers) {
    const auto code = parse_v4l2_format_name(offer.name);
    const V4l2Format* format = code ? find_v4l2_format(*code) : nullptr;
    if (!format || (wanted && *wanted != *code) || !would_grant(device, *code, size)) continue;
    found.push_back({format, v4l2_periods(device, *code, size)});
  }
  return found;
}

CameraError not_offered(const V4l2Device& device, std::span<const ListedFormat> offers, const CameraRequest& request,
                        cv::Size size) {
  const std::string wanted =
      request.pixel_format ? fmt::format("{} at {}", *request.pixel_format, size_text(size)) : size_text(size);
  const std::string offered = describe_offers(offers);
  return v4l2_refusal(device.path(), "set the format", wanted + " is not offered",
                      offered.empty() ? "it offers no format that can be read here" : "offered are " + offered);
}

/// Moves the region that is read out to `offset` on the sensor.
void move_region(const V4l2Device& device, cv::Point offset, cv::Size size) {
  v4l2_selection selection{};
  selection.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;  // selections know no multi-planar type
  selection.target = V4L2_SEL_TGT_CROP;
  selection.r = {offset.x, offset.y, static_cast<__u32>(size.width), static_cast<__u32>(size.height)};
  const v4l2_rect wanted = selection.r;
  const int error = device.call(VIDIOC_S_SELECTION, &selection);
  const bool granted = error == 0 && selection.r.left == wanted.left && selection.r.top == wanted.top &&
                       selection.r.width == wanted.width && selection.r.height == wanted.height;
  if (!granted)
    throw v4l2_refusal(device.path(), "set the region",
                       fmt::format("{} at ({}, {}) is not granted", size_text(size), offset.x, offset.y),
                       "leave the offset out: many cameras read only all of their sensor");
}

void set_rate(const V4l2Device& device, const V4l2Periods& offered, double fps_hz) {
  v4l2_streamparm parameters{};
  parameters.type = device.identity().buffer_type;
  parameters.parm.capture.timeperframe = nearest_period(offered, fps_hz);
  const int error = device.call(VIDIOC_S_PARM, &parameters);
  if (error == ENOTTY || error == EINVAL)
    throw v4l2_refusal(device.path(), "set the rate", "this input has a rate of its own", "leave the rate out");
  if (error != 0) throw v4l2_error(device.path(), "set the rate", error);
}

std::optional<std::chrono::nanoseconds> granted_period(const V4l2Device& device) {
  v4l2_streamparm parameters{};
  parameters.type = device.identity().buffer_type;
  if (device.call(VIDIOC_G_PARM, &parameters) != 0) return std::nullopt;
  const double rate = rate_of(parameters.parm.capture.timeperframe);
  if (rate <= 0) return std::nullopt;
  return std::chrono::nanoseconds(std::llround(1e9 / rate));
}

}  // namespace

void require_idle(const V4l2Device& device) {
  FormatCall format(device);
  if (format.attempt(VIDIOC_S_FMT) == EBUSY) throw v4l2_error(device.path(), "open", EBUSY);
}

V4l2Grant negotiate(const V4l2Device& device, const CameraRequest& request) {
  FormatCall format(device);
  const cv::Size size = request.size.value_or(format.size());
  const std::vector<ListedFormat> offers = v4l2_offers(device);
  const std::vector<V4l2Candidate> possible = candidates(device, offers, request, size);
  const V4l2Candidate* chosen = preferred(possible, request.fps_hz);
  if (!chosen) throw not_offered(device, offers, request, size);

  format.want(chosen->format->code, size);
  if (const int error = format.attempt(VIDIOC_S_FMT)) throw v4l2_error(device.path(), "set the format", error);
  if (format.code() != chosen->format->code || format.size() != size) throw not_offered(device, offers, request, size);
  if (request.offset) move_region(device, *request.offset, size);
  if (request.fps_hz) set_rate(device, chosen->periods, *request.fps_hz);
  std::vector<std::size_t> strides = format.strides();
  for (std::size_t& stride : strides) {  // some drivers leave out what the format says anyway
    if (stride == 0 && chosen->format->pixels.kind != PixelKind::Jpeg)
      stride = v4l2_row_bytes(*chosen->format, size.width);
  }
  return {chosen->format, size, std::move(strides), granted_period(device)};
}

}  // namespace alidade
