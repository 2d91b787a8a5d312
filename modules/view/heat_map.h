// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "view/colour.h"

namespace alidade {

/// From blue (0, little) over yellow to red (1, much).
Rgb heat_colour(double share);

/// A place with a name on a map.
struct MapMark {
  double x = 0, y = 0;
  std::string name;
};

/// A value over a grid of places.
struct HeatMap {
  std::string title, x_label, y_label;
  int columns = 0, rows = 0;
  double x0 = 0, y0 = 0, step = 1;  ///< the first cell's centre; cells are square. y grows upwards
  std::vector<double> values;       ///< row by row, positive; what is not finite is left blank
  std::vector<MapMark> marks;
};

/// The maps beside each other, of one scale of colours, which is logarithmic between the least and the 98th percentile
/// of all values; the value is written into some of the cells. CV_8UC3 (BGR); empty for no map. Needs no display.
/// Throws std::invalid_argument where a map has not as many values as cells, and for a step that is not positive.
cv::Mat draw_heat_maps(std::span<const HeatMap> maps, cv::Size size_each = {560, 520});

}  // namespace alidade
