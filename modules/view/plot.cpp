// SPDX-License-Identifier: Apache-2.0
#include "view/plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "view/axis_ticks.h"
#include "view/canvas.h"

namespace alidade {
namespace {

constexpr Rgb kGrid{226, 228, 232};
constexpr TextFont kTitleFont{15, true};
constexpr TextFont kLabelFont{13, false};
constexpr TextFont kTickFont{12, false};

struct Range {
  double low = 0, high = 1;
};

// Where the data lie in the picture.
struct Frame {
  cv::Rect area;  // px
  Range x, y;     // y: of log10 on a logarithmic axis
  bool log_y = false, whole_x = false;

  cv::Point2d at(double vx, double vy) const {
    const double v = log_y ? std::log10(vy) : vy;
    return {area.x + (vx - x.low) / (x.high - x.low) * area.width,
            area.y + area.height - (v - y.low) / (y.high - y.low) * area.height};
  }
};

bool is_drawable(const Plot& plot, double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (!plot.log_y || y > 0);
}

Range widened(Range r, double fraction) {
  if (!(r.high > r.low)) {
    const double margin = r.low == 0 ? 1.0 : std::abs(r.low) * 0.05;
    return {r.low - margin, r.high + margin};
  }
  const double margin = (r.high - r.low) * fraction;
  return {r.low - margin, r.high + margin};
}

void set_ranges(Frame& frame, const Plot& plot) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Range x{kInfinity, -kInfinity}, y{kInfinity, -kInfinity};
  for (const auto& s : plot.series) {
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!is_drawable(plot, s.x[i], s.y[i])) continue;
      const double v = plot.log_y ? std::log10(s.y[i]) : s.y[i];
      x = {std::min(x.low, s.x[i]), std::max(x.high, s.x[i])};
      y = {std::min(y.low, v), std::max(y.high, v)};
    }
  }
  if (x.low > x.high) x = y = {0, 1};
  frame.log_y = plot.log_y;
  frame.whole_x = plot.whole_x;
  frame.x = plot.whole_x ? Range{x.low - 0.5, x.high + 0.5} : widened(x, plot.equal_axes ? 0.05 : 0.01);
  frame.y = widened(y, 0.06);
  // An error that is never negative keeps its zero line.
  if (!plot.log_y && !plot.equal_axes && y.low >= 0 && y.low < 0.4 * y.high) frame.y.low = 0;
}

void equalise(Frame& frame) {
  const double x_unit = (frame.x.high - frame.x.low) / frame.area.width;
  const double y_unit = (frame.y.high - frame.y.low) / frame.area.height;
  Range& tight = x_unit < y_unit ? frame.x : frame.y;
  tight = widened(tight, 0.5 * (std::max(x_unit, y_unit) / std::min(x_unit, y_unit) - 1.0));
}

std::vector<Tick> x_ticks(const Frame& frame) {
  auto ticks = linear_ticks(frame.x.low, frame.x.high, std::clamp(frame.area.width / 95, 2, 12));
  if (!frame.whole_x) return ticks;
  std::erase_if(ticks, [](const Tick& tick) { return tick.value != std::round(tick.value); });
  for (Tick& tick : ticks) tick.text = fmt::format("{:.0f}", tick.value);
  return ticks;
}

std::vector<Tick> y_ticks(const Frame& frame) {
  const int wanted = std::clamp(frame.area.height / 48, 2, 10);
  if (!frame.log_y) return linear_ticks(frame.y.low, frame.y.high, wanted);
  return logarithmic_ticks(std::pow(10.0, frame.y.low), std::pow(10.0, frame.y.high), wanted);
}

bool has_legend(const Plot& plot) {
  return std::ranges::any_of(plot.series, [](const Series& s) { return !s.name.empty(); });
}

Frame lay_out(const Plot& plot, cv::Size size) {
  Frame frame;
  const int top = 14 + (plot.title.empty() ? 0 : 26) + (has_legend(plot) ? 22 : 0);
  const int bottom = 28 + (plot.x_label.empty() ? 6 : 24);
  frame.area = {70, top, size.width - 90, size.height - top - bottom};
  set_ranges(frame, plot);
  int widest = 0;
  for (const auto& tick : y_ticks(frame)) widest = std::max(widest, text_size(tick.text, kTickFont).width);
  const int left = 16 + widest + (plot.y_label.empty() ? 0 : 24);
  frame.area.width += frame.area.x - left;
  frame.area.x = left;
  if (plot.equal_axes) equalise(frame);
  return frame;
}

