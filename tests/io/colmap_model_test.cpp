// SPDX-License-Identifier: Apache-2.0
#include "io/colmap_model.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "io/text_lines.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

const Camera kCamera{640, 480, 500, 510, 319.5, 239.5, BrownConrady{0.1, -0.02, 0.001, 0.002, 0}};

// Three keyframes look at a grid of points, one of which nobody sees; the last keyframe sees nothing.
PointMap some_map() {
  PointMap map;
  for (int i = 0; i < 20; ++i) {
    MapPoint& point = map.points.emplace_back();
    point.p_world = {0.3 * (i % 5) - 0.6, 0.3 * (i / 5) - 0.45, 4.0 + 0.1 * i};
    point.rgb = {static_cast<std::uint8_t>(10 * i), 20, 30};
  }
  for (int k = 0; k < 3; ++k) {
    Keyframe& keyframe = map.keyframes.emplace_back();
    keyframe.frame = k;
    keyframe.time = Timestamp(std::chrono::seconds(k));
    keyframe.image = "image " + std::to_string(k) + ".jpg";
    keyframe.T_world_camera.linear() = exp_so3(Eigen::Vector3d(0.02, -0.05, 0.1) * k);
    keyframe.T_world_camera.translation() = Eigen::Vector3d(0.2 * k, -0.1 * k, 0.05 * k);
    if (k == 2) break;
    for (int i = 1; i < 20; ++i) {
      const auto projection =
          project(kCamera, keyframe.T_world_camera.inverse() * map.points[static_cast<std::size_t>(i)].p_world);
      keyframe.sightings.push_back({i, projection.value().pixel + Eigen::Vector2d(0.3, 0.4), 1.0});
    }
    keyframe.sightings.push_back({-1, {5, 6}, 1.0});
  }
  return map;
}

class ColmapFolder : public testing::Test {
 protected:
  std::string message() {
    return test::message_of(folder_.path(), [&] { read_colmap_model(folder_.path()); });
  }
  // Replaces the first `from` in a file of the model.
  void change(const std::string& name, const std::string& from, const std::string& to) {
    std::string text = read_bytes(folder_ / name);
    ASSERT_NE(text.find(from), std::string::npos) << name << " has no " << from;
    folder_.write(name, text.replace(text.find(from), from.size(), to));
  }
  test::TemporaryDirectory folder_;
};

TEST_F(ColmapFolder, GivesBackTheMap) {
  const PointMap map = some_map();
  write_colmap_model(folder_.path(), kCamera, map);
  const ColmapModel back = read_colmap_model(folder_.path());
  EXPECT_EQ(back.camera, kCamera);
  ASSERT_EQ(back.map.points.size(), map.points.size());
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    EXPECT_EQ(back.map.points[i].p_world, map.points[i].p_world);
    EXPECT_EQ(back.map.points[i].rgb, map.points[i].rgb);
  }
  ASSERT_EQ(back.map.keyframes.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const Keyframe &a = map.keyframes[k], &b = back.map.keyframes[k];
    EXPECT_TRUE(a.T_world_camera.isApprox(b.T_world_camera, 1e-12));
    EXPECT_EQ(a.image, b.image);
    EXPECT_EQ(a.frame, b.frame);
    EXPECT_EQ(a.time, b.time);
    ASSERT_EQ(a.sightings.size(), b.sightings.size());
    for (std::size_t i = 0; i < a.sightings.size(); ++i) {
      EXPECT_EQ(a.sightings[i].point, b.sightings[i].point);
      EXPECT_TRUE(a.sightings[i].pixel.isApprox(b.sightings[i].pixel, 1e-12));
    }
  }
}

TEST_F(ColmapFolder, KeepsEveryKindOfDistortion) {
  for (const Distortion& distortion : {Distortion{BrownConrady{}}, Distortion{BrownConrady{0.1, 0, 0, 0, 0}},
                                       Distortion{BrownConrady{0.2, -0.9, -0.005, 0.002, 1.1}},
                                       Distortion{BrownConrady{0.2, -0.9, -0.005, 0.002, 1.1, 0.1, 0.2, 0.3}},
                                       Distortion{Fisheye{0.2, -0.9, 0.005, 0.002}}}) {
    Camera camera = kCamera;
    camera.distortion = distortion;
    write_colmap_model(folder_.path(), camera, some_map());
    EXPECT_EQ(read_colmap_model(folder_.path()).camera, camera);
  }
}

TEST_F(ColmapFolder, OpensInColmap) {
  if (std::system("command -v colmap > /dev/null 2>&1") != 0) GTEST_SKIP() << "colmap is not installed";
  write_colmap_model(folder_.path(), kCamera, some_map());
  const std::string command = "QT_QPA_PLATFORM=offscreen colmap model_analyzer --path " + folder_.path().string() +
                              " > " + (folder_ / "told").string() + " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << read_bytes(folder_ / "told");
  const std::string told = read_bytes(folder_ / "told");
  EXPECT_NE(told.find("Registered images: 3"), std::string::npos) << told;
  EXPECT_NE(told.find("Points: 20"), std::string::npos) << told;
  EXPECT_NE(told.find("Observations: 38"), std::string::npos) << told;
}

TEST_F(ColmapFolder, StatesTheErrorOfEachPoint) {
  write_colmap_model(folder_.path(), kCamera, some_map());
  const auto lines = read_lines(folder_ / "points3D.txt");
  EXPECT_EQ(split_words(lines.at(0).text)[7], "-1") << "nobody sees it";
  // Each sighting was moved by (0.3, 0.4) px.
  EXPECT_NEAR(parse_number("points3D.txt", 1, split_words(lines.at(1).text)[7]), 0.5, 1e-9);
}

TEST_F(ColmapFolder, IsRefusedDownToTheLine) {
  write_colmap_model(folder_.path(), kCamera, some_map());
  change("images.txt", "image 0.jpg\n", "image 0.jpg\n5 ");
  EXPECT_EQ(message(), "images.txt:4: triples X Y POINT3D_ID are wanted");
  write_colmap_model(folder_.path(), kCamera, some_map());
  change("images.txt", " 1 image 0.jpg", " 7 image 0.jpg");
  EXPECT_EQ(message(), "images.txt:3: there is no camera 7");
  write_colmap_model(folder_.path(), kCamera, some_map());
  change("images.txt", "\n2 ", "\n2 9");
  EXPECT_EQ(message(), "images.txt:5: the quaternion has not length 1");
  write_colmap_model(folder_.path(), kCamera, some_map());
  change("points3D.txt", "\n20 ", "\n21 ");
  EXPECT_EQ(message(), "images.txt:4: there is no point 20");
  change("points3D.txt", "\n3 ", "\n3 x");
  EXPECT_NE(message().find("points3D.txt:4: 'x"), std::string::npos) << message();
  std::filesystem::remove(folder_ / "points3D.txt");
  EXPECT_EQ(message(), "points3D.txt: cannot be opened: No such file or directory; check the name");
}

TEST_F(ColmapFolder, IsNotWrittenOfAMapThatContradictsItself) {
  PointMap map = some_map();
  map.keyframes[0].sightings[0].point = 20;
  EXPECT_THROW(write_colmap_model(folder_.path(), kCamera, map), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "images.txt"));
}

}  // namespace
}  // namespace alidade
