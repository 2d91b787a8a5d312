// SPDX-License-Identifier: Apache-2.0
#include "tracking/posed_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/LU>

#include "camera/rolling_shutter.h"
#include "reconstruction/epipolar_matching.h"

namespace alidade {
namespace {

// Depth at a pixel in m; empty where it is unknown, too far, or differs from its neighbours': an edge.
std::optional<double> depth_at(const PosedImage& image, const Eigen::Vector2d& pixel, const PosedMapOptions& options) {
  const int x = static_cast<int>(std::lround(pixel.x()));
  const int y = static_cast<int>(std::lround(pixel.y()));
  if (x < 2 || y < 2 || x >= image.depth.cols - 2 || y >= image.depth.rows - 2) return std::nullopt;
  double nearest = 1e9, farthest = 0, sum = 0;
  int count = 0;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const double z = image.depth.at<std::uint16_t>(y + dy, x + dx) * image.depth_unit_m;
      if (!(z > 0)) continue;
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
      if (std::max(std::abs(dx), std::abs(dy)) > 1) continue;
      sum += z;
      ++count;
    }
  }
  if (count < 5 || farthest > options.most_depth_m) return std::nullopt;
  if (farthest - nearest > options.most_depth_step_share * nearest) return std::nullopt;
  return sum / count;
}

// The point behind a pixel at a depth, with the depth's noise along the ray, the pixel's and the pose's across it.
MapPoint lift(const Camera& camera, const PosedImage& image, const Eigen::Vector3d& d_camera, double z,
              const PosedMapOptions& options) {
  const Eigen::Vector3d p_camera = d_camera * (z / d_camera.z());
  const double along = options.depth_sigma_at_1m * z * z;
  const double across = std::hypot(z * options.growth.sigma_px / camera.fx, z * options.pose_sigma_rad);
  const Eigen::Matrix3d dd = d_camera * d_camera.transpose();
  const Eigen::Matrix3d C = along * along * dd + across * across * (Eigen::Matrix3d::Identity() - dd) +
                            options.pose_sigma_m * options.pose_sigma_m * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d& R = image.T_world_camera.linear();
  MapPoint point;
  point.p_world = image.T_world_camera * p_camera;
  point.covariance_world = R * C * R.transpose();
  return point;
}

// Two independent estimates of one point, if they agree (99 %, 3 degrees of freedom).
std::optional<MapPoint> fuse(const MapPoint& known, const MapPoint& seen) {
  const Eigen::Vector3d off = seen.p_world - known.p_world;
  if (off.dot((known.covariance_world + seen.covariance_world).inverse() * off) > 11.3) return std::nullopt;
  MapPoint fused = known;
  const Eigen::Matrix3d gain = known.covariance_world * (known.covariance_world + seen.covariance_world).inverse();
  fused.p_world += gain * off;
  fused.covariance_world = (Eigen::Matrix3d::Identity() - gain) * known.covariance_world;
  return fused;
}

using Depths = std::vector<std::optional<double>>;  // per feature, m

// Where a pixel of the image is in the depth image, which was taken a little later: the camera's turning alone.
std::optional<Eigen::Vector2d> pixel_in_depth(const Camera& camera, const PosedImage& image,
                                              const Eigen::Vector2d& pixel) {
  if (image.depth_delay_s == 0.0) return pixel;
  const auto d = unproject(camera, pixel);
  if (!d) return std::nullopt;
  const auto later = project(camera, perturbation(image.depth_delay_s * image.twist).linear().transpose() * *d);
  return later ? std::optional(later->pixel) : std::nullopt;
}

// The features as all rows exposed at once would show them.
Features without_rolling_shutter(const Camera& camera, Features features, const Vector6d& twist, const Depths& depths) {
  for (std::size_t f = 0; f < depths.size(); ++f) {
    features.pixels[f] =
        at_middle_row(camera, features.pixels[f], twist, depths[f].value_or(std::numeric_limits<double>::infinity()));
  }
  return features;
}

