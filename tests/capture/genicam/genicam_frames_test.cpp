// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "capture/genicam/genicam_camera.h"
#include "capture/genicam/genicam_listing.h"
#include "capture/genicam/gvcp.h"
#include "tests/support/gige_camera/gige_camera.h"
#include "tests/support/gige_camera/test_pattern.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

constexpr const char* kAddress = "127.0.0.3";  // any address of the loopback will do

test::GigeCameraOptions small_camera() {
  test::GigeCameraOptions options;
  options.setup.address = kAddress;
  options.setup.size = {96, 6};
  options.setup.fps_hz = 100;
  return options;
}

// Whether a frame shows the very picture whose number it spells, to the last bit.
testing::AssertionResult shows_its_picture(const Frame& frame) {
  if (frame.stamp.is_damaged) return testing::AssertionFailure() << "damaged";
  const auto number = test::number_in_pattern(frame.image, frame.format);
  if (!number) return testing::AssertionFailure() << "no number";
  const cv::Mat sent = test::test_pattern(*number, frame.image.size(), frame.format);
  if (sent.type() != frame.image.type()) return testing::AssertionFailure() << "of another type";
  const double difference = cv::norm(sent, frame.image, cv::NORM_INF);
  return difference == 0 ? testing::AssertionSuccess() : testing::AssertionFailure() << "differs by " << difference;
}

TEST(GenicamFrames, AreWhatTheCameraSentInEveryFormat) {
  const test::GigeCamera source(small_camera(), test::open_pattern());
  for (const test::PayloadFormat& format : test::payload_formats()) {
    CameraRequest request;
    request.pixel_format = std::string(format.name);
    const auto camera = open_genicam(kAddress, request);
    const auto frame = camera->wait(2s);
    ASSERT_TRUE(frame) << format.name;
    EXPECT_EQ(frame->format, format.pixel) << format.name;
    EXPECT_TRUE(shows_its_picture(*frame)) << format.name;
  }
}

TEST(GenicamFrames, MayBeFewLinesAndOfAnyWidth) {
  const test::GigeCamera source(small_camera(), test::open_pattern());
  for (const cv::Size size : {cv::Size(2048, 1), cv::Size(64, 4), cv::Size(36, 3)}) {
    for (const char* const format : {"Mono8", "Mono12Packed", "Mono12p"}) {
      CameraRequest request;
      request.size = size;
      request.pixel_format = format;
      const auto frame = open_genicam(kAddress, request)->wait(2s);
      ASSERT_TRUE(frame);
      EXPECT_EQ(frame->image.size(), size);
      EXPECT_TRUE(shows_its_picture(*frame)) << format << ' ' << size;
    }
  }
}

TEST(GenicamFrames, AreCountedOnWhenTheIdsBeginAnew) {
  auto options = small_camera();
  options.first_frame_id = 65530;
  const test::GigeCamera source(options, test::open_pattern());
  const auto camera = open_genicam(kAddress, {});
  for (std::uint64_t expected = 65530; expected < 65530 + 12; ++expected) {
    const auto frame = camera->wait(2s);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->stamp.sequence, expected);
  }
}

TEST(GenicamFrames, AreCompleteThoughTheNetworkLosesPackets) {
  auto options = small_camera();
  options.setup.size = {512, 512};
  options.sender.loss = 0.02;
  const test::GigeCamera source(options, test::open_pattern());
  CameraRequest request;
  request.packet_size = 1400;  // 193 packets, of which three or four are lost: hardly a frame would come whole
  const auto camera = open_genicam(kAddress, request);
  for (int i = 0; i < 100; ++i) {
    const auto frame = camera->wait(2s);
    ASSERT_TRUE(frame);
    EXPECT_TRUE(shows_its_picture(*frame)) << i;
  }
  const auto statistics = camera->statistics();
  EXPECT_EQ(statistics[3].first, "resent packets");
  EXPECT_GT(statistics[3].second, 200u);
  EXPECT_GT(source.counts().lost, 200u);
}

TEST(GenicamFrames, ComeInTheLargestPacketsThatComeThrough) {
  auto options = small_camera();
  options.setup.size = {512, 512};
  const test::GigeCamera source(options, test::open_pattern());
  const auto camera = open_genicam(kAddress, {});
  const auto sent_before = source.counts().sent;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(camera->wait(2s));
  EXPECT_LE(source.counts().sent - sent_before, 12u * 7);  // 262,144 bytes in packets of nearly 65,500, and two more
}

TEST(GenicamFrames, BearTheTimeOfTheCamera) {
  auto options = small_camera();
  options.clock.offset = 1h;
  const test::GigeCamera source(options, test::open_pattern());
  const auto camera = open_genicam(kAddress, {});
  const auto frame = camera->wait(2s);
  ASSERT_TRUE(frame);
  const auto ahead = frame->stamp.device_time->time_since_epoch() - frame->stamp.host_time->time_since_epoch();
  EXPECT_NEAR(std::chrono::duration<double>(ahead).count(), 3600, 0.1);
}

TEST(GenicamFrames, OfTwoCamerasTriggeredBySoftwareAreExposedTogether) {
  auto first_options = small_camera(), second_options = small_camera();
  second_options.setup.address = "127.0.0.4";
  const test::GigeCamera first_source(first_options, test::open_pattern());
  const test::GigeCamera second_source(second_options, test::open_pattern());
  CameraRequest request;
  request.trigger = CameraTrigger::Software;
  request.fps_hz = 20;
  const auto first = open_genicam("127.0.0.3", request), second = open_genicam("127.0.0.4", request);
  first->wait(2s);
  second->wait(2s);
  int together = 0;
  for (int i = 0; i < 15; ++i) {
    const auto one = first->wait(2s), other = second->wait(2s);
    ASSERT_TRUE(one && other);
    const auto apart = (*one->stamp.device_time - *other->stamp.device_time) % 50ms;
    together += std::chrono::abs(apart) < 5ms || std::chrono::abs(apart) > 45ms ? 1 : 0;
  }
  EXPECT_GE(together, 10);  // a fifth would be by chance; a busy machine is late now and then
}

TEST(GenicamFrames, AreOfFormatsThatTheListingCallsReadable) {
  const test::GigeCamera source(small_camera(), test::open_pattern());
  const ListedCamera listed = describe_genicam(kAddress);
  EXPECT_EQ(listed.formats.size(), test::payload_formats().size());
  for (const ListedFormat& format : listed.formats) EXPECT_TRUE(format.is_readable) << format.name;
}

}  // namespace
}  // namespace alidade
