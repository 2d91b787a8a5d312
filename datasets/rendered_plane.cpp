// SPDX-License-Identifier: Apache-2.0
#include "datasets/rendered_plane.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kCell_px = 8;  // the interpolation error falls with its fourth power

// The weights of four neighbouring nodes at -1, 0, 1, 2 for a place t in 0..1: the cubic through them.
std::array<double, 4> cubic_weights(double t) {
  return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
          (t + 1) * t * (t - 1) / 6};
}

// Where rays from one centre meet the plane, in the plane's frame.
class Surface {
 public:
  Surface(const PlaneBulge& bulge, const Vector3d& centre) : centre_(centre) {
    // z = c - w · (p - p0)², written for the ray p = centre + t d: a quadratic in t.
    curvature_ = bulge.height_m.cwiseQuotient(bulge.half_size_m.cwiseAbs2());
    from_middle_ = centre.head<2>() - bulge.centre_m;
    start_ = centre.z() - bulge.height_m.sum() + curvature_.dot(from_middle_.cwiseAbs2());
  }

  // The ray's parameter; not positive or NaN where it does not meet the surface.
  double meet(const Vector3d& d) const {
    const double a = curvature_.dot(d.head<2>().cwiseAbs2());
    const double b = d.z() + 2 * curvature_.dot(from_middle_.cwiseProduct(d.head<2>()));
    if (a == 0) return -start_ / b;
    return -2 * start_ / (b + std::copysign(std::sqrt(b * b - 4 * a * start_), b));
  }

  Vector2d point(const Vector3d& d, double t) const { return centre_.head<2>() + t * d.head<2>(); }

 private:
  Vector3d centre_;
  Vector2d curvature_, from_middle_;
  double start_;
};

// The weights of three neighbouring texels for a place t in -½..½ from the middle one: the quadratic B-spline. Its sum
// over rays in steps of about a texel moves an edge by 0.01 px at most; of linear interpolation it moves it by 0.04.
std::array<float, 3> spline_weights(float t) {
  return {0.5f * (0.5f - t) * (0.5f - t), 0.75f - t * t, 0.5f * (0.5f + t) * (0.5f + t)};
}

// One level of the texture, read at places in metres.
struct LevelReader {
  const cv::Mat& texels;
  double scale;     // texels per m
  Vector2d origin;  // of the plane's frame, texels
  float background;

  float read(const Vector2d& p_plane) const {
    const double u = origin.x() + scale * p_plane.x();
    const double v = origin.y() + scale * p_plane.y();
    // Written so that NaN is outside.
    if (!(u >= -0.5 && v >= -0.5 && u <= texels.cols - 0.5 && v <= texels.rows - 0.5)) return background;
    const int x = std::clamp(static_cast<int>(u + 0.5), 1, texels.cols - 2);
    const int y = std::clamp(static_cast<int>(v + 0.5), 1, texels.rows - 2);
    const auto wx = spline_weights(std::clamp(static_cast<float>(u - x), -0.5f, 0.5f));
    const auto wy = spline_weights(std::clamp(static_cast<float>(v - y), -0.5f, 0.5f));
    float sum = 0;
    for (int i = 0; i < 3; ++i) {
      const unsigned char* row = texels.ptr<unsigned char>(y - 1 + i) + x;
      sum += wy[static_cast<std::size_t>(i)] * (wx[0] * row[-1] + wx[1] * row[0] + wx[2] * row[1]);
    }
    return sum;
  }
};

std::vector<cv::Mat> halvings(const cv::Mat& grey) {
  constexpr int kLeast_px = 16;
  std::vector<cv::Mat> levels{grey.clone()};
  while (std::min(levels.back().cols, levels.back().rows) >= 2 * kLeast_px) {
    // An odd last row or column would shift the halves' grid: it is repeated, not dropped.
    const cv::Mat& last = levels.back();
    cv::Mat even, half;
    cv::copyMakeBorder(last, even, 0, last.rows % 2, 0, last.cols % 2, cv::BORDER_REPLICATE);
    cv::resize(even, half, {even.cols / 2, even.rows / 2}, 0, 0, cv::INTER_AREA);
    levels.push_back(half);
  }
  return levels;
}

