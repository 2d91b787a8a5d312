// SPDX-License-Identifier: Apache-2.0
#include "features/marker.h"

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

struct Drawing {
  cv::Mat grey;
  std::array<Eigen::Vector2d, 4> corners;  // px, clockwise from the marker's own top left
};

// A marker turned, sheared and a little tilted, drawn at eight times the size and averaged down.
Drawing draw(cv::aruco::PREDEFINED_DICTIONARY_NAME dictionary, int id) {
  constexpr int kSide = 320, kFactor = 8;
  cv::Mat marker;
  cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(dictionary), id, kSide, marker);
  const std::array<cv::Point2f, 4> corners{{{121.3f, 62.8f}, {231.6f, 84.1f}, {214.2f, 189.7f}, {98.5f, 171.4f}}};
  // Corners are edges of the marker's pixels: half a pixel outside their centres, on either side of the map.
  const std::array<cv::Point2f, 4> from{
      {{-0.5f, -0.5f}, {kSide - 0.5f, -0.5f}, {kSide - 0.5f, kSide - 0.5f}, {-0.5f, kSide - 0.5f}}};
  std::array<cv::Point2f, 4> to;
  Drawing drawing;
  for (std::size_t c = 0; c < 4; ++c) {
    to[c] = (corners[c] + cv::Point2f(0.5f, 0.5f)) * kFactor - cv::Point2f(0.5f, 0.5f);
    drawing.corners[c] = {corners[c].x, corners[c].y};
  }
  cv::Mat large;
  cv::warpPerspective(marker, large, cv::getPerspectiveTransform(from.data(), to.data()),
                      cv::Size(320 * kFactor, 240 * kFactor), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(230));
  cv::resize(large, drawing.grey, cv::Size(320, 240), 0, 0, cv::INTER_AREA);
  return drawing;
}

void expect_found(const std::vector<MarkerSighting>& found, int id, const Drawing& drawing) {
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, id);
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_LT((found[0].corners[c] - drawing.corners[c]).norm(), 0.15)
        << "corner " << c << ": " << found[0].corners[c].transpose();
  }
}

TEST(DetectMarkers, FindsAnAprilTagToAFractionOfAPixel) {
  const Drawing drawing = draw(cv::aruco::DICT_APRILTAG_36h11, 7);
  expect_found(detect_markers(drawing.grey, MarkerFamily::AprilTag36h11), 7, drawing);
}

TEST(DetectMarkers, FindsArucoMarkersToAFractionOfAPixel) {
  const Drawing small = draw(cv::aruco::DICT_4X4_50, 12);
  expect_found(detect_markers(small.grey, MarkerFamily::Aruco4x4), 12, small);
  const Drawing middle = draw(cv::aruco::DICT_5X5_250, 40);
  expect_found(detect_markers(middle.grey, MarkerFamily::Aruco5x5), 40, middle);
  const Drawing large = draw(cv::aruco::DICT_6X6_250, 199);
  expect_found(detect_markers(large.grey, MarkerFamily::Aruco6x6), 199, large);
}

TEST(DetectMarkers, TriesEveryFamily) {
  const Drawing tag = draw(cv::aruco::DICT_APRILTAG_36h11, 3);
  expect_found(detect_markers(tag.grey), 3, tag);
  const Drawing aruco = draw(cv::aruco::DICT_6X6_250, 101);
  expect_found(detect_markers(aruco.grey), 101, aruco);
}

TEST(DetectMarkers, FindsNoneInAnEmptyScene) {
  EXPECT_TRUE(detect_markers(cv::Mat(240, 320, CV_8UC1, cv::Scalar(230))).empty());
}

}  // namespace
}  // namespace alidade
