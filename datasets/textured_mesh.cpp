// SPDX-License-Identifier: Apache-2.0
#include "datasets/textured_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace alidade {
namespace {

// Two triangles for each cell of a grid of (cells.x + 1) × (cells.y + 1) vertices, row by row.
void add_grid_triangles(TexturedSurface& surface, const Eigen::Vector2i& cells) {
  const int stride = cells.x() + 1;
  for (int y = 0; y < cells.y(); ++y) {
    for (int x = 0; x < cells.x(); ++x) {
      const int a = y * stride + x;
      surface.triangles.emplace_back(a, a + 1, a + stride + 1);
      surface.triangles.emplace_back(a, a + stride + 1, a + stride);
    }
  }
}

Eigen::Vector2d grid_uv(int x, int y, const Eigen::Vector2i& cells) {
  return {static_cast<double>(x) / cells.x(), static_cast<double>(y) / cells.y()};
}

}  // namespace

TexturedSurface make_relief(const Panel& panel, const std::function<double(double, double)>& height_m,
                            const Eigen::Vector2i& cells, LeafTextureOptions texture) {
  texture.size_m = {panel.across_world.norm(), panel.down_world.norm()};
  const Eigen::Vector3d to_viewer = -panel.across_world.cross(panel.down_world).normalized();
  TexturedSurface surface;
  for (int y = 0; y <= cells.y(); ++y) {
    for (int x = 0; x <= cells.x(); ++x) {
      const Eigen::Vector2d uv = grid_uv(x, y, cells);
      surface.texture_uv.push_back(uv);
      surface.vertices_world.emplace_back(panel.corner_world + uv.x() * panel.across_world + uv.y() * panel.down_world +
                                          height_m(uv.x(), uv.y()) * to_viewer);
    }
  }
  add_grid_triangles(surface, cells);
  surface.texture = leaf_texture(texture);
  return surface;
}

TexturedSurface make_poster(const Panel& panel, const cv::Mat& picture) {
  TexturedSurface surface;
  const auto& [corner, across, down] = panel;
  surface.vertices_world = {corner, corner + across, corner + across + down, corner + down};
  surface.texture_uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  surface.texture = picture;
  return surface;
}

TexturedSurface make_box(const Eigen::Isometry3d& T_world_box, const Eigen::Vector3d& size_m,
                         LeafTextureOptions texture) {
  constexpr std::array<double, 6> kShades{0.82, 0.68, 0.9, 0.75, 1.0, 0.55};  // ±x, ±y, ±z
  const double cell = size_m.maxCoeff() * 1.05;
  texture.size_m = {3 * cell, 2 * cell};  // six faces out of one picture, each from its own place
  TexturedSurface box;
  box.texture = leaf_texture(texture);
  for (int face = 0; face < 6; ++face) {
    const int normal = face / 2, a = (normal + 1) % 3, b = (normal + 2) % 3;
    const Eigen::Vector2d origin(face % 3 / 3.0, face / 3 / 2.0);
    const cv::Rect place(box.texture.cols * (face % 3) / 3, box.texture.rows * (face / 3) / 2, box.texture.cols / 3,
                         box.texture.rows / 2);
    cv::Mat part = box.texture(place);
    part.convertTo(part, -1, kShades[static_cast<std::size_t>(face)]);
    const int first = static_cast<int>(box.vertices_world.size());
    for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      Eigen::Vector3d p;
      p[normal] = face % 2 == 0 ? 0.5 : -0.5;
      p[a] = u - 0.5;
      p[b] = v - 0.5;
      box.vertices_world.emplace_back(T_world_box * Eigen::Vector3d(p.cwiseProduct(size_m)));
      const Eigen::Vector2d at_m(u * size_m[a] + 0.02 * cell, v * size_m[b] + 0.02 * cell);
      box.texture_uv.emplace_back(origin + at_m.cwiseQuotient(texture.size_m));
    }
    box.triangles.emplace_back(first, first + 1, first + 2);
    box.triangles.emplace_back(first, first + 2, first + 3);
  }
  return box;
}

TexturedSurface make_ball(const Eigen::Vector3d& centre_world, double radius_m, LeafTextureOptions texture) {
  const Eigen::Vector2i cells(48, 24);
  texture.size_m = {2 * std::numbers::pi * radius_m, std::numbers::pi * radius_m};
  TexturedSurface ball;
  for (int y = 0; y <= cells.y(); ++y) {
    for (int x = 0; x <= cells.x(); ++x) {
      const Eigen::Vector2d uv = grid_uv(x, y, cells);
      const double round = 2 * std::numbers::pi * uv.x(), from_pole = std::numbers::pi * uv.y();
      ball.texture_uv.push_back(uv);
      ball.vertices_world.emplace_back(centre_world + radius_m * Eigen::Vector3d(std::sin(from_pole) * std::cos(round),
                                                                                 std::sin(from_pole) * std::sin(round),
                                                                                 std::cos(from_pole)));
    }
  }
  add_grid_triangles(ball, cells);
  ball.texture = leaf_texture(texture);
  return ball;
}

}  // namespace alidade