// With the lens' blur and the sensor's noise.
cv::Mat as_taken(cv::Mat image, const PlaneRenderOptions& options) {
  if (options.blur_px > 0) cv::GaussianBlur(image, image, {}, options.blur_px);
  if (options.noise_grey > 0) {
    cv::RNG random(options.seed);
    cv::Mat noise(image.size(), CV_32FC1);
    random.fill(noise, cv::RNG::NORMAL, 0, options.noise_grey);
    image += noise;
  }
  cv::Mat grey;
  image.convertTo(grey, CV_8UC1);
  return grey;
}

// Draws cell by cell of the lattice of rays.
class CellPainter {
 public:
  CellPainter(const Surface& surface, int supersampling, std::vector<LevelReader> levels)
      : surface_(surface), side_(supersampling), levels_(std::move(levels)) {
    for (int i = 0; i < kCell_px * side_; ++i) weights_.push_back(cubic_weights((i + 0.5) / (kCell_px * side_)));
  }

  // Adds to the pixels of `area`, at a node's corner, from the rays (plane's frame) of 4×4 nodes, row by row.
  void paint(const std::array<Vector3d, 16>& nodes, cv::Mat& image, const cv::Rect& area) const {
    const LevelReader& texture = level_of(nodes[5], nodes[6], nodes[9], kCell_px * side_);
    for (int y = 0; y < area.height * side_; ++y) {
      const auto& wy = weights_[static_cast<std::size_t>(y)];
      std::array<Vector3d, 4> column;
      for (std::size_t i = 0; i < 4; ++i) {
        column[i] = wy[0] * nodes[i] + wy[1] * nodes[4 + i] + wy[2] * nodes[8 + i] + wy[3] * nodes[12 + i];
      }
      float* row = image.ptr<float>(area.y + y / side_) + area.x;
      for (int x = 0; x < area.width * side_; ++x) {
        const auto& wx = weights_[static_cast<std::size_t>(x)];
        const Vector3d d = wx[0] * column[0] + wx[1] * column[1] + wx[2] * column[2] + wx[3] * column[3];
        row[x / side_] += share() * read(texture, d);
      }
    }
  }

  // The same from the lens itself, for cells where it has not a ray for each node: where its circle ends.
  void paint_exactly(const Camera& camera, const Eigen::Matrix3d& R_plane_camera, cv::Mat& image,
                     const cv::Rect& area) const {
    const auto ray = [&](double x, double y) -> Vector3d {
      const auto d = unproject(camera, {area.x - 0.5 + x / side_, area.y - 0.5 + y / side_});
      return d ? Vector3d(R_plane_camera * *d) : Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    };
    for (int y = 0; y < area.height * side_; ++y) {
      for (int x = 0; x < area.width * side_; ++x) {
        const Vector3d d = ray(x + 0.5, y + 0.5);
        const LevelReader& texture = level_of(d, ray(x + 1.5, y + 0.5), ray(x + 0.5, y + 1.5), 1);
        image.at<float>(area.y + y / side_, area.x + x / side_) += share() * read(texture, d);
      }
    }
  }

 private:
  float share() const { return 1.0f / static_cast<float>(side_ * side_); }

  float read(const LevelReader& texture, const Vector3d& d) const {
    const double t = surface_.meet(d);
    return t > 0 ? texture.read(surface_.point(d, t)) : texture.background;
  }

  // Texels of 0.8 to 1.6 times the distance of two rays: smaller ones alias, larger ones blur.
  // `right` and `below` are `steps` rays away.
  const LevelReader& level_of(const Vector3d& d, const Vector3d& right, const Vector3d& below, int steps) const {
    constexpr double kLeastTexel = 0.8;
    const Vector2d p = surface_.point(d, surface_.meet(d));
    const double far_m = std::max((surface_.point(right, surface_.meet(right)) - p).norm(),
                                  (surface_.point(below, surface_.meet(below)) - p).norm());
    std::size_t level = 0;
    while (level + 1 < levels_.size() && steps < kLeastTexel * far_m * levels_[level].scale) ++level;
    return levels_[level];
  }

  const Surface& surface_;
  int side_;
  std::vector<LevelReader> levels_;
  std::vector<std::array<double, 4>> weights_;
};

// The nodes around a cell; empty where one has no ray.
std::optional<std::array<Vector3d, 16>> nodes_around(const std::vector<Vector3d>& lattice, int width, int x, int y) {
  std::array<Vector3d, 16> nodes;
  for (std::size_t i = 0; i < 16; ++i) {
    nodes[i] = lattice[static_cast<std::size_t>((y + static_cast<int>(i) / 4) * width + x) + i % 4];
    if (nodes[i].hasNaN()) return std::nullopt;
  }
  return nodes;
}

}  // namespace

