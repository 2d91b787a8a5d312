// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "capture/decoding.h"
#include "capture/v4l2/v4l2_formats.h"
#include "capture/v4l2/v4l2_listing.h"
#include "tests/faults/v4l2/vivid.h"

namespace alidade::test {
namespace {

/// Eight bars of full colours, the same in all formats.
class V4l2FormatsInTheMachine : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_vivid()) GTEST_SKIP() << "no vivid here";
    for (const char* camera : {kWebcam, kMultiplanar}) {
      set_control(camera, "test_pattern", "100% Colorbar");
      set_control(camera, "osd_text_mode", "None");
    }
  }
};

/// Places in the middle of the bars, away from their edges, where colour at half the resolution is the same.
std::vector<cv::Point> inside_bars(cv::Size size) {
  std::vector<cv::Point> points;
  for (int bar = 0; bar < 8; ++bar) {
    for (const int y : {20, 91, 160}) points.emplace_back((2 * bar + 1) * size.width / 16, y);
  }
  return points;
}

/// The largest difference of a channel.
double difference(const cv::Mat& a, const cv::Mat& b) {
  double worst = 0;
  for (const cv::Point& point : inside_bars(a.size())) {
    const cv::Rect pixel(point, cv::Size(1, 1));
    worst = std::max(worst, cv::norm(a(pixel), b(pixel), cv::NORM_INF));
  }
  return worst;
}

std::vector<std::string> offered(const std::string& path) {
  for (const ListedCamera& camera : list_v4l2()) {
    if (camera.source != "v4l2:" + path) continue;
    std::vector<std::string> names;
    for (const ListedFormat& format : camera.formats) {
      if (format.is_readable) names.push_back(format.name);
    }
    return names;
  }
  return {};
}

TEST_F(V4l2FormatsInTheMachine, ShowTheSamePicture) {
  const cv::Mat colours = image_in_format(kWebcam, "BGR3");
  const cv::Mat luma = image_in_format(kWebcam, "GREY");
  ASSERT_EQ(luma.type(), CV_8UC1);
  const std::vector<std::string> names = offered(kWebcam);
  EXPECT_GE(names.size(), 20U);
  RecordProperty("v4l2_formats_compared", static_cast<int>(names.size()));
  for (const std::string& name : names) {
    const V4l2Format& format = *find_v4l2_format(*parse_v4l2_format_name(name));
    const cv::Mat image = decode(image_in_format(kWebcam, name), format.pixels);
    ASSERT_EQ(image.size(), colours.size()) << name;
    if (image.channels() == 1) {
      EXPECT_EQ(difference(image, luma), 0) << name;
    } else {
      EXPECT_LE(difference(image, colours), 4) << name;  // rounding of YUV, 8 bits of which hold 220 values
    }
  }
}

TEST_F(V4l2FormatsInTheMachine, AreTheSameInPlanesOfTheirOwn) {
  const std::vector<std::string> names = offered(kMultiplanar);
  EXPECT_NE(std::find(names.begin(), names.end(), "NM12"), names.end());
  const cv::Mat one = image_in_format(kWebcam, "NV12");
  const cv::Mat two = image_in_format(kMultiplanar, "NM12");
  ASSERT_EQ(two.size(), one.size());
  EXPECT_EQ(cv::norm(two, one, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(image_in_format(kMultiplanar, "YUYV"), image_in_format(kWebcam, "YUYV"), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace alidade::test
