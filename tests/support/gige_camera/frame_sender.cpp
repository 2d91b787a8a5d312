// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/frame_sender.h"

#include <algorithm>
#include <array>
#include <thread>

#include <sys/socket.h>

namespace alidade::test {
namespace {

constexpr std::size_t kBatch = 64;               // packets per call of the kernel
constexpr std::size_t kPacedBytes = 128 * 1024;  // on a link of limited rate: bytes between two looks at the clock
constexpr int kSendBuffer = 4 << 20;

std::span<const std::uint8_t> data_of(const OutgoingFrame& frame, std::uint32_t packet) {
  if (packet == 0) return frame.leader;
  if (packet + 1 == frame.packet_count()) return frame.trailer;
  const std::size_t from = (packet - 1) * frame.data_per_packet;
  return std::span(frame.payload).subspan(from, std::min(frame.data_per_packet, frame.payload.size() - from));
}

GvspHeader header_of(const OutgoingFrame& frame, std::uint32_t packet) {
  const bool is_last = packet + 1 == frame.packet_count();
  const GvspContent content = packet == 0 ? GvspContent::Leader : is_last ? GvspContent::Trailer : GvspContent::Payload;
  return gvsp_header(frame.id, content, packet);
}

// Packets on their way into the kernel, which takes them together.
class Batch {
 public:
  explicit Batch(const Peer& to) : to_(socket_address(to)) {}

  bool is_full() const { return count_ == kBatch; }
  std::size_t bytes() const { return bytes_; }

  void add(const GvspHeader& header, std::span<const std::uint8_t> data) {
    headers_[count_] = header;
    parts_[2 * count_] = {headers_[count_].data(), header.size()};
    parts_[2 * count_ + 1] = {const_cast<std::uint8_t*>(data.data()), data.size()};  // iovec knows no const
    messages_[count_] = {};
    messages_[count_].msg_hdr.msg_name = &to_;
    messages_[count_].msg_hdr.msg_namelen = sizeof to_;
    messages_[count_].msg_hdr.msg_iov = &parts_[2 * count_];
    messages_[count_].msg_hdr.msg_iovlen = 2;
    bytes_ += data.size();
    ++count_;
  }

  void flush(int socket) {
    for (std::size_t done = 0; done < count_;) {
      const int sent = ::sendmmsg(socket, &messages_[done], static_cast<unsigned>(count_ - done), 0);
      done += sent > 0 ? static_cast<std::size_t>(sent) : 1;  // what the kernel refuses is lost, as on a wire
    }
    count_ = 0;
  }

 private:
  sockaddr_in to_;
  std::size_t count_ = 0;
  std::size_t bytes_ = 0;
  std::array<GvspHeader, kBatch> headers_{};
  std::array<iovec, 2 * kBatch> parts_{};
  std::array<mmsghdr, kBatch> messages_{};
};

}  // namespace

FrameSender::FrameSender(const std::string& address, const SenderOptions& options)
    : socket_(address, 0), options_(options), random_(options.seed) {
  ::setsockopt(socket_.descriptor(), SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
}

void FrameSender::set_loss(double share) {
  const std::lock_guard lock(mutex_);
  options_.loss = share;
}

std::vector<std::uint32_t> FrameSender::draw_kept(std::uint32_t first, std::uint32_t last) {
  const std::lock_guard lock(mutex_);
  std::bernoulli_distribution is_lost(options_.loss);
  std::vector<std::uint32_t> kept;
  kept.reserve(last - first + 1);
  for (std::uint32_t packet = first; packet <= last; ++packet) {
    if (options_.loss == 0 || !is_lost(random_)) kept.push_back(packet);
  }
  counts_.sent += last - first + 1;
  counts_.lost += last - first + 1 - kept.size();
  return kept;
}

void FrameSender::send_packets(const OutgoingFrame& frame, std::span<const std::uint32_t> packets,
                               const Peer& to) const {
  Batch batch(to);
  const HostTime start = HostClock::now();
  const bool is_paced = options_.link_mb_per_s > 0;
  std::size_t paced = 0;
  for (const std::uint32_t packet : packets) {
    batch.add(header_of(frame, packet), data_of(frame, packet));
    const bool is_due = is_paced && batch.bytes() - paced >= kPacedBytes;
    if (!batch.is_full() && !is_due) continue;
    batch.flush(socket_.descriptor());
    if (!is_due) continue;
    paced = batch.bytes();
    const std::chrono::duration<double> needed(static_cast<double>(paced) / (options_.link_mb_per_s * 1e6));
    std::this_thread::sleep_until(start + std::chrono::duration_cast<std::chrono::nanoseconds>(needed));
  }
  batch.flush(socket_.descriptor());
}

void FrameSender::send(const std::shared_ptr<OutgoingFrame>& frame, const Peer& to) {
  {
    const std::lock_guard lock(mutex_);
    kept_.push_back(frame);
    while (kept_.size() > options_.kept_frames) kept_.pop_front();
  }
  send_packets(*frame, draw_kept(0, frame->packet_count() - 1), to);
}

void FrameSender::resend(const ResendRequest& request, const Peer& to) {
  std::shared_ptr<const OutgoingFrame> frame;
  {
    const std::lock_guard lock(mutex_);
    const auto found =
        std::find_if(kept_.begin(), kept_.end(), [&](const auto& f) { return f->id == request.frame_id; });
    if (found != kept_.end()) frame = *found;
    if (!frame) ++counts_.unavailable;
  }
  if (!frame) return socket_.send(gvsp_unavailable_header(request.frame_id, request.first), to);
  const std::uint32_t last = std::min(request.last, frame->packet_count() - 1);
  if (request.first > last) return;
  {
    const std::lock_guard lock(mutex_);
    counts_.resent += last - request.first + 1;
  }
  send_packets(*frame, draw_kept(request.first, last), to);
}

void FrameSender::send_test_packet(std::size_t packet_size, const Peer& to) const {
  constexpr std::size_t kHeaders = kGvspOverhead - kGvspHeaderSize;
  socket_.send(Bytes(packet_size - kHeaders), to);
}

std::shared_ptr<OutgoingFrame> FrameSender::spare_frame() {
  const std::lock_guard lock(mutex_);
  if (kept_.empty() || kept_.size() < options_.kept_frames || kept_.front().use_count() > 1)
    return std::make_shared<OutgoingFrame>();
  const std::shared_ptr<OutgoingFrame> spare = kept_.front();
  kept_.pop_front();
  return spare;
}

void FrameSender::forget() {
  const std::lock_guard lock(mutex_);
  kept_.clear();
}

SenderCounts FrameSender::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace alidade::test
