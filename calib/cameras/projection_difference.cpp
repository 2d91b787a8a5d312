// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/projection_difference.h"

#include <optional>

#include <Eigen/Cholesky>

#include "calib/bundle/projection_uncertainty.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

constexpr double kFar = 1000.0;  // times the boards' distance

struct Place {
  Eigen::Vector2d pixel;
  Eigen::Vector3d d_first;
  Eigen::Matrix2d information;  // 1/px², of both together
};

std::optional<Place> place_at(const CameraCalibration& first, const CameraCalibration& second,
                              const Eigen::Vector2d& pixel, double distance_m) {
  const auto direction = unproject(first.camera, pixel);
  const auto C = pixel_covariance(first.covariance, first.fit.bundle, first.freedom, 0, pixel, distance_m);
  const auto D = pixel_covariance(second.covariance, second.fit.bundle, second.freedom, 0, pixel, distance_m);
  if (!direction || !C || !D) return std::nullopt;
  return Place{pixel, *direction, (*C + *D).inverse()};
}

std::vector<Place> places_of(const CameraCalibration& first, const CameraCalibration& second, const Board& board,
                             int columns) {
  const double distance_m = kFar * median_distance_m(first.fit, shape_of(board), 0);
  const double step = static_cast<double>(first.camera.width) / columns;
  std::vector<Place> places;
  for (double y = 0.5 * step; y < first.camera.height; y += step) {
    for (double x = 0.5 * step; x < first.camera.width; x += step) {
      if (auto place = place_at(first, second, {x, y}, distance_m)) places.push_back(*place);
    }
  }
  return places;
}

// The rotation R_second_first of least weighted squares, by Gauss and Newton.
Eigen::Matrix3d closest_rotation(const std::vector<Place>& places, const Camera& second) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 10; ++i) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (const Place& place : places) {
      const Eigen::Vector3d d = R * place.d_first;
      const auto seen = project(second, d);
      if (!seen) continue;
      const Eigen::Matrix<double, 2, 3> J = -seen->J_pixel_point * skew(d);
      H += J.transpose() * place.information * J;
      g += J.transpose() * place.information * (seen->pixel - place.pixel);
    }
    const Eigen::Vector3d step = H.ldlt().solve(-g);
    R = exp_so3(step) * R;
    if (step.norm() < 1e-12) break;
  }
  return R;
}

}  // namespace

std::vector<ProjectionGap> compare_projections(const CameraCalibration& first, const CameraCalibration& second,
                                               const Board& board, int columns) {
  const std::vector<Place> places = places_of(first, second, board, columns);
  const Eigen::Matrix3d R_second_first = closest_rotation(places, second.camera);
  std::vector<ProjectionGap> gaps;
  for (const Place& place : places) {
    const auto seen = project(second.camera, R_second_first * place.d_first);
    if (!seen) continue;
    const Eigen::Vector2d gap = seen->pixel - place.pixel;
    gaps.push_back({place.pixel, gap, gap.dot(place.information * gap)});
  }
  return gaps;
}

}  // namespace alidade
