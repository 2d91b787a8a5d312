// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "view/colour.h"

namespace alidade {

enum class SeriesStyle { Line, Dashed, Dots };

/// One curve. A pair with a value that is not finite (or not positive on a logarithmic axis) is a gap in it.
struct Series {
  std::string name;  ///< shown in the legend; empty: not shown
  std::vector<double> x, y;
  SeriesStyle style = SeriesStyle::Line;
  std::optional<Rgb> colour;  ///< empty: curve_colour of its place in the plot
};

/// Curves over one pair of axes. Labels carry their units: "time (s)".
struct Plot {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  bool equal_axes = false;  ///< one unit has the same length on both axes
  bool log_y = false;
  bool whole_x = false;  ///< x counts or numbers things: no ticks between them
};

/// Draws a plot as a BGR picture (CV_8UC3) of `size` px, at least 160×120; without any finite value, the empty axes.
/// Needs no display. Throws std::invalid_argument where a series' x and y differ in length or `size` is smaller.
cv::Mat draw_plot(const Plot& plot, cv::Size size = {960, 400});

/// Plots below each other, each `size_each`; empty for no plot.
cv::Mat draw_plots(std::span<const Plot> plots, cv::Size size_each = {960, 320});

}  // namespace alidade