LiveMap with_depth(const Camera& camera, LiveMap live, const PosedImage& image, const Depths& depths,
                   const PosedMapOptions& options) {
  const std::size_t last = live.map.keyframes.size() - 1;
  KeyframeFeatures& frame = live.features[last];
  const cv::Mat& colours = image.frame.colour.empty() ? image.frame.grey : image.frame.colour;
  for (int f = 0; f < frame.features.size(); ++f) {
    const Eigen::Vector2d& pixel = frame.features.pixels[static_cast<std::size_t>(f)];
    const auto d_camera = unproject(camera, pixel);
    const auto z = depths[static_cast<std::size_t>(f)];
    if (!d_camera || !z) continue;
    MapPoint seen = lift(camera, image, *d_camera, *z, options);
    int& point = frame.point_of_feature[static_cast<std::size_t>(f)];
    if (point >= 0) {
      MapPoint& known = live.map.points[static_cast<std::size_t>(point)];
      if (const auto fused = fuse(known, seen)) known = *fused;
      continue;
    }
    seen.rgb = colour_at(colours, pixel);
    seen.descriptor = descriptor_bytes(frame.features, f);
    live.map.points.push_back(seen);
    point = static_cast<int>(live.map.points.size()) - 1;
    live.map.keyframes[last].sightings.push_back({point, pixel, options.growth.sigma_px});
  }
  return live;
}

std::vector<Match> match_free_features(const Camera& camera, const LiveMap& pair, const GrowthOptions& options) {
  std::array<std::vector<int>, 2> free;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<int>& point_of_feature = pair.features[i].point_of_feature;
    for (std::size_t f = 0; f < point_of_feature.size(); ++f) {
      if (point_of_feature[f] < 0) free[i].push_back(static_cast<int>(f));
    }
  }
  EpipolarOptions epipolar;
  epipolar.ratio = options.ratio;
  return match_along_epipolar_lines(camera, {pair.features[0].features, free[0], pair.map.keyframes[0].T_world_camera},
                                    {pair.features[1].features, free[1], pair.map.keyframes[1].T_world_camera},
                                    epipolar);
}

// New points of the last image and the few just before it, where no known points tell which of the images overlap.
LiveMap with_points_of_recent_images(const Camera& camera, LiveMap live, const cv::Mat& image,
                                     const GrowthOptions& options) {
  const std::size_t last = live.map.keyframes.size() - 1;
  const std::size_t first = last - std::min(last, static_cast<std::size_t>(options.neighbours));
  for (std::size_t k = last; k-- > first;) {
    LiveMap pair;  // all points, two of the keyframes
    pair.map.points = std::move(live.map.points);
    for (const std::size_t i : {k, last}) {
      pair.map.keyframes.push_back(std::move(live.map.keyframes[i]));
      pair.features.push_back(std::move(live.features[i]));
    }
    const std::vector<Match> matches = match_free_features(camera, pair, options);
    pair = with_points_of_pair(camera, std::move(pair), matches, image, options);
    live.map.points = std::move(pair.map.points);
    for (const auto& [from, to] : {std::pair<std::size_t, std::size_t>{0, k}, {1, last}}) {
      live.map.keyframes[to] = std::move(pair.map.keyframes[from]);
      live.features[to] = std::move(pair.features[from]);
    }
  }
  return live;
}

}  // namespace

LiveMap with_posed_image(const Camera& camera, LiveMap live, const PosedImage& image, const PosedMapOptions& options) {
  NewKeyframe added;
  added.features = detect_sift(image.frame.grey, options.sift);
  Depths depths;
  for (const Eigen::Vector2d& pixel : added.features.pixels) {
    const auto in_depth = pixel_in_depth(camera, image, pixel);
    depths.push_back(in_depth ? depth_at(image, *in_depth, options) : std::nullopt);
  }
  added.features = without_rolling_shutter(camera, std::move(added.features), image.twist, depths);
  Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(options.pose_sigma_m), Eigen::Vector3d::Constant(options.pose_sigma_rad);
  const Matrix6d covariance = sigmas.cwiseAbs2().asDiagonal();
  std::vector<int> all(live.map.points.size());
  std::iota(all.begin(), all.end(), 0);
  SearchOptions search;
  search.most_radius_px = 8.0;
  added.found = search_points(camera, live.map, all, {image.T_world_camera, covariance}, added.features,
                              std::vector<bool>(static_cast<std::size_t>(added.features.size()), false), search);
  added.keyframe = {image.frame.index, image.frame.time, image.frame.name, image.T_world_camera, covariance, {}};
  live = with_keyframe(std::move(live), std::move(added), options.growth.sigma_px);
  if (!image.depth.empty()) return with_depth(camera, std::move(live), image, depths, options);
  live = with_retriangulated_points(camera, std::move(live));
  const cv::Mat& colours = image.frame.colour.empty() ? image.frame.grey : image.frame.colour;
  constexpr std::size_t kEnough = 16;  // shared points from which map growth takes a keyframe for a neighbour
  if (live.map.keyframes.back().sightings.size() < kEnough) {
    return with_points_of_recent_images(camera, std::move(live), colours, options.growth);
  }
  return with_new_points(camera, std::move(live), colours, options.growth);
}

}  // namespace alidade