void draw_axes(Canvas& canvas, const Plot& plot, const Frame& frame) {
  const auto& area = frame.area;
  const double right = area.x + area.width, bottom = area.y + area.height;
  for (const auto& tick : x_ticks(frame)) {
    const double x = area.x + (tick.value - frame.x.low) / (frame.x.high - frame.x.low) * area.width;
    canvas.draw_line({x, double(area.y)}, {x, bottom}, {kGrid, 1.0});
    canvas.write(tick.text, {x, bottom + 13}, {kTickFont, palette::kInk, Anchor::Centre});
  }
  for (const auto& tick : y_ticks(frame)) {
    const double y = frame.at(frame.x.low, tick.value).y;
    canvas.draw_line({double(area.x), y}, {right, y}, {kGrid, 1.0});
    canvas.write(tick.text, {area.x - 7.0, y}, {kTickFont, palette::kInk, Anchor::Right});
  }
  canvas.draw_line({double(area.x), bottom}, {right, bottom}, {palette::kInk, 1.0});
  canvas.draw_line({double(area.x), double(area.y)}, {double(area.x), bottom}, {palette::kInk, 1.0});
  canvas.write(plot.x_label, {area.x + area.width / 2.0, bottom + 36}, {kLabelFont, palette::kInk, Anchor::Centre});
  canvas.write(plot.y_label, {13, area.y + area.height / 2.0}, {kLabelFont, palette::kInk, Anchor::Centre, true});
  canvas.write(plot.title, {double(area.x), 21}, {kTitleFont, palette::kInk});
}

void draw_series(Canvas& canvas, const Plot& plot, const Frame& frame, const Series& s, const Rgb& colour) {
  std::vector<cv::Point2d> run;
  const auto flush = [&] {
    if (run.size() == 1) canvas.draw_disc(run.front(), 1.5, colour);
    canvas.draw_polyline(run, {colour, 2.0, s.style == SeriesStyle::Dashed});
    run.clear();
  };
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (!is_drawable(plot, s.x[i], s.y[i])) {
      flush();
    } else if (s.style == SeriesStyle::Dots) {
      canvas.draw_disc(frame.at(s.x[i], s.y[i]), 2.2, colour);
    } else {
      run.push_back(frame.at(s.x[i], s.y[i]));
    }
  }
  flush();
}

Rgb colour_of(const Plot& plot, std::size_t i) {
  return plot.series[i].colour.value_or(curve_colour(i));
}

void draw_legend(Canvas& canvas, const Plot& plot, const Frame& frame) {
  double x = frame.area.x;
  const double y = frame.area.y - 14;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const auto& s = plot.series[i];
    if (s.name.empty()) continue;
    if (s.style == SeriesStyle::Dots) {
      canvas.draw_disc({x + 11, y}, 3, colour_of(plot, i));
    } else {
      canvas.draw_line({x, y}, {x + 22, y}, {colour_of(plot, i), 2.5, s.style == SeriesStyle::Dashed});
    }
    canvas.write(s.name, {x + 28, y}, {kTickFont, palette::kInk});
    x += 28 + text_size(s.name, kTickFont).width + 22;
  }
}

}  // namespace

cv::Mat draw_plot(const Plot& plot, cv::Size size) {
  if (size.width < 160 || size.height < 120) {
    throw std::invalid_argument(fmt::format("draw_plot: size must be >= 160x120, got {}x{}", size.width, size.height));
  }
  for (const auto& s : plot.series) {
    if (s.x.size() == s.y.size()) continue;
    throw std::invalid_argument(fmt::format("draw_plot: series '{}': {} x, {} y", s.name, s.x.size(), s.y.size()));
  }
  Canvas canvas(size, palette::kPaper);
  const Frame frame = lay_out(plot, size);
  draw_axes(canvas, plot, frame);
  draw_legend(canvas, plot, frame);
  canvas.restrict_to({frame.area.x - 2, frame.area.y - 2, frame.area.width + 4, frame.area.height + 4});
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    draw_series(canvas, plot, frame, plot.series[i], colour_of(plot, i));
  }
  return canvas.picture();
}

cv::Mat draw_plots(std::span<const Plot> plots, cv::Size size_each) {
  cv::Mat column;
  for (const auto& plot : plots) column.push_back(draw_plot(plot, size_each));
  return column;
}

}  // namespace alidade
