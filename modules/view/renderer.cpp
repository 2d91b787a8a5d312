// SPDX-License-Identifier: Apache-2.0
#include "view/renderer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <vtkCamera.h>
#include <vtkFloatArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "view/canvas.h"
#include "view/scene_actors.h"

namespace alidade {
namespace {

// Points and lines are drawn for pictures that are shrunk by this.
constexpr int kPictureSupersampling = 2;

struct DepthRange {
  double near_m = 0.1, far_m = 1.0;
};

// OpenGL's projection for a pinhole camera whose pixel (0, 0) is the centre of the top-left pixel: window x = u + ½,
// window y = height − (v + ½), and OpenGL's camera looks along −z with y up.
void set_projection(vtkCamera& view, const Camera& camera, const DepthRange& depth) {
  const double n = depth.near_m, f = depth.far_m;
  vtkNew<vtkMatrix4x4> P;
  P->Zero();
  P->SetElement(0, 0, 2.0 * camera.fx / camera.width);
  P->SetElement(0, 2, 1.0 - 2.0 * (camera.cx + 0.5) / camera.width);
  P->SetElement(1, 1, 2.0 * camera.fy / camera.height);
  P->SetElement(1, 2, 2.0 * (camera.cy + 0.5) / camera.height - 1.0);
  P->SetElement(2, 2, -(f + n) / (f - n));
  P->SetElement(2, 3, -2.0 * f * n / (f - n));
  P->SetElement(3, 2, -1.0);
  view.SetExplicitProjectionTransformMatrix(P);
  view.UseExplicitProjectionTransformMatrixOn();
  view.SetClippingRange(n, f);
}

void set_pose(vtkCamera& view, const Eigen::Isometry3d& T_stage_camera) {
  const Eigen::Vector3d eye = T_stage_camera.translation(), ahead = eye + T_stage_camera.linear().col(2);
  const Eigen::Vector3d up = -T_stage_camera.linear().col(1);
  view.SetPosition(eye.data());
  view.SetFocalPoint(ahead.data());
  view.SetViewUp(up.data());
}

// All that has a place, for the depth range and the stage's origin.
std::vector<Eigen::Vector3d> places_of(const Scene& scene) {
  std::vector<Eigen::Vector3d> places;
  for (const auto& point : scene.points) places.push_back(point.p_world);
  for (const auto& camera : scene.cameras) {
    const auto corners = pyramid_corners(camera, scene);
    places.insert(places.end(), corners.begin(), corners.end());
  }
  for (const auto& path : scene.paths) places.insert(places.end(), path.points_world.begin(), path.points_world.end());
  for (const auto& s : scene.surfaces) places.insert(places.end(), s.vertices_world.begin(), s.vertices_world.end());
  for (const auto& s : scene.translucent) places.insert(places.end(), s.vertices_world.begin(), s.vertices_world.end());
  std::erase_if(places, [](const Eigen::Vector3d& p) { return !p.allFinite(); });
  return places;
}

Eigen::Vector3d median_of(const std::vector<Eigen::Vector3d>& places) {
  Eigen::Vector3d median = Eigen::Vector3d::Zero();
  if (places.empty()) return median;
  std::vector<double> values(places.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(places, values.begin(), [axis](const Eigen::Vector3d& p) { return p[axis]; });
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[axis] = *middle;
  }
  return median;
}

// Near and far planes round all that is in front of the camera; a few wild points do not spoil the depth's resolution.
DepthRange depth_range(const std::vector<Eigen::Vector3d>& places, const Eigen::Isometry3d& T_world_camera) {
  constexpr double kWild = 20.0;     // times the depth that 90 % of the places lie below
  constexpr double kNearest = 1e-3;  // of the farthest
  const Eigen::Vector3d axis = T_world_camera.linear().col(2);
  const double at = axis.dot(T_world_camera.translation());
  std::vector<double> depths;
  for (const auto& p : places) {
    if (const double depth = axis.dot(p) - at; depth > 0) depths.push_back(depth);
  }
  if (depths.empty()) return {};
  const double nearest = std::ranges::min(depths), farthest = std::ranges::max(depths);
  const auto share = depths.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(depths.size() - 1));
  std::nth_element(depths.begin(), share, depths.end());
  const double far_m = std::min(farthest, kWild * *share) * 1.01;
  const bool some_behind = depths.size() < places.size();  // and so a triangle may pass close by the camera
  return {some_behind ? kNearest * far_m : std::max(kNearest * far_m, 0.5 * nearest), far_m};
}

void draw_letters(Canvas& canvas, const Scene& scene, const Viewpoint& viewpoint) {
  const cv::Size size = canvas.whole().size();
  const Camera camera = camera_of(viewpoint, size);
  const Eigen::Isometry3d T_camera_world = T_world_camera_of(viewpoint).inverse();
  const double em = std::clamp(size.height / 42.0, 11.0, 30.0);
  for (const auto& label : scene.labels) {
    const auto at = project(camera, T_camera_world * label.p_world);
    if (!at) continue;
    const double x = at->pixel.x(), y = at->pixel.y();
    const bool fits = x > size.width || x + 0.4 * em + text_size(label.text, {em}).width <= size.width;
    canvas.write(label.text, {fits ? x + 0.4 * em : x - 0.4 * em, y},
                 {{em}, label.colour, fits ? Anchor::Left : Anchor::Right});
  }
  double y = 1.3 * em;
  const bool dark = scene.background[0] + scene.background[1] + scene.background[2] < 384;
  const Rgb ink = dark ? Rgb{235, 235, 240} : palette::kInk;
  if (!scene.title.empty()) {
    canvas.write(scene.title, {em, y}, {{1.15 * em, true}, ink});
    y += 1.7 * em;
  }
  for (const auto& entry : scene.legend) {
    const std::vector<cv::Point2d> triangle{
        {em, y + 0.35 * em}, {1.9 * em, y + 0.35 * em}, {1.45 * em, y - 0.4 * em}, {em, y + 0.35 * em}};
    if (entry.style == PyramidStyle::Solid) canvas.fill_polygon(triangle, entry.colour);
    canvas.draw_polyline(triangle, {entry.colour, 1.5});
    canvas.write(entry.text, {2.5 * em, y}, {{em}, ink});
    y += 1.5 * em;
  }
}

}  // namespace

