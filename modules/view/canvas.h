// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <opencv2/core.hpp>

#include "view/colour.h"
#include "view/text.h"

namespace alidade {

struct Stroke {
  Rgb colour = palette::kInk;
  double width_px = 1.0;
  bool dashed = false;
};

/// Where a text lies relative to its anchor.
enum class Anchor { Left, Centre, Right };

struct Lettering {
  TextFont font;
  Rgb colour = palette::kInk;
  Anchor anchor = Anchor::Left;
  bool upwards = false;  ///< turned to read from bottom to top
};

/// A picture to draw on, anti-aliased. Coordinates are pixels of the finished picture, (0, 0) the centre of its
/// top-left pixel. Whatever lies outside the clip rectangle is left out. Needs no display.
class Canvas {
 public:
  /// Empty paper, drawn `supersampling` times larger and shrunk in the end.
  Canvas(cv::Size size, const Rgb& background, int supersampling = 2);

  /// On a copy of `bgr` (CV_8UC3).
  explicit Canvas(const cv::Mat& bgr);

  /// Restricts what follows to `clip` (px); whole() lifts it.
  void restrict_to(const cv::Rect& clip);
  cv::Rect whole() const;

  void draw_line(cv::Point2d a, cv::Point2d b, const Stroke& stroke);
  void draw_polyline(std::span<const cv::Point2d> points, const Stroke& stroke);
  /// Convex.
  void fill_polygon(std::span<const cv::Point2d> corners, const Rgb& colour);
  void draw_disc(cv::Point2d centre, double radius_px, const Rgb& colour);
  void draw_circle(cv::Point2d centre, double radius_px, const Stroke& stroke);
  /// `axes_px`: half lengths; `angle_rad` from x towards y, of the first.
  void draw_ellipse(cv::Point2d centre, cv::Size2d axes_px, double angle_rad, const Stroke& stroke);
  /// Mixes `colour` over a rectangle with `opacity` 0..1.
  void tint(const cv::Rect& area, const Rgb& colour, double opacity);
  /// The anchor lies half-way up the line of text.
  void write(const std::string& text, cv::Point2d anchor, const Lettering& lettering);

  /// The finished picture, CV_8UC3 (BGR).
  cv::Mat picture() const;

 private:
  cv::Point to_fixed(cv::Point2d p) const;
  int thickness(double width_px) const;
  void draw_dashes(std::span<const cv::Point2d> points, const Stroke& stroke);

  cv::Mat image_;
  cv::Mat clipped_;
  cv::Point clip_origin_;
  int supersampling_;
};

/// Size in px of a text as written.
cv::Size text_size(const std::string& text, const TextFont& font);

}  // namespace alidade
