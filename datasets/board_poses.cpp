// SPDX-License-Identifier: Apache-2.0
#include "datasets/board_poses.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRadians = std::numbers::pi / 180;

struct Draw {
  std::mt19937 random;
  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random); }
};

// The middles of about `count` cells over the image, at least as many, in random order.
std::vector<Vector2d> shuffled_cells(const Camera& camera, int count, Draw& draw) {
  const int columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(count * double(camera.width) / camera.height))));
  const int rows = (count + columns - 1) / columns;
  std::vector<Vector2d> cells;
  for (int i = 0; i < columns * rows; ++i) {
    cells.emplace_back((i % columns + 0.5) * camera.width / columns - 0.5,
                       (i / columns + 0.5) * camera.height / rows - 0.5);
  }
  std::shuffle(cells.begin(), cells.end(), draw.random);
  return cells;
}

// The share of the board that the camera sees, by a lattice over its extent.
double share_in_image(const Camera& camera, const Eigen::Isometry3d& T_camera_board, const Eigen::AlignedBox2d& extent,
                      double margin_px) {
  constexpr int kSteps = 8;
  int seen = 0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Vector2d p = extent.min() + Vector2d(i, j).cwiseProduct(extent.sizes()) / kSteps;
      const auto projection = project(camera, T_camera_board * Vector3d(p.x(), p.y(), 0));
      if (projection && is_inside(camera, projection->pixel, margin_px)) ++seen;
    }
  }
  return static_cast<double>(seen) / ((kSteps + 1) * (kSteps + 1));
}

Eigen::Matrix3d random_rotation(const BoardPoseOptions& options, Draw& draw) {
  const double direction = draw.uniform(0, 2 * std::numbers::pi);
  const double tilt = draw.uniform(0, options.most_tilt_deg * kRadians);
  const double roll = draw.uniform(-options.most_roll_deg, options.most_roll_deg) * kRadians;
  return (Eigen::AngleAxisd(tilt, Vector3d(std::cos(direction), std::sin(direction), 0)) *
          Eigen::AngleAxisd(roll, Vector3d::UnitZ()))
      .toRotationMatrix();
}

// A pose with the board's centre at `pixel`, or as far towards the middle as the board needs to fit.
Eigen::Isometry3d pose_at_pixel(const Camera& camera, const Eigen::AlignedBox2d& extent, const Vector2d& pixel,
                                const BoardPoseOptions& options, Draw& draw) {
  constexpr int kTries = 80;
  constexpr double kTowardsMiddle = 0.95, kPartialShare = 2.0 / 3.0;
  const Vector2d middle(0.5 * (camera.width - 1), 0.5 * (camera.height - 1));
  const double fill = draw.uniform(options.least_fill, options.most_fill);
  Vector2d place = pixel;
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  for (int i = 0; i < kTries; ++i, place = middle + kTowardsMiddle * (place - middle)) {
    T_camera_board.linear() = random_rotation(options, draw);
    const double depth = std::max(camera.fx * extent.sizes().x() / (fill * camera.width),
                                  camera.fy * extent.sizes().y() / (fill * camera.height));
    const auto d = unproject(camera, place);
    if (!d || d->z() < 0.1) continue;
    const Vector3d centre(extent.center().x(), extent.center().y(), 0);
    T_camera_board.translation() = depth / d->z() * *d - T_camera_board.linear() * centre;
    const double share = share_in_image(camera, T_camera_board, extent, options.margin_px);
    if (share >= (options.partial ? kPartialShare : 1.0)) break;
  }
  return T_camera_board;
}

}  // namespace

void validate(const BoardPoseOptions& o) {
  const auto refuse = [](const char* field, const char* bound, double value) {
    throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
  };
  if (!(o.most_tilt_deg >= 0 && o.most_tilt_deg <= 80)) refuse("most_tilt_deg", "0..80 deg", o.most_tilt_deg);
  if (!(o.most_roll_deg >= 0 && o.most_roll_deg <= 180)) refuse("most_roll_deg", "0..180 deg", o.most_roll_deg);
  if (!(o.least_fill > 0 && o.least_fill <= 2)) refuse("least_fill", "> 0 and <= 2", o.least_fill);
  if (!(o.most_fill >= o.least_fill && o.most_fill <= 2)) refuse("most_fill", "least_fill..2", o.most_fill);
  if (!(o.margin_px >= 0)) refuse("margin_px", ">= 0 px", o.margin_px);
}

std::vector<Eigen::Isometry3d> board_poses(const Camera& camera, const Eigen::AlignedBox2d& extent_m, int count,
                                           unsigned seed, const BoardPoseOptions& options) {
  validate(options);
  if (const auto fault = find_fault(camera)) throw std::invalid_argument(*fault);
  if (count < 0) throw std::invalid_argument(fmt::format("count must be >= 0, got {}", count));
  if (!(extent_m.sizes().array() > 0).all()) throw std::invalid_argument("board_poses: the board's extent is empty");
  Draw draw{std::mt19937(seed)};
  const auto cells = shuffled_cells(camera, count, draw);
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back(pose_at_pixel(camera, extent_m, cells[static_cast<std::size_t>(i)], options, draw));
  }
  return poses;
}

}  // namespace alidade
