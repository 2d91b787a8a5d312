// SPDX-License-Identifier: Apache-2.0
#include "tracking/sighting_alignment.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace alidade {
namespace {

using AlignedPixels = std::vector<std::optional<Eigen::Vector2d>>;  // per view; empty: stays as it is

const Keyframe& keyframe_of(const LiveMap& live, const PointView& view) {
  return live.map.keyframes[static_cast<std::size_t>(view.keyframe)];
}

const cv::Mat& image_of(const LiveMap& live, const PointView& view) {
  return live.features[static_cast<std::size_t>(view.keyframe)].grey;
}

const Eigen::Vector2d& pixel_of(const LiveMap& live, const PointView& view) {
  return keyframe_of(live, view).sightings[static_cast<std::size_t>(view.sighting)].pixel;
}

Eigen::Vector3d direction_to(const LiveMap& live, const PointView& view, const Eigen::Vector3d& p_world) {
  return (keyframe_of(live, view).T_world_camera.translation() - p_world).normalized();
}

// ∂ pixel / ∂ (a, b) of the points p_world + tangents (a, b)ᵀ.
std::optional<Eigen::Matrix2d> pixels_per_metre(const Camera& camera, const Keyframe& keyframe,
                                                const Eigen::Vector3d& p_world,
                                                const Eigen::Matrix<double, 3, 2>& tangents) {
  const auto projection = project(camera, keyframe.T_world_camera.inverse() * p_world);
  if (!projection) return std::nullopt;
  return projection->J_pixel_point * keyframe.T_world_camera.linear().transpose() * tangents;
}

AlignedPixels align_views(const Camera& camera, const LiveMap& live, const Eigen::Vector3d& p_world,
                          const std::vector<PointView>& views, const PatchAlignmentOptions& options) {
  AlignedPixels pixels(views.size());
  if (views.size() < 2) return pixels;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const PointView& view : views) middle += direction_to(live, view, p_world);
  middle.normalize();
  const auto reference = std::max_element(views.begin(), views.end(), [&](const PointView& a, const PointView& b) {
    return direction_to(live, a, p_world).dot(middle) < direction_to(live, b, p_world).dot(middle);
  });
  // The surface is taken to face the middle of the views; the alignment finds how it is really tilted.
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = middle.unitOrthogonal();
  tangents.col(1) = middle.cross(tangents.col(0));
  const auto in_reference = pixels_per_metre(camera, keyframe_of(live, *reference), p_world, tangents);
  if (!in_reference) return pixels;
  bool any = false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (&views[i] == &*reference) continue;
    const auto in_view = pixels_per_metre(camera, keyframe_of(live, views[i]), p_world, tangents);
    if (!in_view) continue;
    const auto patch = align_patch(image_of(live, *reference), pixel_of(live, *reference), image_of(live, views[i]),
                                   pixel_of(live, views[i]), *in_view * in_reference->inverse(), options);
    if (!patch) continue;
    pixels[i] = patch->pixel;
    any = true;
  }
  if (any) pixels[static_cast<std::size_t>(reference - views.begin())] = pixel_of(live, *reference);
  return pixels;
}

}  // namespace

SightingAlignment align_sightings(const Camera& camera, LiveMap live, const SightingAlignmentOptions& options) {
  const auto views = index_views(live.map);
  std::vector<AlignedPixels> pixels(views.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(views.size())), [&](const cv::Range& range) {
    for (auto i = static_cast<std::size_t>(range.start); i < static_cast<std::size_t>(range.end); ++i) {
      pixels[i] = align_views(camera, live, live.map.points[i].p_world, views[i], options.patch);
    }
  });
  SightingAlignment alignment;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t v = 0; v < views[i].size(); ++v) {
      if (!pixels[i][v]) continue;
      Keyframe& keyframe = live.map.keyframes[static_cast<std::size_t>(views[i][v].keyframe)];
      Sighting& sighting = keyframe.sightings[static_cast<std::size_t>(views[i][v].sighting)];
      sighting.pixel = *pixels[i][v];
      sighting.sigma_px *= options.sigma_share;
      ++alignment.aligned;
    }
  }
  alignment.live = std::move(live);
  return alignment;
}

}  // namespace alidade