struct Renderer::Stage {
  explicit Stage(std::span<const DrawingRoute> routes) : context(routes) { context.window().AddRenderer(renderer); }

  // Draws, and leaves the picture in the window. The context must be current.
  DepthRange draw(const Camera& camera, const Eigen::Isometry3d& T_world_camera) {
    const DepthRange depth = depth_range(places, T_world_camera);
    Eigen::Isometry3d T_stage_camera = T_world_camera;
    T_stage_camera.translation() -= origin;
    set_pose(*renderer->GetActiveCamera(), T_stage_camera);
    set_projection(*renderer->GetActiveCamera(), camera, depth);
    context.window().SetSize(camera.width, camera.height);
    context.window().Render();
    return depth;
  }

  OffscreenContext context;
  vtkNew<vtkRenderer> renderer;
  Scene letters;  // without what is on the stage
  std::vector<Eigen::Vector3d> places;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

Renderer::Renderer(std::span<const DrawingRoute> routes) : stage_(std::make_unique<Stage>(routes)) {}

Renderer::~Renderer() = default;

void Renderer::show(const Scene& scene) {
  const OffscreenContext::Current current(stage_->context);
  stage_->places = places_of(scene);
  stage_->origin = median_of(stage_->places);
  fill_stage(*stage_->renderer, scene, stage_->origin, kPictureSupersampling);
  stage_->renderer->SetBackground(scene.background[0] / 255.0, scene.background[1] / 255.0,
                                  scene.background[2] / 255.0);
  stage_->letters = {};
  stage_->letters.labels = scene.labels;
  stage_->letters.legend = scene.legend;
  stage_->letters.title = scene.title;
  stage_->letters.background = scene.background;
}

cv::Mat Renderer::render(const Viewpoint& viewpoint, cv::Size size) {
  const cv::Mat picture = render(camera_of(viewpoint, size), T_world_camera_of(viewpoint), kPictureSupersampling);
  Canvas canvas(picture);
  draw_letters(canvas, stage_->letters, viewpoint);
  return canvas.picture();
}

cv::Mat Renderer::render(const Camera& camera, const Eigen::Isometry3d& T_world_camera, int supersampling) {
  if (supersampling < 1) throw std::invalid_argument("Renderer::render: supersampling must be >= 1");
  if (const auto fault = find_fault(camera)) throw std::invalid_argument("Renderer::render: " + *fault);
  const OffscreenContext::Current current(stage_->context);
  const Camera large = resized(camera, supersampling);
  stage_->draw(large, T_world_camera);
  vtkNew<vtkUnsignedCharArray> pixels;
  stage_->context.window().GetPixelData(0, 0, large.width - 1, large.height - 1, 0, pixels);
  const cv::Mat rgb(large.height, large.width, CV_8UC3, pixels->GetPointer(0));
  cv::Mat small = rgb, picture;
  if (supersampling > 1) cv::resize(rgb, small, {camera.width, camera.height}, 0, 0, cv::INTER_AREA);
  cv::cvtColor(small, picture, cv::COLOR_RGB2BGR);
  cv::flip(picture, picture, 0);  // OpenGL's rows run upwards
  return picture;
}

cv::Mat Renderer::render_depth(const Camera& camera, const Eigen::Isometry3d& T_world_camera) {
  if (const auto fault = find_fault(camera)) throw std::invalid_argument("Renderer::render_depth: " + *fault);
  const OffscreenContext::Current current(stage_->context);
  const auto [n, f] = stage_->draw(camera, T_world_camera);
  vtkNew<vtkFloatArray> buffer;
  stage_->context.window().GetZbufferData(0, 0, camera.width - 1, camera.height - 1, buffer);
  cv::Mat depth(camera.height, camera.width, CV_32FC1, buffer->GetPointer(0));
  cv::Mat metres(depth.size(), CV_32FC1);
  for (int y = 0; y < depth.rows; ++y) {
    const float* from = depth.ptr<float>(depth.rows - 1 - y);
    float* to = metres.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      const double z = 2.0 * from[x] - 1.0;
      to[x] = from[x] >= 1.0F ? 0.0F : static_cast<float>(2.0 * f * n / (f + n - z * (f - n)));
    }
  }
  return metres;
}

cv::Mat render(const Scene& scene, const Viewpoint& viewpoint, cv::Size size) {
  Renderer renderer;
  renderer.show(scene);
  return renderer.render(viewpoint, size);
}

}  // namespace alidade
