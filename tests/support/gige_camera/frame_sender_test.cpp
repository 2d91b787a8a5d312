// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/frame_sender.h"

#include <map>

#include <gtest/gtest.h>

namespace alidade::test {
namespace {

constexpr const char* kAddress = "127.0.0.1";

std::shared_ptr<OutgoingFrame> frame_of(std::uint16_t id, std::size_t bytes) {
  auto frame = std::make_shared<OutgoingFrame>();
  frame->id = id;
  frame->data_per_packet = 100;
  frame->leader = {1};
  frame->trailer = {2};
  for (std::size_t i = 0; i < bytes; ++i) frame->payload.push_back(static_cast<std::uint8_t>(i * 7));
  return frame;
}

// The packets that came, by number.
std::map<std::uint32_t, Bytes> received(const UdpSocket& socket) {
  std::map<std::uint32_t, Bytes> packets;
  while (const auto datagram = socket.receive(std::chrono::milliseconds(20))) {
    const std::uint32_t packet = read_big_endian<std::uint32_t>(std::span(datagram->first).subspan(4)) & 0xffffffU;
    packets[packet] = datagram->first;
  }
  return packets;
}

TEST(FrameSender, SendsLeaderPayloadAndTrailerInOrder) {
  const UdpSocket client(kAddress, 0);
  FrameSender sender(kAddress, {});
  const auto frame = frame_of(9, 250);
  sender.send(frame, client.own());
  const auto packets = received(client);
  ASSERT_EQ(packets.size(), 5U);
  EXPECT_EQ(packets.at(0), (Bytes{0, 0, 0, 9, 1, 0, 0, 0, 1}));
  EXPECT_EQ(packets.at(4), (Bytes{0, 0, 0, 9, 2, 0, 0, 4, 2}));
  EXPECT_EQ(packets.at(3).size(), kGvspHeaderSize + 50);
  EXPECT_EQ(packets.at(2)[kGvspHeaderSize], frame->payload[100]);
}

TEST(FrameSender, SendsKeptFramesAgainAndSaysWhichAreGone) {
  const UdpSocket client(kAddress, 0);
  FrameSender sender(kAddress, {.kept_frames = 2});
  for (const std::uint16_t id : {1, 2, 3}) sender.send(frame_of(id, 250), client.own());
  received(client);
  sender.resend({.frame_id = 2, .first = 1, .last = 2}, client.own());
  EXPECT_EQ(received(client).size(), 2U);
  sender.resend({.frame_id = 1, .first = 1, .last = 2}, client.own());
  const auto packets = received(client);
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(read_big_endian<std::uint16_t>(packets.at(1)), 0x800c);
  EXPECT_EQ(sender.counts().resent, 2U);
  EXPECT_EQ(sender.counts().unavailable, 1U);
}

TEST(FrameSender, LosesTheShareAskedForAndCountsIt) {
  const UdpSocket client(kAddress, 0);
  FrameSender sender(kAddress, {.loss = 0.1, .seed = 5});
  std::size_t came = 0;
  for (std::uint16_t id = 1; id <= 40; ++id) {
    sender.send(frame_of(id, 4800), client.own());
    came += received(client).size();
  }
  EXPECT_EQ(sender.counts().sent, 2000U);
  EXPECT_EQ(came, 2000U - sender.counts().lost);
  EXPECT_NEAR(static_cast<double>(sender.counts().lost), 200, 54);  // 4 sigma
}

}  // namespace
}  // namespace alidade::test
