// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "camera/camera.h"
#include "view/offscreen_context.h"
#include "view/scene.h"
#include "view/viewpoint.h"

namespace alidade {

/// Draws scenes off-screen. Keeps its window and the scene's buffers, so that many pictures of one scene cost only
/// their drawing. May be used from any one thread at a time.
class Renderer {
 public:
  /// Throws DeviceError where nothing can draw here (see OffscreenContext).
  explicit Renderer(std::span<const DrawingRoute> routes = kDrawingRoutes);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// The scene that the next pictures show. Throws std::invalid_argument for a surface whose parts do not fit.
  void show(const Scene& scene);

  /// The picture from a viewpoint with labels, legend and title, CV_8UC3 (BGR); anti-aliased.
  cv::Mat render(const Viewpoint& viewpoint, cv::Size size);

  /// What the pinhole camera (its distortion is not applied) sees from its pose, without letters: exact to OpenCV's
  /// convention of pixel centres. Drawn `supersampling` times larger and averaged. CV_8UC3 (BGR).
  cv::Mat render(const Camera& camera, const Eigen::Isometry3d& T_world_camera, int supersampling = 2);

  /// Depth along the optical axis at each pixel's centre, CV_32FC1, m; 0 where there is nothing.
  cv::Mat render_depth(const Camera& camera, const Eigen::Isometry3d& T_world_camera);

 private:
  struct Stage;
  std::unique_ptr<Stage> stage_;
};

/// One picture of one scene.
cv::Mat render(const Scene& scene, const Viewpoint& viewpoint, cv::Size size);

}  // namespace alidade
