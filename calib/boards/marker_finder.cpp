// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/marker_finder.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/boards/marker_dictionary.h"

namespace alidade {
namespace {

// One way to look at the image.
struct Pass {
  int scale;
  double threshold;  // how much darker than its surroundings black is, in shares of the image's contrast
};
// A low threshold sees markers in the shade; small ones want the larger image.
constexpr std::array<Pass, 4> kApart{{{1, 0.03}, {1, 0.12}, {2, 0.03}, {2, 0.12}}};
// A high threshold parts what touches by its corners, whose outline would have its corners anywhere.
constexpr std::array<Pass, 4> kTouching{{{2, 0.25}, {2, 0.12}, {1, 0.25}, {1, 0.12}}};
constexpr int kMostPixelsEnlarged = 3'000'000;

// From the darkest to the brightest twentieth of the pixels, grey levels.
double contrast_of(const cv::Mat& grey) {
  cv::Mat histogram;
  cv::calcHist(std::vector<cv::Mat>{grey}, {0}, {}, histogram, {256}, {0, 256});
  const double tail = 0.05 * static_cast<double>(grey.total());
  int dark = 0, bright = 255;
  for (double sum = histogram.at<float>(0); sum < tail && dark < 255;) sum += histogram.at<float>(++dark);
  for (double sum = histogram.at<float>(255); sum < tail && bright > 0;) sum += histogram.at<float>(--bright);
  return std::max(bright - dark, 1);
}

// Places in an image enlarged about its corner, in the original: pixel centres keep their meaning.
Eigen::Vector2d shrunk(const cv::Point2f& pixel, int scale) {
  return {(pixel.x + 0.5) / scale - 0.5, (pixel.y + 0.5) / scale - 0.5};
}

std::vector<FoundMarker> run(const cv::Mat& grey, const MarkerSearch& search, const Pass& pass, double contrast) {
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->markerBorderBits = search.border_cells;
  parameters->adaptiveThreshConstant = std::max(3.0, pass.threshold * contrast);
  cv::Mat enlarged = grey;
  if (pass.scale > 1) cv::resize(grey, enlarged, {}, pass.scale, pass.scale, cv::INTER_CUBIC);
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  const auto dictionary = cv::aruco::getPredefinedDictionary(marker_dictionary_number(search.dictionary));
  cv::aruco::detectMarkers(enlarged, dictionary, corners, ids, parameters);
  std::vector<FoundMarker> found;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    FoundMarker marker{ids[i], {}};
    for (std::size_t c = 0; c < 4; ++c) marker.corners[c] = shrunk(corners[i][c], pass.scale);
    found.push_back(marker);
  }
  return found;
}

}  // namespace

std::vector<FoundMarker> find_markers(const cv::Mat& grey, const MarkerSearch& search) {
  if (grey.type() != CV_8UC1) throw std::invalid_argument("find_markers: the image must be grey, of 8 bits");
  const double contrast = contrast_of(grey);
  std::map<int, FoundMarker> by_id;
  for (const Pass& pass : search.are_touching ? kTouching : kApart) {
    if (pass.scale > 1 && grey.total() > kMostPixelsEnlarged) continue;
    for (const FoundMarker& marker : run(grey, search, pass, contrast)) by_id.emplace(marker.id, marker);
    if (search.enough > 0 && static_cast<int>(by_id.size()) >= search.enough) break;
  }
  std::vector<FoundMarker> found;
  for (const auto& [id, marker] : by_id) found.push_back(marker);
  return found;
}

}  // namespace alidade
