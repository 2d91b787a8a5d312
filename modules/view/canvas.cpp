// SPDX-License-Identifier: Apache-2.0
#include "view/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

constexpr int kFractionBits = 4;  // of OpenCV's fixed-point coordinates

cv::Scalar to_scalar(const Rgb& colour) {
  return {double(colour[2]), double(colour[1]), double(colour[0])};
}

double length(cv::Point2d v) {
  return std::hypot(v.x, v.y);
}

}  // namespace

Canvas::Canvas(cv::Size size, const Rgb& background, int supersampling)
    : image_(size * supersampling, CV_8UC3, to_scalar(background)), clipped_(image_), supersampling_(supersampling) {}

Canvas::Canvas(const cv::Mat& bgr) : image_(bgr.clone()), clipped_(image_), supersampling_(1) {}

cv::Rect Canvas::whole() const {
  return {0, 0, image_.cols / supersampling_, image_.rows / supersampling_};
}

void Canvas::restrict_to(const cv::Rect& clip) {
  const cv::Rect inside = clip & whole();
  clip_origin_ = inside.tl() * supersampling_;
  clipped_ = image_(cv::Rect(clip_origin_, inside.size() * supersampling_));
}

cv::Point Canvas::to_fixed(cv::Point2d p) const {
  constexpr double kFarthest = 1e5;  // px; keeps the fixed-point number within an int
  const auto convert = [&](double v, int origin) {
    const double scaled = (std::clamp(v, -kFarthest, kFarthest) + 0.5) * supersampling_ - 0.5 - origin;
    return static_cast<int>(std::lround(scaled * (1 << kFractionBits)));
  };
  return {convert(p.x, clip_origin_.x), convert(p.y, clip_origin_.y)};
}

int Canvas::thickness(double width_px) const {
  // OpenCV's anti-aliased lines of thickness 1, 2, 3, 5, 7 cover 1.4, 3.5, 5.5, 7.5, 9.5 px; even ones no more.
  const int k = std::max(0, static_cast<int>(std::lround((width_px * supersampling_ - 1.4) / 2.0)));
  return k <= 1 ? k + 1 : 2 * k - 1;
}

void Canvas::draw_line(cv::Point2d a, cv::Point2d b, const Stroke& stroke) {
  draw_polyline(std::array{a, b}, stroke);
}

void Canvas::draw_polyline(std::span<const cv::Point2d> points, const Stroke& stroke) {
  if (stroke.dashed) return draw_dashes(points, stroke);
  std::vector<cv::Point> fixed;
  fixed.reserve(points.size());
  for (const auto& p : points) fixed.push_back(to_fixed(p));
  if (fixed.size() < 2 || clipped_.empty()) return;
  cv::polylines(clipped_, fixed, false, to_scalar(stroke.colour), thickness(stroke.width_px), cv::LINE_AA,
                kFractionBits);
}

void Canvas::draw_dashes(std::span<const cv::Point2d> points, const Stroke& stroke) {
  constexpr double kPeriod_px = 12.0, kDash_px = 7.0;
  Stroke solid = stroke;
  solid.dashed = false;
  double walked = 0;  // along the line, modulo the period
  for (std::size_t i = 1; i < points.size(); ++i) {
    const cv::Point2d step = points[i] - points[i - 1];
    const double total = std::min(length(step), 1e5);
    const cv::Point2d unit = total > 0 ? step * (1.0 / length(step)) : cv::Point2d{};
    for (double at = 0; at < total;) {
      const double phase = std::fmod(walked, kPeriod_px);
      const bool on = phase < kDash_px;
      const double piece = std::min((on ? kDash_px : kPeriod_px) - phase + 1e-6, total - at);
      if (on) draw_line(points[i - 1] + unit * at, points[i - 1] + unit * (at + piece), solid);
      at += piece;
      walked += piece;
    }
  }
}

