// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace alidade {

/// The names of OpenCV's dictionaries of square markers, without "DICT_": "4X4_50", "APRILTAG_36h11", ...
std::span<const std::string_view> marker_dictionary_names();

/// OpenCV's number of a dictionary (cv::aruco::PREDEFINED_DICTIONARY_NAME). Throws std::invalid_argument for a name
/// that is not in marker_dictionary_names().
int marker_dictionary_number(std::string_view name);

/// How many markers a dictionary has; their ids are 0 to this number - 1. Throws as marker_dictionary_number.
int marker_dictionary_size(std::string_view name);

/// The cells of a marker with its black border of one cell: CV_8UC1, n×n, 255 where white. Throws
/// std::invalid_argument for an unknown dictionary or id.
cv::Mat marker_cells(std::string_view dictionary, int id);

}  // namespace alidade
