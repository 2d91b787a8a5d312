// SPDX-License-Identifier: Apache-2.0
#include "tracking/map_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <opencv2/core/hal/hal.hpp>

#include "geometry/rotation.h"

namespace alidade {
namespace {

std::vector<int> features_in_ellipse(const FeatureGrid& grid, const Features& features, const ExpectedPixel& expected,
                                     const std::vector<bool>& taken, const SearchOptions& options) {
  const double spread = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(expected.S).eigenvalues()(1));
  const double radius = std::clamp(options.gate_sigmas * spread, options.least_radius_px, options.most_radius_px);
  const Eigen::Matrix2d S_inverse = expected.S.inverse();
  std::vector<int> inside = grid.within(expected.pixel, radius);
  std::erase_if(inside, [&](int i) {
    if (taken[static_cast<std::size_t>(i)]) return true;
    const Eigen::Vector2d off = features.pixels[static_cast<std::size_t>(i)] - expected.pixel;
    return off.norm() > options.least_radius_px && off.dot(S_inverse * off) > options.gate_sigmas * options.gate_sigmas;
  });
  return inside;
}

std::array<float, 128> as_floats(const Descriptor& descriptor) {
  std::array<float, 128> row;
  std::copy(descriptor.begin(), descriptor.end(), row.begin());
  return row;
}

}  // namespace

std::optional<ExpectedPixel> expect(const Camera& camera, const PoseBelief& belief, const MapPoint& point,
                                    double sigma_px) {
  const Eigen::Vector3d p_camera = belief.T_world_camera.inverse() * point.p_world;
  const auto projection = project(camera, p_camera);
  if (!projection || !is_inside(camera, projection->pixel)) return std::nullopt;
  Eigen::Matrix<double, 2, 6> J;
  J << -projection->J_pixel_point, projection->J_pixel_point * skew(p_camera);
  const Eigen::Matrix<double, 2, 3> J_X = projection->J_pixel_point * belief.T_world_camera.linear().transpose();
  ExpectedPixel expected;
  expected.pixel = projection->pixel;
  expected.S = sigma_px * sigma_px * Eigen::Matrix2d::Identity() + J * belief.covariance * J.transpose() +
               J_X * point.covariance_world * J_X.transpose();
  return expected;
}

std::vector<FoundPoint> search_points(const Camera& camera, const PointMap& map, const std::vector<int>& candidates,
                                      const PoseBelief& belief, const Features& features,
                                      const std::vector<bool>& taken, const SearchOptions& options) {
  const FeatureGrid grid(features, 16.0);
  std::vector<FoundPoint> found;
  std::vector<int> finder(static_cast<std::size_t>(features.size()), -1);  // index into found
  std::vector<float> distance(finder.size(), std::numeric_limits<float>::max());
  for (int i : candidates) {
    const MapPoint& point = map.points[static_cast<std::size_t>(i)];
    const auto expected = expect(camera, belief, point, options.sigma_px);
    if (!expected) continue;
    const std::array<float, 128> row = as_floats(point.descriptor);
    const auto inside = features_in_ellipse(grid, features, *expected, taken, options);
    const auto feature = best_candidate(features, inside, row.data(), options.descriptor);
    if (!feature) continue;
    const auto f = static_cast<std::size_t>(*feature);
    const float d = cv::hal::normL2Sqr_(features.descriptors.ptr<float>(*feature), row.data(), 128);
    if (d >= distance[f]) continue;
    distance[f] = d;
    if (finder[f] < 0) {
      finder[f] = static_cast<int>(found.size());
      found.emplace_back();
    }
    found[static_cast<std::size_t>(finder[f])] = {i, *feature, features.pixels[f]};
  }
  return found;
}

std::vector<FoundPoint> match_points(const PointMap& map, const std::vector<int>& candidates, const Features& features,
                                     double ratio) {
  std::vector<const Descriptor*> descriptors;
  for (int i : candidates) descriptors.push_back(&map.points[static_cast<std::size_t>(i)].descriptor);
  std::vector<FoundPoint> found;
  for (const Match& m : match_descriptors(features.descriptors, descriptor_rows(descriptors), ratio)) {
    found.push_back({candidates[static_cast<std::size_t>(m.b)], m.a, features.pixels[static_cast<std::size_t>(m.a)]});
  }
  return found;
}

PointObservation as_observation(const MapPoint& point, const Eigen::Vector2d& pixel, double sigma_px) {
  PointObservation observation;
  observation.pixel = pixel;
  observation.sigma_px = sigma_px;
  observation.p_world = point.p_world;
  observation.covariance_world = point.covariance_world;
  return observation;
}

std::vector<PointObservation> as_observations(const PointMap& map, const std::vector<FoundPoint>& found,
                                              double sigma_px) {
  std::vector<PointObservation> observations;
  observations.reserve(found.size());
  for (const FoundPoint& f : found) {
    const MapPoint& point = map.points[static_cast<std::size_t>(f.point)];
    observations.push_back(as_observation(point, f.pixel, sigma_px));
  }
  return observations;
}

}  // namespace alidade
