// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/marker_dictionary.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/aruco.hpp>

namespace alidade {
namespace {

// In the order of cv::aruco::PREDEFINED_DICTIONARY_NAME.
constexpr std::array<std::string_view, cv::aruco::DICT_APRILTAG_36h11 + 1> kNames{
    "4X4_50",   "4X4_100",  "4X4_250",        "4X4_1000",      "5X5_50",        "5X5_100",        "5X5_250",
    "5X5_1000", "6X6_50",   "6X6_100",        "6X6_250",       "6X6_1000",      "7X7_50",         "7X7_100",
    "7X7_250",  "7X7_1000", "ARUCO_ORIGINAL", "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h10", "APRILTAG_36h11"};

cv::Ptr<cv::aruco::Dictionary> dictionary_of(std::string_view name) {
  return cv::aruco::getPredefinedDictionary(marker_dictionary_number(name));
}

}  // namespace

std::span<const std::string_view> marker_dictionary_names() {
  return kNames;
}

int marker_dictionary_number(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) throw std::invalid_argument(fmt::format("no dictionary of markers is named '{}'", name));
  return static_cast<int>(found - kNames.begin());
}

int marker_dictionary_size(std::string_view name) {
  return dictionary_of(name)->bytesList.rows;
}

cv::Mat marker_cells(std::string_view name, int id) {
  const auto dictionary = dictionary_of(name);
  if (id < 0 || id >= dictionary->bytesList.rows) {
    throw std::invalid_argument(
        fmt::format("{} has markers 0 to {}, not {}", name, dictionary->bytesList.rows - 1, id));
  }
  const int size = dictionary->markerSize;
  cv::Mat cells = cv::Mat::zeros(size + 2, size + 2, CV_8UC1);
  const cv::Mat bits = cv::aruco::Dictionary::getBitsFromByteList(dictionary->bytesList.rowRange(id, id + 1), size);
  cv::Mat(255 * bits).copyTo(cells(cv::Rect(1, 1, size, size)));
  return cells;
}

}  // namespace alidade
