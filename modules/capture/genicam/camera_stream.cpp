// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/camera_stream.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <arv.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "capture/genicam/thread_urgency.h"

namespace alidade {
namespace {

// A lost packet is asked for anew 1 ms after the one behind it came, then every 10 ms; and so are all that are missing
// of a frame of which nothing has come for 10 ms (sooner, and a camera that pauses within a frame would be asked for
// what it has not sent yet), up to twice the packets of a frame. A frame is given up 100 ms after its last packet; the
// ones behind it wait as long.
constexpr unsigned kInitialPacketTimeoutUs = 1000;
constexpr unsigned kPacketTimeoutUs = 10000;
constexpr unsigned kFrameRetentionUs = 100000;
constexpr double kPacketRequestRatio = 2;

// Buffers for what comes in 0.5 s, while frames wait for lost packets or we for the processor.
constexpr double kBufferedSeconds = 0.5;
constexpr std::size_t kLeastBuffers = 8, kMostBuffers = 400, kMostBufferBytes = 512u << 20;

constexpr int kSocketBytes = 32 << 20;

void begin_receiving(void*, ArvStreamCallbackType type, ArvBuffer*) {
  if (type == ARV_STREAM_CALLBACK_TYPE_INIT) make_this_thread_urgent();  // packets not fetched in time are lost
}

bool is_udp_socket_at(int fd, int port) {
  int type = 0;
  socklen_t size = sizeof type;
  if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) return false;
  sockaddr_in own{};
  size = sizeof own;
  return getsockname(fd, reinterpret_cast<sockaddr*>(&own), &size) == 0 && own.sin_family == AF_INET &&
         ntohs(own.sin_port) == port;
}

// Aravis hides its socket, and asks for no more than net.core.rmem_max allows: so it is found by its port.
void enlarge_socket_buffer(int port) {
  std::error_code none_left;
  for (std::filesystem::directory_iterator file("/proc/self/fd", none_left), end; file != end;
       file.increment(none_left)) {
    const int fd = std::atoi(file->path().filename().c_str());
    if (!is_udp_socket_at(fd, port)) continue;
    if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &kSocketBytes, sizeof kSocketBytes) == 0) return;
    setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &kSocketBytes, sizeof kSocketBytes);
  }
}

void tune_gige_stream(ArvStream* stream) {
  g_object_set(stream, "packet-timeout", kPacketTimeoutUs, "initial-packet-timeout", kInitialPacketTimeoutUs,
               "frame-retention", kFrameRetentionUs, "packet-request-ratio", kPacketRequestRatio, nullptr);
  enlarge_socket_buffer(arv_gv_stream_get_port(ARV_GV_STREAM(stream)));
}

std::size_t buffer_count(std::size_t bytes, std::optional<std::chrono::nanoseconds> period) {
  const double rate_hz = period ? 1e9 / static_cast<double>(period->count()) : 100;
  const auto wanted = static_cast<std::size_t>(std::min(rate_hz * kBufferedSeconds, double{kMostBuffers}));
  return std::max(kLeastBuffers, std::min(wanted, kMostBufferBytes / std::max<std::size_t>(bytes, 1)));
}

}  // namespace

GObjectPointer<ArvStream> open_stream(ArvCamera* camera, std::size_t payload_bytes,
                                      std::optional<std::chrono::nanoseconds> period, const std::string& source) {
  ArvDevice* const device = arv_camera_get_device(camera);
  // The packet socket would deliver in blocks, up to 5 ms late, and only to root.
  if (ARV_IS_GV_DEVICE(device)) {
    arv_gv_device_set_stream_options(ARV_GV_DEVICE(device), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  }
  AravisFault fault;
  GObjectPointer<ArvStream> stream(arv_camera_create_stream(camera, begin_receiving, nullptr, fault.out()));
  fault.check(source, "open its stream");
  if (ARV_IS_GV_STREAM(stream.get())) tune_gige_stream(stream.get());
  for (std::size_t i = buffer_count(payload_bytes, period); i > 0; --i) {
    void* const bytes = g_malloc0(payload_bytes);
    ArvBuffer* const buffer = arv_buffer_new_full(payload_bytes, bytes, bytes, g_free);
    arv_buffer_set_frame_id(buffer, kNoFrameId);
    arv_stream_push_buffer(stream.get(), buffer);
  }
  return stream;
}

std::vector<std::pair<std::string, std::uint64_t>> stream_statistics(ArvStream* stream) {
  guint64 completed = 0, failed = 0, underruns = 0, resent = 0, missing = 0;
  arv_stream_get_statistics(stream, &completed, &failed, &underruns);
  if (ARV_IS_GV_STREAM(stream)) arv_gv_stream_get_statistics(ARV_GV_STREAM(stream), &resent, &missing);
  return {{"completed frames", completed},
          {"damaged frames", failed},
          {"frames without a buffer", underruns},
          {"resent packets", resent},
          {"missing packets", missing}};
}

}  // namespace alidade
