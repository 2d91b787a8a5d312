// SPDX-License-Identifier: Apache-2.0
#include "view/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <opencv2/imgproc.hpp>

#include "view/canvas.h"

namespace alidade {
namespace {

constexpr double kSigmas = 3.0;

struct StateLook {
  TrackState state;
  const char* name;
  Rgb colour;
};

// In drawing order: what is rare and worth seeing lies on top.
constexpr std::array<StateLook, 4> kLooks{{{TrackState::Tracked, "tracked", {60, 220, 90}},
                                           {TrackState::New, "new", {70, 160, 255}},
                                           {TrackState::Predicted, "predicted", {255, 190, 40}},
                                           {TrackState::Rejected, "rejected", {245, 60, 60}}}};

cv::Point2d to_point(const Eigen::Vector2d& p) {
  return {p.x(), p.y()};
}

Rgb dimmed(const Rgb& colour) {
  return {std::uint8_t(colour[0] * 2 / 3), std::uint8_t(colour[1] * 2 / 3), std::uint8_t(colour[2] * 2 / 3)};
}

void draw_predicted(Canvas& canvas, const PredictedPixel& predicted, const Rgb& colour) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(predicted.covariance_px2);
  const Eigen::Vector2d axes = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt() * kSigmas;
  if (!predicted.pixel.allFinite() || !axes.allFinite()) return;
  const Eigen::Vector2d longer = eigen.eigenvectors().col(1);
  canvas.draw_ellipse(to_point(predicted.pixel), {axes[1], axes[0]}, std::atan2(longer.y(), longer.x()),
                      {dimmed(colour), 1.0});
}

void draw_tail(Canvas& canvas, const OverlayTrack& track, const Rgb& colour) {
  std::vector<cv::Point2d> line;
  for (const auto& p : track.tail) {
    if (p.allFinite()) line.push_back(to_point(p));
  }
  line.push_back(to_point(track.pixel));
  canvas.draw_polyline(line, {dimmed(colour), 1.0});
}

void draw_track(Canvas& canvas, const OverlayTrack& track, const Rgb& colour) {
  if (track.predicted) draw_predicted(canvas, *track.predicted, colour);
  if (!track.pixel.allFinite()) return;
  draw_tail(canvas, track, colour);
  const cv::Point2d at = to_point(track.pixel);
  if (track.state == TrackState::Predicted) {
    canvas.draw_circle(at, 2.5, {colour, 1.0});
  } else if (track.state == TrackState::Rejected) {
    canvas.draw_line(at + cv::Point2d(-3, -3), at + cv::Point2d(3, 3), {colour, 1.0});
    canvas.draw_line(at + cv::Point2d(-3, 3), at + cv::Point2d(3, -3), {colour, 1.0});
  } else {
    canvas.draw_disc(at, 2.2, colour);
  }
}

// The status line, and on its right what the colours mean and how many points have each.
void draw_strip(Canvas& canvas, const Overlay& overlay) {
  const cv::Rect whole = canvas.whole();
  const double size_px = std::clamp(whole.height / 34.0, 10.0, 28.0);
  const int height = static_cast<int>(std::lround(size_px * 1.7));
  const cv::Rect strip(0, whole.height - height, whole.width, height);
  canvas.tint(strip, {16, 18, 22}, 0.72);
  const double middle = strip.y + height / 2.0 - 0.5;
  const TextFont font{size_px};
  canvas.write(overlay.status, {size_px * 0.6, middle}, {font, {240, 240, 240}});
  double right = whole.width - size_px * 0.6;
  for (auto look = kLooks.rbegin(); look != kLooks.rend(); ++look) {
    const auto count = std::ranges::count(overlay.tracks, look->state, &OverlayTrack::state);
    if (count == 0) continue;
    const std::string text = std::to_string(count) + " " + look->name;
    canvas.write(text, {right, middle}, {font, look->colour, Anchor::Right});
    right -= text_size(text, font).width + size_px;
  }
}

}  // namespace

cv::Mat draw_overlay(const cv::Mat& frame, const Overlay& overlay) {
  if (frame.empty() || (frame.type() != CV_8UC1 && frame.type() != CV_8UC3)) {
    throw std::invalid_argument("draw_overlay: frame must be CV_8UC1 or CV_8UC3 and not empty");
  }
  cv::Mat bgr = frame;
  if (frame.channels() == 1) cv::cvtColor(frame, bgr, cv::COLOR_GRAY2BGR);
  Canvas canvas(bgr);
  for (const auto& look : kLooks) {
    for (const auto& track : overlay.tracks) {
      if (track.state == look.state) draw_track(canvas, track, look.colour);
    }
  }
  if (!overlay.status.empty()) draw_strip(canvas, overlay);
  return canvas.picture();
}

}  // namespace alidade
