// SPDX-License-Identifier: Apache-2.0
#include "app/calibration_drawings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "view/canvas.h"
#include "view/heat_map.h"

namespace alidade {
namespace {

constexpr double kWidth = 720;  // px of a drawing of the image
constexpr double kMargin = 28;  // above it, for a line of text
constexpr Rgb kFrame{200, 200, 206};
constexpr Rgb kBad{200, 40, 40};

// A drawing of a camera's image, with a caption above it.
struct ImageDrawing {
  ImageDrawing(const Camera& camera, const std::string& caption)
      : scale(kWidth / camera.width),
        canvas(cv::Size(static_cast<int>(kWidth) + 1, static_cast<int>(camera.height * scale + kMargin) + 1),
               palette::kPaper) {
    const cv::Point2d a = at({-0.5, -0.5}), c = at({camera.width - 0.5, camera.height - 0.5});
    const std::vector<cv::Point2d> frame{a, {c.x, a.y}, c, {a.x, c.y}, a};
    canvas.draw_polyline(frame, {kFrame, 1.0});
    canvas.write(caption, {4, 0.5 * kMargin}, {{14}, palette::kInk, Anchor::Left});
  }

  cv::Point2d at(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() + 0.5) * scale, (pixel.y() + 0.5) * scale + kMargin};
  }

  double scale;
  Canvas canvas;
};

const Camera& camera_of(const BundleFit& fit, int camera) {
  return fit.bundle.cameras[static_cast<std::size_t>(camera)].camera;
}

// 1, 2 or 5 times a power of ten, not above `value`.
double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  return value >= 5 * power ? 5 * power : value >= 2 * power ? 2 * power : power;
}

}  // namespace

cv::Mat draw_coverage(const BundleFit& fit, int camera) {
  ImageDrawing drawing(camera_of(fit, camera), "corners: used, and cut (red)");
  for (const BundleView& view : fit.views) {
    if (view.camera != camera) continue;
    for (std::size_t i = 0; i < view.corners.size(); ++i) {
      const bool is_used = view.weights[i] > 0;
      drawing.canvas.draw_disc(drawing.at(view.corners[i].pixel), is_used ? 1.6 : 3.0,
                               is_used ? curve_colour(static_cast<std::size_t>(view.frame)) : kBad);
    }
  }
  return drawing.canvas.picture();
}

cv::Mat draw_residuals(const BundleFit& fit, const BoardShape& shape, const ResidualField& field, int camera) {
  const double typical_px = std::max(1e-6, std::hypot(field.noise_px, field.systematic_px));
  const double enlarged = round_down(0.025 * camera_of(fit, camera).width / typical_px);
  ImageDrawing drawing(
      camera_of(fit, camera),
      fmt::format("residuals, enlarged {:.0f} times; thick: means of cells, {:.0f} times", enlarged, 2 * enlarged));
  for (const BundleView& view : fit.views) {
    if (view.camera != camera) continue;
    const auto residuals = residuals_px(fit.bundle, shape, view);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (view.weights[i] <= 0) continue;
      const Eigen::Vector2d& pixel = view.corners[i].pixel;
      drawing.canvas.draw_line(drawing.at(pixel), drawing.at(pixel + enlarged * residuals[i]), {palette::kReference});
    }
  }
  for (const ResidualCell& cell : field.cells) {
    if (cell.count < 3) continue;
    drawing.canvas.draw_disc(drawing.at(cell.centre_px), 2.5, palette::kEstimate);
    drawing.canvas.draw_line(drawing.at(cell.centre_px), drawing.at(cell.centre_px + 2 * enlarged * cell.mean_px),
                             {palette::kEstimate, 3.0});
  }
  return drawing.canvas.picture();
}

