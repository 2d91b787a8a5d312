// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/v4l2/loop_output.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <linux/v4l2-dv-timings.h>
#include <linux/videodev2.h>
#include <poll.h>

#include "capture/v4l2/v4l2_formats.h"
#include "tests/faults/v4l2/vivid.h"

namespace alidade::test {
namespace {

constexpr std::uint32_t kBuffers = 4;

const V4l2Format& format_of(const RawFrames& frames) {
  const auto code = parse_v4l2_format_name(frames.format);
  const V4l2Format* format = code ? find_v4l2_format(*code) : nullptr;
  if (!format) throw std::invalid_argument("no format " + frames.format);
  return *format;
}

/// 1280x720 at 30 Hz, or with as few pixels around the picture and as slow as the driver takes it.
v4l2_dv_timings signal_of(const RawFrames& frames) {
  v4l2_dv_timings timings = V4L2_DV_BT_CEA_1280X720P30;
  if (!frames.is_slow) return timings;
  v4l2_bt_timings slow{};
  slow.width = 1280;
  slow.height = 720;
  slow.polarities = V4L2_DV_HSYNC_POS_POL;
  slow.pixelclock = 15'500'000;  // of 1440 x 735 in all: 14.4 Hz
  slow.hfrontporch = 48;
  slow.hsync = 32;
  slow.hbackporch = 80;
  slow.vfrontporch = 3;
  slow.vsync = 5;
  slow.vbackporch = 7;
  slow.standards = V4L2_DV_BT_STD_CVT;
  slow.flags = V4L2_DV_FL_REDUCED_BLANKING;
  timings.bt = slow;
  return timings;
}

// Both ends must agree on the signal. It is larger than most frames: vivid scales them up on one side and down by as
// much on the other, which it does by copying them.
void connect(const RawFrames& frames) {
  v4l2_dv_timings timings = signal_of(frames);
  for (const char* path : {kLoopInput, kLoopOutput})
    V4l2Device(path).require(VIDIOC_S_DV_TIMINGS, &timings, "set the video signal");
  set_control(kLoopInput, "loop_video", "on");
  set_control(kLoopInput, "osd_text_mode", "None");
}

void set_format(const V4l2Device& device, const RawFrames& frames) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = static_cast<__u32>(frames.size.width);
  format.fmt.pix.height = static_cast<__u32>(frames.size.height);
  format.fmt.pix.pixelformat = format_of(frames).code;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  device.require(VIDIOC_S_FMT, &format, "set the format");
  if (format.fmt.pix.sizeimage != frames.frame_bytes())
    throw v4l2_refusal(device.path(), "set the format", "frames of this size are not taken", "take another size");
}

v4l2_buffer buffer_call(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

}  // namespace

std::size_t RawFrames::frame_bytes() const {
  const V4l2Format& known = format_of(*this);
  return v4l2_row_bytes(known, size.width) * static_cast<std::size_t>(mat_size(known.pixels, size).height);
}

std::span<const std::uint8_t> RawFrames::frame(int index) const {
  return bytes.subspan(static_cast<std::size_t>(index) * frame_bytes(), frame_bytes());
}

LoopOutput::LoopOutput(const RawFrames& frames) : frames_(frames), device_((connect(frames), kLoopOutput)) {
  if (frames.count() < 1) throw std::invalid_argument("LoopOutput: needs a frame");
  set_format(device_, frames);
  v4l2_requestbuffers request{};
  request.count = kBuffers;
  request.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  request.memory = V4L2_MEMORY_MMAP;
  device_.require(VIDIOC_REQBUFS, &request, "reserve buffers");
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = buffer_call(i);
    device_.require(VIDIOC_QUERYBUF, &buffer, "map its buffers");
    buffers_.emplace_back(device_, buffer.length, buffer.m.offset);
  }
  queue(unused_++, 0);
  int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  device_.require(VIDIOC_STREAMON, &type, "start streaming");
}

LoopOutput::~LoopOutput() {
  int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  device_.call(VIDIOC_STREAMOFF, &type);
}

void LoopOutput::queue(std::uint32_t index, int frame) {
  const auto from = frames_.frame(frame);
  const auto to = buffers_.at(index).bytes();
  std::memcpy(const_cast<std::uint8_t*>(to.data()), from.data(), from.size());
  v4l2_buffer buffer = buffer_call(index);
  buffer.bytesused = static_cast<__u32>(from.size());
  device_.require(VIDIOC_QBUF, &buffer, "queue a frame");
}

std::uint32_t LoopOutput::free_buffer(std::stop_token stop) {
  if (unused_ < buffers_.size()) return unused_++;
  v4l2_buffer buffer = buffer_call(0);
  while (true) {
    const int error = device_.call(VIDIOC_DQBUF, &buffer);
    if (error == 0 || stop.stop_requested()) return buffer.index;
    if (error != EAGAIN) throw v4l2_error(device_.path(), "get a buffer back", error);
    pollfd waiting{device_.descriptor(), POLLOUT, 0};
    poll(&waiting, 1, 100);
  }
}

void LoopOutput::show_all(std::stop_token stop) {
  for (int frame = 1; frame < frames_.count(); ++frame) {
    const std::uint32_t buffer = free_buffer(stop);
    if (stop.stop_requested()) return;
    queue(buffer, frame);
  }
}

CameraRequest loop_request(const RawFrames& frames) {
  CameraRequest request;
  request.size = frames.size;
  request.pixel_format = frames.format;
  return request;
}

}  // namespace alidade::test
