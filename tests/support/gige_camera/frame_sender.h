// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <random>
#include <vector>

#include "tests/support/gige_camera/gvcp_message.h"
#include "tests/support/gige_camera/gvsp_packet.h"
#include "tests/support/gige_camera/udp_socket.h"

namespace alidade::test {

/// A frame as it goes out, kept for a while to be sent again.
struct OutgoingFrame {
  std::uint16_t id = 0;
  Bytes leader, payload, trailer;
  std::size_t data_per_packet = 0;  ///< bytes of payload

  std::uint32_t packet_count() const {
    return static_cast<std::uint32_t>((payload.size() + data_per_packet - 1) / data_per_packet) + 2;
  }
};

/// What was sent, in packets.
struct SenderCounts {
  std::uint64_t sent = 0;         ///< asked of the network, lost ones included
  std::uint64_t lost = 0;         ///< kept back, to be as if lost
  std::uint64_t resent = 0;       ///< of the sent: because the other side asked
  std::uint64_t unavailable = 0;  ///< asked for too late
};

struct SenderOptions {
  double loss = 0;              ///< share of packets that are lost, first and resent ones alike
  std::uint32_t seed = 1;       ///< of the loss
  double link_mb_per_s = 1000;  ///< 10⁶ bytes per second that the link carries; 0: as many as it can
  std::size_t kept_frames = 8;
};

/// Sends frames in packets, and packets again. For several threads at once.
class FrameSender {
 public:
  FrameSender(const std::string& address, const SenderOptions& options);

  std::uint16_t source_port() const { return socket_.own().port; }
  void set_loss(double share);

  /// The frame is kept, and must not be written any more.
  void send(const std::shared_ptr<OutgoingFrame>& frame, const Peer& to);
  void resend(const ResendRequest& request, const Peer& to);
  /// A packet of `packet_size` bytes (with the headers of IP and UDP), to see whether it comes through.
  void send_test_packet(std::size_t packet_size, const Peer& to) const;
  /// A frame that is no longer kept, to be used again; a new one where all are.
  std::shared_ptr<OutgoingFrame> spare_frame();
  /// Keeps no frame any longer: another acquisition begins, and counts anew.
  void forget();

  SenderCounts counts() const;

 private:
  std::vector<std::uint32_t> draw_kept(std::uint32_t first, std::uint32_t last);
  void send_packets(const OutgoingFrame& frame, std::span<const std::uint32_t> packets, const Peer& to) const;

  UdpSocket socket_;
  SenderOptions options_;
  mutable std::mutex mutex_;  // of all below
  std::mt19937 random_;
  SenderCounts counts_;
  std::deque<std::shared_ptr<OutgoingFrame>> kept_;
};

}  // namespace alidade::test
