// SPDX-License-Identifier: Apache-2.0
#include "features/marker.h"

#include <opencv2/aruco.hpp>

namespace alidade {
namespace {

cv::aruco::PREDEFINED_DICTIONARY_NAME dictionary_of(MarkerFamily family) {
  switch (family) {
    case MarkerFamily::AprilTag36h11:
      return cv::aruco::DICT_APRILTAG_36h11;
    case MarkerFamily::Aruco4x4:
      return cv::aruco::DICT_4X4_50;
    case MarkerFamily::Aruco5x5:
      return cv::aruco::DICT_5X5_250;
    case MarkerFamily::Aruco6x6:
      break;
  }
  return cv::aruco::DICT_6X6_250;
}

// The line fits of cv::aruco's AprilTag refinement count pixels from the corner of the first one, not from its centre
// (measured in tests/features/marker_test.cpp); its other refinements are drawn inwards by blur.
constexpr double kAprilTagOffset = 0.5;

}  // namespace

std::vector<MarkerSighting> detect_markers(const cv::Mat& grey, MarkerFamily family) {
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_APRILTAG;
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(grey, cv::aruco::getPredefinedDictionary(dictionary_of(family)), corners, ids, parameters);
  std::vector<MarkerSighting> sightings;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    MarkerSighting sighting{ids[i], {}};
    for (std::size_t c = 0; c < 4; ++c) {
      sighting.corners[c] = {corners[i][c].x - kAprilTagOffset, corners[i][c].y - kAprilTagOffset};
    }
    sightings.push_back(sighting);
  }
  return sightings;
}

std::vector<MarkerSighting> detect_markers(const cv::Mat& grey) {
  for (const MarkerFamily family :
       {MarkerFamily::AprilTag36h11, MarkerFamily::Aruco4x4, MarkerFamily::Aruco5x5, MarkerFamily::Aruco6x6}) {
    auto sightings = detect_markers(grey, family);
    if (!sightings.empty()) return sightings;
  }
  return {};
}

}  // namespace alidade
