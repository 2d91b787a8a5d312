// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_stream.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include <linux/videodev2.h>
#include <sys/mman.h>

namespace alidade {
namespace {

/// A v4l2_buffer with room for its planes.
struct BufferCall {
  BufferCall(const V4l2Device& device, std::uint32_t index) {
    buffer.index = index;
    buffer.type = device.identity().buffer_type;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (!device.identity().is_multiplanar) return;
    buffer.m.planes = planes.data();
    buffer.length = planes.size();
  }
  BufferCall(const BufferCall&) = delete;
  BufferCall& operator=(const BufferCall&) = delete;

  std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
  v4l2_buffer buffer{};
};

CameraError lost(const V4l2Device& device, const std::string& operation, int error) {
  const bool known = error == ENODEV || error == ENXIO;
  return {CameraTrouble::Gone, device.path(), operation,
          known ? "the device is gone" : std::generic_category().message(error), "is it plugged in?"};
}

std::span<const std::uint8_t> filled_part(std::span<const std::uint8_t> memory, std::size_t from, std::size_t to) {
  to = std::min(to, memory.size());
  from = std::min(from, to);
  return memory.subspan(from, to - from);
}

}  // namespace

Mapping::Mapping(const V4l2Device& device, std::size_t length, std::uint32_t offset) {
  void* memory = mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, device.descriptor(), offset);
  if (memory == MAP_FAILED) throw v4l2_error(device.path(), "map its buffers", errno);
  bytes_ = {static_cast<std::uint8_t*>(memory), length};
}

Mapping::~Mapping() {
  if (!bytes_.empty()) munmap(bytes_.data(), bytes_.size());
}

Mapping::Mapping(Mapping&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

V4l2Stream::V4l2Stream(const V4l2Device& device, int buffers) : device_(device) {
  v4l2_requestbuffers request{};
  request.count = static_cast<__u32>(buffers);
  request.type = device.identity().buffer_type;
  request.memory = V4L2_MEMORY_MMAP;
  device.require(VIDIOC_REQBUFS, &request, "reserve buffers");
  try {
    map_buffers(request.count);
    for (std::uint32_t i = 0; i < request.count; ++i) {
      if (const int error = queue(i)) throw v4l2_error(device.path(), "queue buffers", error);
    }
    int type = static_cast<int>(device.identity().buffer_type);
    device.require(VIDIOC_STREAMON, &type, "start streaming");
  } catch (...) {
    stop();
    throw;
  }
}

V4l2Stream::~V4l2Stream() {
  stop();
}

void V4l2Stream::map_buffers(std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    BufferCall call(device_, i);
    device_.require(VIDIOC_QUERYBUF, &call.buffer, "map its buffers");
    flags_ = call.buffer.flags;
    auto& planes = buffers_.emplace_back();
    if (!device_.identity().is_multiplanar) {
      planes.emplace_back(device_, call.buffer.length, call.buffer.m.offset);
      continue;
    }
    for (std::uint32_t plane = 0; plane < call.buffer.length; ++plane)
      planes.emplace_back(device_, call.planes[plane].length, call.planes[plane].m.mem_offset);
  }
}

int V4l2Stream::queue(std::uint32_t index) {
  BufferCall call(device_, index);
  if (device_.identity().is_multiplanar) call.buffer.length = static_cast<__u32>(buffers_[index].size());
  return device_.call(VIDIOC_QBUF, &call.buffer);
}

// Faults do not matter here: the driver frees all when the device is closed.
void V4l2Stream::stop() {
  int type = static_cast<int>(device_.identity().buffer_type);
  device_.call(VIDIOC_STREAMOFF, &type);
  buffers_.clear();
  v4l2_requestbuffers none{};
  none.type = device_.identity().buffer_type;
  none.memory = V4L2_MEMORY_MMAP;
  device_.call(VIDIOC_REQBUFS, &none);
}

std::optional<V4l2Filled> V4l2Stream::take() {
  for (; !unwanted_.empty(); unwanted_.pop_back()) {
    if (const int error = queue(unwanted_.back())) throw lost(device_, "queue buffers", error);
  }
  BufferCall call(device_, 0);
  const int error = device_.call(VIDIOC_DQBUF, &call.buffer);
  if (error == EAGAIN) return std::nullopt;
  if (error != 0) throw lost(device_, "read a frame", error);

  const v4l2_buffer& buffer = call.buffer;
  V4l2Filled filled{buffer.index, buffer.flags, buffer.sequence, {}, {}};
  filled.time = std::chrono::seconds(buffer.timestamp.tv_sec) + std::chrono::microseconds(buffer.timestamp.tv_usec);
  const auto& planes = buffers_.at(buffer.index);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (device_.identity().is_multiplanar) {
      filled.planes.push_back(filled_part(planes[i].bytes(), call.planes[i].data_offset, call.planes[i].bytesused));
    } else {
      filled.planes.push_back(filled_part(planes[i].bytes(), 0, buffer.bytesused));
    }
  }
  return filled;
}

void V4l2Stream::give_back(std::uint32_t index) {
  if (queue(index) != 0) unwanted_.push_back(index);
}

}  // namespace alidade
