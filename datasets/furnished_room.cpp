// SPDX-License-Identifier: Apache-2.0
#include "datasets/furnished_room.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "datasets/textured_mesh.h"

namespace alidade {
namespace {

constexpr double kHalfLength_m = 3.0, kHalfWidth_m = 2.5, kHeight_m = 2.8;

// BGR: plaster, ochre, slate, brick, moss, sand, dusk, walnut.
const std::array<cv::Vec3d, 8> kTones{{{165, 180, 190},
                                       {90, 145, 180},
                                       {170, 140, 115},
                                       {95, 105, 170},
                                       {115, 160, 130},
                                       {140, 175, 200},
                                       {165, 130, 150},
                                       {85, 115, 150}}};

// Hands out the next texture: its own figures for every surface.
class Textures {
 public:
  explicit Textures(const RoomOptions& options) : options_(options) {}

  LeafTextureOptions coarse() { return next(2.3, 0.3, 0.012); }  // walls and cupboards
  LeafTextureOptions fine() { return next(1.0, 0.08, 0.005); }   // the table and what stands on it

 private:
  LeafTextureOptions next(double coarseness, double largest_m, double smallest_m) {
    LeafTextureOptions texture;
    texture.texel_m = options_.finest_texel_m * coarseness;
    texture.largest_m = largest_m;
    texture.smallest_m = smallest_m;
    texture.seed = options_.seed * 1000 + ++count_;
    texture.tone = kTones[count_ % kTones.size()];
    return texture;
  }

  RoomOptions options_;
  std::uint64_t count_ = 0;
};

// Smooth bumps of up to `most_m` towards the inside, none at the rim, so that neighbouring panels meet.
std::function<double(double, double)> bumps(double most_m, cv::RNG& random) {
  struct Wave {
    double fu, fv, phase;
  };
  std::vector<Wave> waves;
  for (int i = 0; i < 5; ++i) {
    waves.push_back({random.uniform(1.0, 4.0), random.uniform(1.0, 3.0), random.uniform(0.0, 2 * std::numbers::pi)});
  }
  return [waves, most_m](double u, double v) {
    double sum = 0;
    for (const auto& w : waves) sum += std::sin(2 * std::numbers::pi * (w.fu * u + w.fv * v) + w.phase);
    const double rim = std::min(1.0, 16 * u * (1 - u)) * std::min(1.0, 16 * v * (1 - v));
    return most_m * rim * (0.5 + 0.5 * sum / static_cast<double>(waves.size()));
  };
}

void add_shell(Scene& scene, Textures& textures, cv::RNG& random) {
  const double x = kHalfLength_m, y = kHalfWidth_m, h = kHeight_m;
  const auto add = [&](const Panel& panel, double relief_m) {
    scene.surfaces.push_back(make_relief(panel, bumps(relief_m, random), {48, 24}, textures.coarse()));
  };
  add({{-x, y, h}, {2 * x, 0, 0}, {0, 0, -h}}, 0.3);   // behind the table
  add({{x, -y, h}, {-2 * x, 0, 0}, {0, 0, -h}}, 0.3);  // opposite
  add({{x, y, h}, {0, -2 * y, 0}, {0, 0, -h}}, 0.3);
  add({{-x, -y, h}, {0, 2 * y, 0}, {0, 0, -h}}, 0.3);
  add({{-x, y, 0}, {2 * x, 0, 0}, {0, -2 * y, 0}}, 0.05);  // floor
  add({{-x, -y, h}, {2 * x, 0, 0}, {0, 2 * y, 0}}, 0.15);  // ceiling
}

Eigen::Isometry3d upright(double x, double y, double z, double turn_rad) {
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ());
}

void add_cupboards(Scene& scene, Textures& textures) {
  const auto add = [&](double x, double y, const Eigen::Vector3d& size, double turn) {
    scene.surfaces.push_back(make_box(upright(x, y, size.z() / 2, turn), size, textures.coarse()));
  };
  add(-2.4, 2.1, {0.9, 0.5, 1.5}, 0.1);
  add(1.9, 2.15, {1.2, 0.4, 0.9}, -0.08);
  add(2.6, -1.9, {0.5, 0.7, 1.2}, 0.3);
  add(-2.6, -2.0, {0.5, 0.6, 1.8}, -0.2);
  add(2.7, 0.6, {0.4, 0.9, 0.6}, 0.0);
}

void add_table(Scene& scene, Textures& textures) {
  constexpr double kThickness = 0.05;
  const auto box = [&](const Eigen::Isometry3d& T, const Eigen::Vector3d& size) {
    scene.surfaces.push_back(make_box(T, size, textures.fine()));
  };
  box(upright(0, 0, kTableTop_m - kThickness / 2, 0), {2 * kTableHalfWidth_m, 2 * kTableHalfDepth_m, kThickness});
  box(upright(0, 0, (kTableTop_m - kThickness) / 2, 0.785), {0.45, 0.45, kTableTop_m - kThickness});  // its foot
}

void add_things_on_table(Scene& scene, Textures& textures) {
  const auto box = [&](double x, double y, const Eigen::Vector3d& size, double turn) {
    scene.surfaces.push_back(make_box(upright(x, y, kTableTop_m + size.z() / 2, turn), size, textures.fine()));
  };
  box(-0.5, 0.2, {0.22, 0.16, 0.34}, 0.4);
  box(-0.15, 0.28, {0.3, 0.12, 0.2}, -0.15);
  box(0.45, 0.22, {0.18, 0.18, 0.42}, 0.7);
  box(0.6, -0.15, {0.26, 0.2, 0.1}, -0.5);
  box(-0.62, -0.12, {0.2, 0.24, 0.08}, 0.25);
  box(0.1, 0.05, {0.14, 0.14, 0.14}, 0.9);
  const auto ball = [&](double x, double y, double radius) {
    scene.surfaces.push_back(make_ball({x, y, kTableTop_m + radius}, radius, textures.fine()));
  };
  ball(-0.3, 0.0, 0.1);
  ball(0.3, -0.05, 0.075);
  ball(0.2, 0.32, 0.13);
}

}  // namespace

Scene make_furnished_room(const RoomOptions& options) {
  Scene scene;
  Textures textures(options);
  cv::RNG random(options.seed + 77);
  add_shell(scene, textures, random);
  add_cupboards(scene, textures);
  add_table(scene, textures);
  add_things_on_table(scene, textures);
  return scene;
}

TexturedSurface make_marker(const Eigen::Isometry3d& T_world_marker, double side_m) {
  // 6 × 6 bits and a black border; a rim so wide that detectors do not take the rim's outline for the marker's.
  constexpr int kModules = 8, kRim = 2, kModule_px = 32;
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11);
  cv::Mat marker, picture;
  cv::aruco::drawMarker(dictionary, 0, kModules * kModule_px, marker, 1);
  const int rim = kRim * kModule_px;
  cv::copyMakeBorder(marker, picture, rim, rim, rim, rim, cv::BORDER_CONSTANT, cv::Scalar(235));
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  const double side = side_m * (kModules + 2 * kRim) / kModules;
  const Eigen::Matrix3d R = T_world_marker.linear();
  return make_poster({T_world_marker * Eigen::Vector3d(-side / 2, side / 2, 0), R.col(0) * side, -R.col(1) * side},
                     picture);
}

}  // namespace alidade
