// SPDX-License-Identifier: Apache-2.0
#include "view/heat_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "view/axis_ticks.h"
#include "view/canvas.h"

namespace alidade {
namespace {

constexpr double kLeft = 70, kTop = 40, kRight = 16, kBottom = 52;  // px around the cells

// Of the colours, in logarithms.
struct Scale {
  double low = 0.0, span = 1.0;
  double share(double value) const { return (std::log(value) - low) / span; }
};

Scale scale_of(std::span<const HeatMap> maps) {
  std::vector<double> logs;
  for (const HeatMap& map : maps) {
    for (const double value : map.values) {
      if (std::isfinite(value) && value > 0.0) logs.push_back(std::log(value));
    }
  }
  if (logs.empty()) return {};
  std::sort(logs.begin(), logs.end());
  const double high = logs[static_cast<std::size_t>(0.98 * static_cast<double>(logs.size() - 1))];
  return {logs.front(), std::max(0.1, high - logs.front())};
}

// A map's places on the canvas.
struct Frame {
  double x_low, y_high, px_per_unit, left;

  Frame(const HeatMap& map, cv::Size size, double x_offset) : left(x_offset + kLeft) {
    px_per_unit = std::min((size.width - kLeft - kRight) / (map.columns * map.step),
                           (size.height - kTop - kBottom) / (map.rows * map.step));
    x_low = map.x0 - 0.5 * map.step;
    y_high = map.y0 + (map.rows - 0.5) * map.step;
  }

  cv::Point2d at(double x, double y) const {
    return {left + (x - x_low) * px_per_unit, kTop + (y_high - y) * px_per_unit};
  }
};

void draw_cells(const HeatMap& map, const Frame& frame, const Scale& scale, Canvas& canvas) {
  const int every = std::max(1, map.columns / 7);
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const double value = map.values[static_cast<std::size_t>(row * map.columns + column)];
      if (!std::isfinite(value)) continue;
      const double x = map.x0 + column * map.step, y = map.y0 + row * map.step, half = 0.5 * map.step;
      const cv::Point2d a = frame.at(x - half, y + half), c = frame.at(x + half, y - half);
      const std::vector<cv::Point2d> cell{a, {c.x, a.y}, c, {a.x, c.y}};
      canvas.fill_polygon(cell, heat_colour(scale.share(value)));
    }
  }
  for (int row = every / 2; row < map.rows; row += every) {
    for (int column = every / 2; column < map.columns; column += every) {
      const double value = map.values[static_cast<std::size_t>(row * map.columns + column)];
      if (!std::isfinite(value)) continue;
      canvas.write(fmt::format("{:.2g}", value), frame.at(map.x0 + column * map.step, map.y0 + row * map.step),
                   {{12}, palette::kInk, Anchor::Centre});
    }
  }
}

void draw_axes(const HeatMap& map, const Frame& frame, Canvas& canvas) {
  const double x_high = frame.x_low + map.columns * map.step, y_low = frame.y_high - map.rows * map.step;
  for (const Tick& tick : linear_ticks(frame.x_low, x_high, 5)) {
    canvas.write(tick.text, frame.at(tick.value, y_low) + cv::Point2d(0, 14), {{12}, palette::kInk, Anchor::Centre});
  }
  for (const Tick& tick : linear_ticks(y_low, frame.y_high, 5)) {
    canvas.write(tick.text, frame.at(frame.x_low, tick.value) - cv::Point2d(8, 0),
                 {{12}, palette::kInk, Anchor::Right});
  }
  const cv::Point2d below = frame.at(0.5 * (frame.x_low + x_high), y_low);
  canvas.write(map.x_label, below + cv::Point2d(0, 36), {{13}, palette::kInk, Anchor::Centre});
  const cv::Point2d beside = frame.at(frame.x_low, 0.5 * (y_low + frame.y_high));
  canvas.write(map.y_label, beside - cv::Point2d(52, 0), {{13}, palette::kInk, Anchor::Centre, true});
  canvas.write(map.title, {frame.left, 0.5 * kTop}, {{15, true}, palette::kInk, Anchor::Left});
}

void draw_marks(const HeatMap& map, const Frame& frame, Canvas& canvas) {
  const double x_high = frame.x_low + map.columns * map.step, y_low = frame.y_high - map.rows * map.step;
  for (const MapMark& mark : map.marks) {
    if (mark.x < frame.x_low || mark.x > x_high || mark.y < y_low || mark.y > frame.y_high) continue;
    const cv::Point2d place = frame.at(mark.x, mark.y);
    canvas.draw_disc(place, 5.0, palette::kInk);
    canvas.write(mark.name, place + cv::Point2d(9, 0), {{12, true}, palette::kInk, Anchor::Left});
  }
}

void check(const HeatMap& map) {
  const bool fits = map.columns > 0 && map.rows > 0 &&
                    map.values.size() == static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows);
  if (!fits || !(map.step > 0.0)) throw std::invalid_argument("draw_heat_maps: values and cells of a map do not fit");
}

}  // namespace

Rgb heat_colour(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  const auto mix = [](double a, double b, double t) { return static_cast<std::uint8_t>(std::lround(a + (b - a) * t)); };
  if (s < 0.5) return {mix(60, 250, 2 * s), mix(110, 230, 2 * s), mix(190, 140, 2 * s)};
  return {mix(250, 200, 2 * s - 1), mix(230, 50, 2 * s - 1), mix(140, 40, 2 * s - 1)};
}

cv::Mat draw_heat_maps(std::span<const HeatMap> maps, cv::Size size_each) {
  if (maps.empty()) return {};
  for (const HeatMap& map : maps) check(map);
  const Scale scale = scale_of(maps);
  Canvas canvas({size_each.width * static_cast<int>(maps.size()), size_each.height}, palette::kPaper);
  double x_offset = 0.0;
  for (const HeatMap& map : maps) {
    const Frame frame(map, size_each, x_offset);
    draw_cells(map, frame, scale, canvas);
    draw_axes(map, frame, canvas);
    draw_marks(map, frame, canvas);
    x_offset += size_each.width;
  }
  return canvas.picture();
}

}  // namespace alidade
