// SPDX-License-Identifier: Apache-2.0
#include "datasets/textured_mesh.h"

#include <cmath>

#include <gtest/gtest.h>

namespace alidade {
namespace {

LeafTextureOptions coarse() {
  LeafTextureOptions options;
  options.texel_m = 0.02;
  return options;
}

void expect_sound(const TexturedSurface& s) {
  ASSERT_EQ(s.vertices_world.size(), s.texture_uv.size());
  for (const auto& uv : s.texture_uv) EXPECT_TRUE(uv.minCoeff() >= 0 && uv.maxCoeff() <= 1) << uv.transpose();
  for (const auto& t : s.triangles) {
    EXPECT_GE(t.minCoeff(), 0);
    EXPECT_LT(t.maxCoeff(), static_cast<int>(s.vertices_world.size()));
  }
}

double area(const TexturedSurface& s) {
  double sum = 0;
  for (const auto& t : s.triangles) {
    const auto &a = s.vertices_world[std::size_t(t[0])], &b = s.vertices_world[std::size_t(t[1])],
               &c = s.vertices_world[std::size_t(t[2])];
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

TEST(MakeRelief, RisesTowardsTheViewer) {
  // A wall seen along +y: across is +x, down is -z, so the viewer is at -y.
  const Panel wall{{0, 0, 2}, {3, 0, 0}, {0, 0, -2}};
  const auto surface = make_relief(
      wall, [](double u, double) { return u; }, {6, 4}, coarse());
  expect_sound(surface);
  EXPECT_EQ(surface.vertices_world.size(), 7u * 5u);
  EXPECT_TRUE(surface.vertices_world.front().isApprox(Eigen::Vector3d(0, 0, 2)));
  EXPECT_TRUE(surface.vertices_world.back().isApprox(Eigen::Vector3d(3, -1, 0)));
  EXPECT_EQ(surface.texture.size(), cv::Size(150, 100));
}

TEST(MakeBox, HasTheAreaAndExtentOfABox) {
  const Eigen::Isometry3d T =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 2).normalized());
  const Eigen::Vector3d size(0.2, 0.5, 0.3);
  const auto box = make_box(T, size, coarse());
  expect_sound(box);
  EXPECT_NEAR(area(box), 2 * (0.2 * 0.5 + 0.5 * 0.3 + 0.3 * 0.2), 1e-12);
  for (const auto& v : box.vertices_world) EXPECT_TRUE((T.inverse() * v).cwiseAbs().isApprox(size / 2, 1e-12));
}

TEST(MakeBox, TextureHasItsTrueScaleOnEveryFace) {
  LeafTextureOptions options = coarse();
  const auto box = make_box(Eigen::Isometry3d::Identity(), {0.2, 0.5, 0.3}, options);
  for (const auto& t : box.triangles) {
    const auto a = std::size_t(t[0]), b = std::size_t(t[1]);
    const Eigen::Vector2d texels =
        (box.texture_uv[b] - box.texture_uv[a]).cwiseProduct(Eigen::Vector2d(box.texture.cols, box.texture.rows));
    EXPECT_NEAR(texels.norm() * options.texel_m, (box.vertices_world[b] - box.vertices_world[a]).norm(), 0.03);
  }
}

TEST(MakeBall, IsRound) {
  const Eigen::Vector3d centre(1, -1, 0.5);
  const auto ball = make_ball(centre, 0.2, coarse());
  expect_sound(ball);
  for (const auto& v : ball.vertices_world) EXPECT_NEAR((v - centre).norm(), 0.2, 1e-12);
  EXPECT_NEAR(area(ball), 4 * 3.14159 * 0.04, 0.01);
}

}  // namespace
}  // namespace alidade