double height_m(const PlaneBulge& bulge, const Vector2d& p_plane) {
  const Vector2d uv = (p_plane - bulge.centre_m).cwiseQuotient(bulge.half_size_m);
  return bulge.height_m.dot(Vector2d::Ones() - uv.cwiseAbs2());
}

void validate(const PlaneRenderOptions& o) {
  if (!(o.blur_px >= 0)) throw std::invalid_argument(fmt::format("blur_px must be >= 0 px, got {}", o.blur_px));
  if (!(o.noise_grey >= 0)) throw std::invalid_argument(fmt::format("noise_grey must be >= 0, got {}", o.noise_grey));
  if (o.supersampling < 1 || o.supersampling > 16) {
    throw std::invalid_argument(fmt::format("supersampling must be 1..16, got {}", o.supersampling));
  }
  if (!(o.background_grey >= 0 && o.background_grey <= 255)) {
    throw std::invalid_argument(fmt::format("background_grey must be 0..255, got {}", o.background_grey));
  }
  if (!(o.bulge.half_size_m.array() > 0).all()) throw std::invalid_argument("bulge.half_size_m must be > 0 m");
}

PlaneRenderer::PlaneRenderer(const Camera& camera, const PlaneTexture& texture)
    : camera_(camera),
      pixels_per_m_(texture.pixels_per_m),
      origin_px_(texture.origin_px),
      nodes_x_((camera.width + kCell_px - 1) / kCell_px + 3),
      nodes_y_((camera.height + kCell_px - 1) / kCell_px + 3) {
  if (const auto fault = find_fault(camera)) throw std::invalid_argument(*fault);
  if (texture.grey.type() != CV_8UC1 || texture.grey.cols < 3 || texture.grey.rows < 3) {
    throw std::invalid_argument("the texture of a plane must be a grey image of 8 bits");
  }
  if (!(pixels_per_m_ > 0)) throw std::invalid_argument("the texture of a plane must have > 0 pixels per m");
  levels_ = halvings(texture.grey);
  d_camera_.reserve(static_cast<std::size_t>(nodes_x_ * nodes_y_));
  for (int y = -1; y < nodes_y_ - 1; ++y) {
    for (int x = -1; x < nodes_x_ - 1; ++x) {
      const auto d = unproject(camera, {x * kCell_px - 0.5, y * kCell_px - 0.5});
      d_camera_.push_back(d ? *d : Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
  }
}

cv::Mat PlaneRenderer::render(const Eigen::Isometry3d& T_camera_plane, const PlaneRenderOptions& options) const {
  validate(options);
  const Eigen::Isometry3d T_plane_camera = T_camera_plane.inverse();
  const Surface surface(options.bulge, T_plane_camera.translation());
  std::vector<LevelReader> levels;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const double factor = std::ldexp(1.0, -static_cast<int>(i));
    const Vector2d half = Vector2d::Constant(0.5);
    levels.push_back({levels_[i], pixels_per_m_ * factor, (origin_px_ + half) * factor - half,
                      static_cast<float>(options.background_grey)});
  }
  const CellPainter painter(surface, options.supersampling, std::move(levels));
  std::vector<Vector3d> d_plane;
  d_plane.reserve(d_camera_.size());
  for (const Vector3d& d : d_camera_) d_plane.emplace_back(T_plane_camera.linear() * d);
  cv::Mat image = cv::Mat::zeros(camera_.height, camera_.width, CV_32FC1);
  const cv::Rect whole(0, 0, camera_.width, camera_.height);
  for (int y = 0; y + 3 < nodes_y_; ++y) {
    for (int x = 0; x + 3 < nodes_x_; ++x) {
      const cv::Rect area = cv::Rect(x * kCell_px, y * kCell_px, kCell_px, kCell_px) & whole;
      if (const auto nodes = nodes_around(d_plane, nodes_x_, x, y)) {
        painter.paint(*nodes, image, area);
      } else {
        painter.paint_exactly(camera_, T_plane_camera.linear(), image, area);
      }
    }
  }
  return as_taken(image, options);
}

cv::Mat render_plane(const Camera& camera, const Eigen::Isometry3d& T_camera_plane, const PlaneTexture& texture,
                     const PlaneRenderOptions& options) {
  return PlaneRenderer(camera, texture).render(T_camera_plane, options);
}

}  // namespace alidade
