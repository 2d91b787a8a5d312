// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <stop_token>
#include <thread>

#include "tests/support/gige_camera/camera_log.h"
#include "tests/support/gige_camera/camera_registers.h"
#include "tests/support/gige_camera/control_channel.h"
#include "tests/support/gige_camera/device_clock.h"
#include "tests/support/gige_camera/frame_sender.h"
#include "tests/support/gige_camera/picture_source.h"

namespace alidade::test {

struct GigeCameraOptions {
  CameraSetup setup;
  SenderOptions sender;
  DeviceClock clock;
  std::uint16_t first_frame_id = 1;  ///< of each acquisition
  double drop_share = 0;             ///< of frames, counted but never sent; drawn with the sender's seed
  std::chrono::milliseconds resend_delay{};
  std::optional<std::filesystem::path> log;
};

/// A GigE Vision camera on an address of this machine: it answers discovery, reads and writes of registers, obeys one
/// program, exposes by its own clock or upon a trigger, and sends frames, and lost packets again. It runs from
/// construction to destruction in two threads. Frames are counted from `first_frame_id` with each start.
class GigeCamera {
 public:
  /// Throws DeviceError where the address is in use.
  GigeCamera(const GigeCameraOptions& options, std::unique_ptr<PictureSource> pictures);
  ~GigeCamera();

  /// The signal at the camera's line 0: one exposure, where it is waiting for that.
  void pulse();
  /// No exposures for that long; commands are still answered.
  void stall(std::chrono::nanoseconds duration);
  /// The next `count` frames are counted but never sent.
  void drop_frames(int count);
  void set_packet_loss(double share) { sender_.set_loss(share); }
  /// Commands are not answered for that long; frames go on.
  void ignore_commands(std::chrono::nanoseconds duration);

  SenderCounts counts() const { return sender_.counts(); }

 private:
  struct PendingResend {
    HostTime due;
    ResendRequest request;
  };

  struct Exposure {
    std::stop_token stop;
    int acquisition;
    std::uint64_t frame;
    HostTime start;
  };

  void serve_commands(const std::stop_token& stop);
  void obey(const ControlReply& reply, const Peer& sender, HostTime now);
  void send_due_resends(HostTime now);
  void expose_always(const std::stop_token& stop);
  void run_acquisition(const std::stop_token& stop);
  bool expose(const Exposure& exposure, const AcquisitionSettings& settings);
  std::optional<HostTime> next_exposure(const std::stop_token& stop, std::optional<HostTime> last,
                                        const AcquisitionSettings& settings);
  bool wait_until(std::unique_lock<std::mutex>& lock, const std::stop_token& stop, HostTime time);
  bool is_frame_dropped();
  void start_acquisition();
  void stop_acquisition();
  void trigger(HostTime now);
  Peer stream_peer() const;

  const GigeCameraOptions options_;
  std::unique_ptr<PictureSource> pictures_;
  std::optional<CameraLog> log_;
  CameraRegisters registers_;
  ControlChannel control_;
  FrameSender sender_;
  UdpSocket commands_;
  std::deque<PendingResend> resends_;  // of the thread of commands only

  std::mutex mutex_;  // of all below
  std::condition_variable_any changed_;
  bool is_acquiring_ = false;
  int acquisition_ = 0;
  int frames_to_drop_ = 0;
  std::deque<HostTime> triggers_;
  HostTime stalled_until_{};
  HostTime deaf_until_{};
  std::mt19937 random_;

  std::jthread commander_;
  std::jthread exposer_;
};

}  // namespace alidade::test
