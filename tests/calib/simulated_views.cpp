// SPDX-License-Identifier: Apache-2.0
#include "tests/calib/simulated_views.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "geometry/rotation.h"
#include "tests/geometry/random_geometry.h"

namespace alidade::test {
namespace {

using Corners = std::vector<BoardCorner>;

// Empty unless the whole board lies in the image.
std::optional<Corners> look(const Camera& camera, const BoardShape& shape, const BoardWarp& warp,
                            const Eigen::Isometry3d& T_camera_board) {
  Corners corners;
  for (int id = 0; id < static_cast<int>(shape.corners_m.size()); ++id) {
    const auto seen = project(camera, T_camera_board * shape.corner(id, warp));
    if (!seen || !is_inside(camera, seen->pixel)) return std::nullopt;
    corners.push_back({id, seen->pixel});
  }
  return corners;
}

// A board whose centre is seen somewhere in the inner 60 % of the image.
Eigen::Isometry3d draw_board(const Camera& camera, const BoardShape& shape, const Simulation& simulation,
                             RandomGeometry& random) {
  const double tilt = simulation.most_tilt;
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  T_camera_board.linear() =
      exp_so3({random.uniform(-tilt, tilt), random.uniform(-tilt, tilt), random.uniform(-0.3, 0.3)});
  const Eigen::Vector2d pixel(camera.width * random.uniform(0.2, 0.8), camera.height * random.uniform(0.2, 0.8));
  const double z = simulation.distance * random.uniform(0.75, 1.25) * shape.extent_m * camera.fx / camera.width;
  const Eigen::Vector3d centre = 0.5 * (shape.corners_m.front() + shape.corners_m.back());
  T_camera_board.translation() = z * undistort(camera, pixel)->homogeneous() - T_camera_board.linear() * centre;
  return T_camera_board;
}

void disturb(Corners& corners, const Simulation& simulation, RandomGeometry& random) {
  for (BoardCorner& corner : corners) {
    corner.pixel += Eigen::Vector2d(random.normal(simulation.noise_px), random.normal(simulation.noise_px));
    corner.sigma_px = simulation.sigma_px;
  }
}

// What each of `who` sees of a board that all of them see.
struct Moment {
  Eigen::Isometry3d T_rig_board;
  std::vector<Corners> corners;
};

Moment draw_moment(const std::vector<BundleCamera>& cameras, const std::vector<int>& who, const BoardShape& shape,
                   const Simulation& simulation, RandomGeometry& random) {
  const auto at = [&](int camera) -> const BundleCamera& { return cameras[static_cast<std::size_t>(camera)]; };
  while (true) {
    Moment moment{at(who.front()).T_rig_camera * draw_board(at(who.front()).camera, shape, simulation, random), {}};
    for (const int camera : who) {
      auto corners =
          look(at(camera).camera, shape, simulation.warp, at(camera).T_rig_camera.inverse() * moment.T_rig_board);
      if (corners) moment.corners.push_back(std::move(*corners));
    }
    if (moment.corners.size() == who.size()) return moment;
  }
}

}  // namespace

Board simulated_board() {
  Board board;
  board.columns = 9;
  board.rows = 6;
  board.square_m = 0.025;
  return board;
}

Camera simulated_camera(LensModel lens) {
  Camera camera{640, 480, 530, 531, 325, 236, {}, 0};
  switch (lens) {
    case LensModel::Radial:
      camera.distortion = BrownConrady{-0.28, 0.09, 0.001, -0.0005};
      break;
    case LensModel::Brown:
      camera.distortion = BrownConrady{-0.28, 0.12, 0.001, -0.0005, -0.03};
      break;
    case LensModel::Rational:
      camera.distortion = BrownConrady{0.3, -0.2, 0.001, -0.0005, 0.05, 0.6, -0.15, 0.02};
      break;
    case LensModel::Fisheye:
      camera.fx = 250;
      camera.fy = 251;
      camera.distortion = Fisheye{-0.03, 0.01, -0.004, 0.0005};
      break;
  }
  return camera;
}

SimulatedRig simulate_rig(const std::vector<BundleCamera>& cameras, const std::vector<std::vector<int>>& who_looks,
                          const Simulation& simulation, unsigned seed) {
  RandomGeometry random(seed);
  const BoardShape shape = shape_of(simulated_board());
  SimulatedRig rig;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera& camera = cameras[i].camera;
    rig.cameras.push_back({"camera" + std::to_string(i), {camera.width, camera.height}, {}});
  }
  for (const std::vector<int>& who : who_looks) {
    Moment moment = draw_moment(cameras, who, shape, simulation, random);
    const int frame = static_cast<int>(rig.T_rig_board.size());
    for (std::size_t i = 0; i < who.size(); ++i) {
      disturb(moment.corners[i], simulation, random);
      rig.cameras[static_cast<std::size_t>(who[i])].views.push_back(
          {"image" + std::to_string(frame), frame, 0.0, std::move(moment.corners[i])});
    }
    rig.T_rig_board.push_back(moment.T_rig_board);
  }
  return rig;
}

SimulatedViews simulate_views(const Camera& camera, const Simulation& simulation, unsigned seed) {
  const std::vector<std::vector<int>> alone(static_cast<std::size_t>(simulation.views), {0});
  SimulatedRig rig = simulate_rig({{camera, Eigen::Isometry3d::Identity()}}, alone, simulation, seed);
  return {std::move(rig.cameras.front().views), std::move(rig.T_rig_board)};
}

SimulatedBundle simulate_bundle(const Camera& camera, const Simulation& simulation, unsigned seed) {
  SimulatedViews simulated = simulate_views(camera, simulation, seed);
  SimulatedBundle bundle;
  bundle.shape = shape_of(simulated_board());
  bundle.truth = {{{camera, Eigen::Isometry3d::Identity()}}, std::move(simulated.T_camera_board), simulation.warp};
  for (BoardView& view : simulated.views) {
    const std::size_t count = view.corners.size();
    bundle.views.push_back({0, view.frame, std::move(view.corners), std::vector<double>(count, 1.0)});
  }
  return bundle;
}

double largest_difference_px(const Camera& truth, const Camera& found, double border) {
  double largest = 0;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      const Eigen::Vector2d share(border + (1 - 2 * border) * i / 8, border + (1 - 2 * border) * j / 8);
      const Eigen::Vector2d pixel = share.cwiseProduct(Eigen::Vector2d(truth.width - 1, truth.height - 1));
      const auto direction = unproject(truth, pixel);
      const auto seen = direction ? project(found, *direction) : std::nullopt;
      if (!seen) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, (seen->pixel - pixel).norm());
    }
  }
  return largest;
}

}  // namespace alidade::test
