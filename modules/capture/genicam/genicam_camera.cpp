// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/genicam_camera.h"

#include <atomic>
#include <optional>
#include <utility>

#include <arv.h>

#include "capture/genicam/background_release.h"
#include "capture/genicam/camera_opening.h"
#include "capture/genicam/camera_setup.h"
#include "capture/genicam/camera_stream.h"
#include "capture/genicam/frame_of_buffer.h"
#include "capture/genicam/gvcp.h"
#include "capture/genicam/heartbeat.h"
#include "capture/genicam/packet_size.h"
#include "capture/genicam/software_trigger.h"

namespace alidade {
namespace {

// All that talks to the camera, taken down from the end: the stream stops before the camera is let go.
struct Connection {
  std::atomic<bool> is_lost = false;  // set by Aravis' thread
  OpenedCamera opened;
  GObjectPointer<ArvStream> stream;
  std::optional<SoftwareTrigger> trigger;

  ~Connection() {
    trigger.reset();
    stream.reset();
    if (opened.camera) await_heartbeat(opened.camera.get(), &is_lost);
  }
};

void note_loss(ArvDevice*, void* is_lost) {
  *static_cast<std::atomic<bool>*>(is_lost) = true;
}

class GenicamCamera : public CameraDevice {
 public:
  GenicamCamera(const std::string& id, const CameraRequest& request, const std::string& source)
      : connection_(std::make_unique<Connection>()), source_(source) {
    connection_->opened = open_camera(id, source);
    try {
      start(request);
    } catch (...) {
      close();
      throw;
    }
  }

  ~GenicamCamera() override { close(); }

  const CameraFacts& facts() const override { return setup_.facts; }

  std::optional<Frame> wait(std::chrono::nanoseconds timeout) override {
    const auto patience_us = std::chrono::ceil<std::chrono::microseconds>(timeout).count();
    ArvStream* const stream = connection_->stream.get();
    ArvBuffer* const buffer =
        arv_stream_timeout_pop_buffer(stream, patience_us > 0 ? static_cast<guint64>(patience_us) : 0);
    if (!buffer) {
      if (!connection_->is_lost) return std::nullopt;
      throw CameraError(CameraTrouble::Gone, source_, "wait for a frame", "the camera no longer answers",
                        "check power and cable");
    }
    Frame frame = frame_of_buffer(buffer, payload_bytes_, setup_, ids_);
    arv_buffer_set_frame_id(buffer, kNoFrameId);  // else it would stay should the next header be lost
    arv_stream_push_buffer(stream, buffer);
    return frame;
  }

  std::vector<std::pair<std::string, std::uint64_t>> statistics() const override {
    return stream_statistics(connection_->stream.get());
  }

 private:
  void start(const CameraRequest& request) {
    ArvCamera* const camera = connection_->opened.camera.get();
    g_signal_connect(arv_camera_get_device(camera), "control-lost", G_CALLBACK(note_loss), &connection_->is_lost);
    setup_ = set_up_camera(camera, request, source_);
    if (arv_camera_is_gv_device(camera)) {
      choose_packet_size(camera, connection_->opened.address, request.packet_size, source_);
    }
    AravisFault fault;
    payload_bytes_ = arv_camera_get_payload(camera, fault.out());
    fault.check(source_, "read its payload size");
    connection_->stream = open_stream(camera, payload_bytes_, setup_.facts.period, source_);
    arv_camera_start_acquisition(camera, fault.out());
    fault.check(source_, "start");
    if (request.trigger == CameraTrigger::Software) start_trigger(camera);
  }

  void start_trigger(ArvCamera* camera) {
    if (!setup_.facts.period) {
      throw CameraError(CameraTrouble::Refused, source_, "set the software trigger", "no frame rate is known",
                        "give one");
    }
    connection_->trigger.emplace(*setup_.facts.period,
                                 [camera] { arv_camera_software_trigger(camera, AravisFault().out()); });
  }

  // A camera that is gone lets every register write run into a time-out of seconds: nobody waits for these.
  void close() {
    if (is_there()) {
      connection_->trigger.reset();
      arv_camera_stop_acquisition(connection_->opened.camera.get(), AravisFault().out());
      connection_.reset();
      return;
    }
    release_in_background(
        [connection = std::shared_ptr<Connection>(std::move(connection_))]() mutable { connection.reset(); });
  }

  bool is_there() const {
    constexpr std::chrono::milliseconds kPatience{150};
    const std::string& address = connection_->opened.address;
    return !connection_->is_lost && (address.empty() || ask_gige_camera(address, kPatience));
  }

  std::unique_ptr<Connection> connection_;
  std::string source_;
  CameraSetup setup_;
  std::size_t payload_bytes_ = 0;
  BlockIds ids_;
};

}  // namespace

std::unique_ptr<CameraDevice> open_genicam(const std::string& id, const CameraRequest& request) {
  return std::make_unique<GenicamCamera>(id, request, "genicam:" + id);
}

}  // namespace alidade
