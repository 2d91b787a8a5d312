// SPDX-License-Identifier: Apache-2.0
#include "tests/calib/simulated_films.h"

#include <cmath>
#include <string>

#include "geometry/rotation.h"
#include "tests/calib/simulated_views.h"
#include "tests/geometry/random_geometry.h"

namespace alidade::test {

Board filmed_chessboard() {
  Board board;
  board.columns = 6;
  board.rows = 5;
  board.square_m = 0.04;
  return board;
}

HandMotion::HandMotion(unsigned seed, double size) {
  RandomGeometry random(seed);
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const double most = size * (axis < 3 ? 0.05 : 0.2);  // m, rad
    for (Eigen::Index i = 0; i < 3; ++i) {
      amplitude_(axis, i) = most * random.uniform(0.5, 1.0);
      frequency_rad_s_(axis, i) = random.uniform(0.8, 4.5);
      phase_(axis, i) = random.uniform(0.0, 6.28);
    }
  }
}

Eigen::Isometry3d HandMotion::T_rig_board(double rig_time_s) const {
  const Eigen::Array<double, 6, 3> angles = (frequency_rad_s_ * rig_time_s + phase_).array();
  const Vector6d moved = (amplitude_.array() * angles.sin()).rowwise().sum();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3(moved.tail<3>());
  T.translation() = Eigen::Vector3d(0, 0, 0.9) + moved.head<3>() - T.linear() * Eigen::Vector3d(0.1, 0.08, 0);
  return T;
}

CameraFilm simulate_film(const BundleCamera& camera, const HandMotion& motion, const SimulatedFilm& film,
                         unsigned seed) {
  RandomGeometry random(seed);
  const auto corners = corners_m(filmed_chessboard());
  std::vector<BoardView> views;
  for (int frame = 0; frame < film.duration_s * film.rate_hz; ++frame) {
    const double rig_time_s = film.start_s + frame / film.rate_hz;
    BoardView view{"frame" + std::to_string(frame), frame, rig_time_s - film.offset_s, {}};
    const Eigen::Isometry3d T_camera_board = camera.T_rig_camera.inverse() * motion.T_rig_board(rig_time_s);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto seen = project(camera.camera, T_camera_board * corners[i]);
      const Eigen::Vector2d noise(random.normal(film.noise_px), random.normal(film.noise_px));
      if (!seen || !is_inside(camera.camera, seen->pixel)) continue;
      view.corners.push_back({static_cast<int>(i), seen->pixel + noise});
    }
    if (2 * view.corners.size() >= corners.size()) views.push_back(std::move(view));
  }
  return {camera.camera, BoardFilm(std::move(views))};
}

std::vector<BundleCamera> filming_cameras() {
  std::vector<BundleCamera> cameras(2, {simulated_camera(LensModel::Radial), Eigen::Isometry3d::Identity()});
  cameras[1].T_rig_camera.translation() << 0.3, 0.02, 0.01;
  cameras[1].T_rig_camera.linear() = exp_so3({0.01, -0.3, 0.05});
  return cameras;
}

}  // namespace alidade::test