void Canvas::fill_polygon(std::span<const cv::Point2d> corners, const Rgb& colour) {
  std::vector<cv::Point> fixed;
  for (const auto& p : corners) fixed.push_back(to_fixed(p));
  if (fixed.size() < 3 || clipped_.empty()) return;
  cv::fillConvexPoly(clipped_, fixed, to_scalar(colour), cv::LINE_AA, kFractionBits);
}

void Canvas::draw_disc(cv::Point2d centre, double radius_px, const Rgb& colour) {
  if (clipped_.empty()) return;
  const int radius = static_cast<int>(std::lround(radius_px * supersampling_ * (1 << kFractionBits)));
  cv::circle(clipped_, to_fixed(centre), radius, to_scalar(colour), cv::FILLED, cv::LINE_AA, kFractionBits);
}

void Canvas::draw_circle(cv::Point2d centre, double radius_px, const Stroke& stroke) {
  if (clipped_.empty()) return;
  const int radius = static_cast<int>(std::lround(radius_px * supersampling_ * (1 << kFractionBits)));
  cv::circle(clipped_, to_fixed(centre), radius, to_scalar(stroke.colour), thickness(stroke.width_px), cv::LINE_AA,
             kFractionBits);
}

void Canvas::draw_ellipse(cv::Point2d centre, cv::Size2d axes_px, double angle_rad, const Stroke& stroke) {
  constexpr int kCorners = 48;
  std::vector<cv::Point2d> outline;
  for (int i = 0; i <= kCorners; ++i) {
    const double a = 2.0 * std::numbers::pi * i / kCorners;
    const double x = axes_px.width * std::cos(a), y = axes_px.height * std::sin(a);
    outline.emplace_back(centre.x + x * std::cos(angle_rad) - y * std::sin(angle_rad),
                         centre.y + x * std::sin(angle_rad) + y * std::cos(angle_rad));
  }
  draw_polyline(outline, stroke);
}

void Canvas::tint(const cv::Rect& area, const Rgb& colour, double opacity) {
  const cv::Rect inside = area & whole();
  if (inside.empty()) return;
  cv::Mat part = image_(cv::Rect(inside.tl() * supersampling_, inside.size() * supersampling_));
  const cv::Mat flat(part.size(), CV_8UC3, to_scalar(colour));
  cv::addWeighted(flat, opacity, part, 1.0 - opacity, 0, part);
}

void Canvas::write(const std::string& text, cv::Point2d anchor, const Lettering& lettering) {
  TextFont font = lettering.font;
  font.size_px *= supersampling_;
  cv::Mat mask = text_mask(text, font);
  const double along = lettering.anchor == Anchor::Left ? 0.0 : lettering.anchor == Anchor::Centre ? 0.5 : 1.0;
  if (lettering.upwards) cv::rotate(mask, mask, cv::ROTATE_90_COUNTERCLOCKWISE);
  const double back_x = lettering.upwards ? 0.5 : along, back_y = lettering.upwards ? 1.0 - along : 0.5;
  const cv::Point corner(static_cast<int>(std::lround((anchor.x + 0.5) * supersampling_ - back_x * mask.cols)),
                         static_cast<int>(std::lround((anchor.y + 0.5) * supersampling_ - back_y * mask.rows)));
  const cv::Rect target = cv::Rect(corner, mask.size()) & cv::Rect({0, 0}, image_.size());
  for (int y = target.y; y < target.y + target.height; ++y) {
    for (int x = target.x; x < target.x + target.width; ++x) {
      const int alpha = mask.at<unsigned char>(y - corner.y, x - corner.x);
      auto& pixel = image_.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) {
        pixel[c] = static_cast<unsigned char>((pixel[c] * (255 - alpha) + lettering.colour[2 - c] * alpha + 127) / 255);
      }
    }
  }
}

cv::Mat Canvas::picture() const {
  if (supersampling_ == 1) return image_.clone();
  cv::Mat small;
  cv::resize(image_, small, whole().size(), 0, 0, cv::INTER_AREA);
  return small;
}

cv::Size text_size(const std::string& text, const TextFont& font) {
  return text_mask(text, font).size();
}

}  // namespace alidade
