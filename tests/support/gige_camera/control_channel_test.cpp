// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/control_channel.h"

#include <gtest/gtest.h>

namespace alidade::test {
namespace {

using std::chrono::seconds;

constexpr Peer kFirst{0x7f000001, 1000};
constexpr Peer kSecond{0x7f000001, 2000};

Bytes request_bytes(GvcpCommand command, std::initializer_list<std::uint32_t> words) {
  Bytes datagram{0x42, 0x01};
  append_big_endian(datagram, static_cast<std::uint16_t>(command));
  append_big_endian(datagram, static_cast<std::uint16_t>(4 * words.size()));
  append_big_endian(datagram, std::uint16_t{77});
  for (const std::uint32_t word : words) append_big_endian(datagram, word);
  return datagram;
}

struct Camera {
  CameraRegisters registers{CameraSetup{}};
  ControlChannel channel{registers};
  HostTime now{};

  ControlReply ask(GvcpCommand command, std::initializer_list<std::uint32_t> words, const Peer& sender = kFirst) {
    return channel.reply(request_bytes(command, words), sender, now);
  }
  GvcpStatus write(std::uint32_t to, std::uint32_t value, const Peer& sender = kFirst) {
    return static_cast<GvcpStatus>(
        read_big_endian<std::uint16_t>(ask(GvcpCommand::WriteRegister, {to, value}, sender).answer));
  }
};

TEST(ControlChannel, ObeysOneProgramAtATime) {
  Camera camera;
  EXPECT_EQ(camera.write(address::kWidth, 100), GvcpStatus::AccessDenied);
  EXPECT_EQ(camera.write(address::kControlPrivilege, 2), GvcpStatus::Success);
  EXPECT_EQ(camera.write(address::kControlPrivilege, 2, kSecond), GvcpStatus::AccessDenied);
  EXPECT_EQ(camera.write(address::kWidth, 100, kSecond), GvcpStatus::AccessDenied);
  EXPECT_EQ(camera.write(address::kWidth, 100), GvcpStatus::Success);
  EXPECT_EQ(camera.registers.acquisition().region.width, 100);
}

TEST(ControlChannel, ReleasesControlWhenToldAndAfterSilence) {
  Camera camera;
  camera.write(address::kControlPrivilege, 2);
  EXPECT_EQ(camera.write(address::kControlPrivilege, 0), GvcpStatus::Success);
  EXPECT_EQ(camera.write(address::kControlPrivilege, 2, kSecond), GvcpStatus::Success);
  camera.now += seconds(2);
  camera.ask(GvcpCommand::ReadRegister, {address::kControlPrivilege}, kSecond);  // a heartbeat
  EXPECT_FALSE(camera.channel.expire(camera.now + seconds(3)));
  EXPECT_TRUE(camera.channel.expire(camera.now + seconds(4)));
  EXPECT_EQ(camera.write(address::kControlPrivilege, 2), GvcpStatus::Success);
}

TEST(ControlChannel, AnswersWithTheCommandsNumberPlusOneAndItsId) {
  Camera camera;
  const Bytes answer = camera.ask(GvcpCommand::ReadRegister, {address::kWidth, address::kHeight}).answer;
  EXPECT_EQ(answer, (Bytes{0, 0, 0, 0x81, 0, 8, 0, 77, 0, 0, 2, 0, 0, 0, 2, 0}));
}

TEST(ControlChannel, RefusesValuesOutOfBounds) {
  Camera camera;
  camera.write(address::kControlPrivilege, 2);
  EXPECT_EQ(camera.write(address::kWidth, 0), GvcpStatus::InvalidParameter);
  EXPECT_EQ(camera.write(address::kWidth, 2049), GvcpStatus::InvalidParameter);
  EXPECT_EQ(camera.write(address::kOffsetX, 1537), GvcpStatus::InvalidParameter);
  EXPECT_EQ(camera.write(address::kPixelFormat, 5), GvcpStatus::InvalidParameter);
  EXPECT_EQ(camera.write(address::kSensorWidth, 5), GvcpStatus::WriteProtected);
  EXPECT_EQ(camera.write(0xffffff00, 5), GvcpStatus::InvalidAddress);
}

TEST(ControlChannel, TellsWhatFollowsFromAWrite) {
  Camera camera;
  camera.write(address::kControlPrivilege, 2);
  EXPECT_EQ(camera.ask(GvcpCommand::WriteRegister, {address::kAcquisitionStart, 1}).effect, ControlEffect::Start);
  EXPECT_EQ(camera.ask(GvcpCommand::WriteRegister, {address::kTriggerSoftware, 1}).effect, ControlEffect::None);
  camera.write(address::kTriggerMode, 1);
  camera.write(address::kTriggerSource, 1);
  EXPECT_EQ(camera.ask(GvcpCommand::WriteRegister, {address::kTriggerSoftware, 1}).effect,
            ControlEffect::SoftwareTrigger);
  EXPECT_EQ(camera.ask(GvcpCommand::WriteRegister, {address::kStreamPacketSize, 0x80000000 | 1500}).effect,
            ControlEffect::FireTestPacket);
  EXPECT_EQ(camera.registers.word(address::kStreamPacketSize), 1500U);  // the order to fire is not kept
  EXPECT_EQ(camera.ask(GvcpCommand::WriteRegister, {address::kControlPrivilege, 0}).effect, ControlEffect::Stop);
}

TEST(ControlChannel, HoldsTheExposureWhileItIsAutomatic) {
  Camera camera;
  camera.write(address::kControlPrivilege, 2);
  camera.write(address::kExposureAuto, 2);
  const std::initializer_list<std::uint32_t> two_thousand{address::kExposureTime, 0x409f4000, 0};  // 2000.0
  EXPECT_EQ(camera.ask(GvcpCommand::WriteMemory, two_thousand).answer[1], 0x04);
  camera.write(address::kExposureAuto, 0);
  EXPECT_EQ(camera.ask(GvcpCommand::WriteMemory, two_thousand).answer[1], 0x00);
  EXPECT_EQ(camera.registers.acquisition().exposure, std::chrono::milliseconds(2));
}

TEST(ControlChannel, PassesOnWhichPacketsAreAskedForAgain) {
  Camera camera;
  camera.write(address::kControlPrivilege, 2);
  const Peer stream_port{kFirst.address, 3000};
  const auto resend = camera.ask(GvcpCommand::PacketResend, {0x00000123, 4, 9}, stream_port).resend;
  ASSERT_TRUE(resend);
  EXPECT_EQ(resend->frame_id, 0x123);
  EXPECT_EQ(resend->first, 4U);
  EXPECT_EQ(resend->last, 9U);
}

TEST(ControlChannel, IgnoresWhatIsNoCommand) {
  Camera camera;
  EXPECT_TRUE(camera.channel.reply(Bytes{0x42, 1, 0}, kFirst, camera.now).answer.empty());
  EXPECT_TRUE(camera.channel.reply(Bytes(64), kFirst, camera.now).answer.empty());
  EXPECT_EQ(camera.ask(static_cast<GvcpCommand>(0x1000), {}).answer[1], 0x01);  // not implemented
}

}  // namespace
}  // namespace alidade::test
