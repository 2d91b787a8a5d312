// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/gige_camera.h"

#include <gtest/gtest.h>

#include "tests/support/gige_camera/camera_process.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade::test {
namespace {

using std::chrono::milliseconds;

// A client without any library: it writes registers, and takes packets as they are.
class Client {
 public:
  explicit Client(const std::string& address) : commands_(address, 0), stream_(address, 0) {
    camera_ = {commands_.own().address, kGvcpPort};
    write(address::kControlPrivilege, 2);
    write(address::kStreamDestination, stream_.own().address);
    write(address::kStreamPort, stream_.own().port);
  }

  void write(std::uint32_t to, std::uint32_t value) {
    Bytes datagram{0x42, 0x01, 0x00, 0x82, 0x00, 0x08, 0x00, 0x01};
    append_big_endian(datagram, to);
    append_big_endian(datagram, value);
    commands_.send(datagram, camera_);
    const auto answer = commands_.receive(milliseconds(1000));
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->first[0], 0) << "refused";
  }

  // Ids of the frames whose trailers came until none came for 200 ms, or there are `most`.
  std::vector<int> frame_ids(std::size_t most) {
    std::vector<int> ids;
    while (ids.size() < most) {
      const auto packet = stream_.receive(milliseconds(200));
      if (!packet) break;
      const bool is_trailer = packet->first[4] == static_cast<std::uint8_t>(GvspContent::Trailer);
      if (is_trailer) ids.push_back(read_big_endian<std::uint16_t>(std::span(packet->first).subspan(2)));
    }
    return ids;
  }

 private:
  UdpSocket commands_;
  UdpSocket stream_;
  Peer camera_;
};

GigeCameraOptions options_at(const std::string& address) {
  GigeCameraOptions options;
  options.setup.address = address;
  options.setup.size = {64, 48};
  options.setup.fps_hz = 100;
  return options;
}

TEST(GigeCamera, CountsFramesFromOneWithEachStartAndWrapsPastZero) {
  GigeCameraOptions options = options_at(loopback_address(1));
  options.first_frame_id = 65534;
  const GigeCamera camera(options, open_pattern());
  Client client(options.setup.address);
  for (int start = 0; start < 2; ++start) {
    client.write(address::kAcquisitionStart, 1);
    EXPECT_EQ(client.frame_ids(4), (std::vector{65534, 65535, 1, 2}));
    client.write(address::kAcquisitionStop, 1);
    client.frame_ids(1000);
  }
}

TEST(GigeCamera, ExposesOncePerPulseInHardwareTriggerMode) {
  const GigeCameraOptions options = options_at(loopback_address(1));
  GigeCamera camera(options, open_pattern());
  Client client(options.setup.address);
  client.write(address::kTriggerMode, 1);
  client.write(address::kAcquisitionStart, 1);
  EXPECT_TRUE(client.frame_ids(1).empty());
  camera.pulse();
  camera.pulse();
  EXPECT_EQ(client.frame_ids(10), (std::vector{1, 2}));
}

TEST(GigeCamera, LogsTheFramesThatItDropped) {
  const TemporaryDirectory directory;
  GigeCameraOptions options = options_at(loopback_address(1));
  options.log = directory.path() / "log.csv";
  options.clock.offset = std::chrono::seconds(7);
  options.setup.fps_hz = 20;
  GigeCamera camera(options, open_pattern());
  Client client(options.setup.address);
  camera.drop_frames(2);
  client.write(address::kAcquisitionStart, 1);
  EXPECT_EQ(client.frame_ids(2), (std::vector{3, 4}));
  const std::vector<LoggedFrame> log = read_camera_log(*options.log);
  ASSERT_GE(log.size(), 4U);
  EXPECT_TRUE(log[1].is_dropped);
  EXPECT_FALSE(log[2].is_dropped);
  const auto host_ns = static_cast<std::uint64_t>(log[2].host_time.time_since_epoch().count());
  EXPECT_EQ(log[2].device_time, host_ns + 7'000'000'000U);
  EXPECT_EQ(log[3].host_time - log[2].host_time, milliseconds(50));
}

TEST(GigeCamera, IsSilentWhileStalledAndThenGoesOn) {
  const GigeCameraOptions options = options_at(loopback_address(1));
  GigeCamera camera(options, open_pattern());
  Client client(options.setup.address);
  client.write(address::kAcquisitionStart, 1);
  client.frame_ids(3);
  camera.stall(milliseconds(300));  // silence is told after 200 ms, and the rest waited for
  EXPECT_LT(client.frame_ids(20).size(), 20U);
  EXPECT_EQ(client.frame_ids(2).size(), 2U);
}

TEST(GigeCamera, TellsOfAnAddressInUse) {
  const GigeCameraOptions options = options_at(loopback_address(1));
  const GigeCamera camera(options, open_pattern());
  EXPECT_EQ(message_of("", [&] { const GigeCamera second(options, open_pattern()); }),
            options.setup.address +
                ":3956: bind: Address already in use; end the camera that runs there, or give "
                "another --address, such as 127.0.0.2");
}

TEST(CameraProcess, IsGoneAtOnceWhenKilledAndCountsWhenEnded) {
  const std::string address = loopback_address(2);
  CameraProcess killed(ALIDADE_GIGE_TEST_CAMERA, {"--address", address});
  killed.kill();
  CameraProcess ended(ALIDADE_GIGE_TEST_CAMERA, {"--address", address});
  EXPECT_EQ(ended.end(), R"({"packets":0,"lost":0,"resent":0,"unavailable":0})");
}

TEST(CameraProcess, ThrowsWhereTheCameraDoesNotStart) {
  EXPECT_THROW(CameraProcess(ALIDADE_GIGE_TEST_CAMERA, {"--size", "0x0"}), DeviceError);
}

}  // namespace
}  // namespace alidade::test