cv::Mat draw_uncertainty(const UncertaintyMap& map, const Camera& camera) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const double sigma : map.sigma_px) {
    if (!std::isfinite(sigma)) continue;
    least = std::min(least, sigma);
    most = std::max(most, sigma);
  }
  ImageDrawing drawing(camera, "standard deviation of a pixel, px, at the boards' distance");
  const double span = std::max(0.1, std::log(most / least));
  const int every = std::max(1, map.columns / 8);
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const double sigma = map.sigma_px[static_cast<std::size_t>(row * map.columns + column)];
      if (!std::isfinite(sigma)) continue;
      const Eigen::Vector2d centre = map.step_px * Eigen::Vector2d(column, row);
      const Eigen::Vector2d half = 0.5 * map.step_px * Eigen::Vector2d(1, 1);
      const cv::Point2d a = drawing.at(centre - half), c = drawing.at(centre + half);
      const std::vector<cv::Point2d> cell{a, {c.x, a.y}, c, {a.x, c.y}};
      drawing.canvas.restrict_to({0, static_cast<int>(kMargin), 10'000, 10'000});
      drawing.canvas.fill_polygon(cell, heat_colour(std::log(sigma / least) / span));
    }
  }
  for (int row = every / 2; row < map.rows; row += every) {
    for (int column = every / 2; column < map.columns; column += every) {
      const double sigma = map.sigma_px[static_cast<std::size_t>(row * map.columns + column)];
      if (!std::isfinite(sigma)) continue;
      drawing.canvas.write(fmt::format("{:.2g}", sigma), drawing.at(map.step_px * Eigen::Vector2d(column, row)),
                           {{12}, palette::kInk, Anchor::Centre});
    }
  }
  return drawing.canvas.picture();
}

cv::Mat draw_bars(const std::string& title, const std::vector<Bar>& bars) {
  constexpr double kHeight = 200, kNames = 110;
  const double step = std::clamp(900.0 / std::max<std::size_t>(1, bars.size()), 6.0, 40.0);
  const double width = std::max(360.0, 60 + step * static_cast<double>(bars.size()));
  Canvas canvas({static_cast<int>(width), static_cast<int>(kMargin + kHeight + kNames)}, palette::kPaper);
  canvas.write(title, {4, 0.5 * kMargin}, {{14}, palette::kInk, Anchor::Left});
  double most = 1e-9;
  for (const Bar& bar : bars) most = std::max(most, bar.value);
  const double unit = round_down(most / 2);
  const auto level = [&](double value) { return kMargin + kHeight * (1.0 - value / (1.05 * most)); };
  for (double value = 0; value <= most; value += unit) {
    canvas.draw_line({44, level(value)}, {width - 8, level(value)}, {kFrame});
    canvas.write(fmt::format("{:.3g}", value), {40, level(value)}, {{11}, palette::kInk, Anchor::Right});
  }
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double left = 48 + step * static_cast<double>(i), right = left + 0.8 * step;
    const double top = level(bars[i].value), bottom = level(0);
    const std::vector<cv::Point2d> shape{{left, top}, {right, top}, {right, bottom}, {left, bottom}};
    canvas.fill_polygon(shape, bars[i].is_bad ? kBad : palette::kEstimate);
    if (step < 11) continue;
    canvas.write(bars[i].name, {0.5 * (left + right), bottom + 6}, {{11}, palette::kInk, Anchor::Right, true});
  }
  return canvas.picture();
}

Plot radial_residual_plot(const BundleFit& fit, const BoardShape& shape, int camera) {
  const Camera& lens = camera_of(fit, camera);
  Series radial{"along the radius", {}, {}, SeriesStyle::Dots, {}};
  Series across{"across it", {}, {}, SeriesStyle::Dots, {}};
  for (const BundleView& view : fit.views) {
    if (view.camera != camera) continue;
    const auto residuals = residuals_px(fit.bundle, shape, view);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (view.weights[i] <= 0) continue;
      const Eigen::Vector2d from_centre = view.corners[i].pixel - Eigen::Vector2d(lens.cx, lens.cy);
      const double radius = from_centre.norm();
      if (!(radius > 0)) continue;
      const Eigen::Vector2d out = from_centre / radius;
      radial.x.push_back(radius);
      radial.y.push_back(residuals[i].dot(out));
      across.x.push_back(radius);
      across.y.push_back(residuals[i].dot(Eigen::Vector2d(-out.y(), out.x())));
    }
  }
  return {"Residuals by distance from the principal point", "radius (px)", "residual (px)", {radial, across}};
}

}  // namespace alidade
