// SPDX-License-Identifier: Apache-2.0
#include "io/map_file.h"

#include <random>

#include <gtest/gtest.h>

#include "core/errors.h"
#include "io/text_lines.h"
#include "tests/support/data_directory.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

PointMap some_map(int count) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  PointMap map;
  for (int i = 0; i < count; ++i) {
    MapPoint& point = map.points.emplace_back();
    point.p_world = {normal(random), 1e6 * normal(random), 1e-9 * normal(random)};
    const Eigen::Matrix3d L = Eigen::Matrix3d::NullaryExpr([&] { return normal(random); });
    point.covariance_world = L * L.transpose();
    point.covariance_world = 0.5 * (point.covariance_world + point.covariance_world.transpose()).eval();
    point.rgb = {static_cast<std::uint8_t>(i), 0, 255};
    if (i % 3 != 0) {
      for (std::size_t k = 0; k < 128; ++k) point.descriptor[k] = static_cast<std::uint8_t>(random());
    }
  }
  return map;
}

class MapFile : public testing::Test {
 protected:
  std::string message(std::string_view text) {
    return test::message_of(folder_.path(), [&] { read_map_ply(folder_.write("m.ply", text)); });
  }
  test::TemporaryDirectory folder_;
};

TEST_F(MapFile, GivesBackEveryBit) {
  const PointMap map = some_map(50);
  write_map_ply(folder_ / "m.ply", map);
  const PointMap back = read_map_ply(folder_ / "m.ply");
  ASSERT_EQ(back.points.size(), map.points.size());
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    EXPECT_EQ(back.points[i].p_world, map.points[i].p_world);
    EXPECT_EQ(back.points[i].covariance_world, map.points[i].covariance_world);
    EXPECT_EQ(back.points[i].rgb, map.points[i].rgb);
    EXPECT_EQ(back.points[i].descriptor, map.points[i].descriptor);
  }
}

TEST_F(MapFile, OfNoPointsIsStillAMap) {
  write_map_ply(folder_ / "m.ply", {});
  EXPECT_TRUE(read_map_ply(folder_ / "m.ply").points.empty());
}

TEST_F(MapFile, MayBeAnAsciiMeshWithoutColour) {
  const PointMap map = read_map_ply(folder_.write(
      "m.ply",
      "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement material 1\r\nproperty float shine\r\nelement vertex 2\r\n"
      "property float x\r\nproperty float y\r\nproperty float z\r\nproperty float confidence\r\nelement face 1\r\n"
      "property list uchar int vertex_indices\r\nend_header\r\n0.5\r\n1 2 3 0.9\r\n-4 5e-1 6 0.8\r\n3 0 1 0\r\n"));
  ASSERT_EQ(map.points.size(), 2u);
  EXPECT_EQ(map.points[1].p_world, Eigen::Vector3d(-4, 0.5, 6));
  EXPECT_EQ(map.points[1].rgb, MapPoint{}.rgb);
  EXPECT_TRUE(map.points[1].covariance_world.isZero());
  EXPECT_EQ(map.points[1].descriptor, Descriptor{});
}

TEST_F(MapFile, ThatIsCutOffAnywhereIsRefused) {
  write_map_ply(folder_ / "whole.ply", some_map(6));
  const std::string bytes = read_bytes(folder_ / "whole.ply");
  for (std::size_t length = 0; length < bytes.size(); length += 13) {
    EXPECT_THROW(read_map_ply(folder_.write("m.ply", bytes.substr(0, length))), InputError) << "at " << length;
  }
  EXPECT_EQ(message(bytes.substr(0, bytes.size() - 1)),
            "m.ply: is cut off in row 6 of 6 of element 'vertex'; copy or write the file again");
  EXPECT_EQ(message(bytes.substr(0, 60)), "m.ply: is cut off in its header; copy the file again");
}

TEST_F(MapFile, ThatIsMalformedIsNamed) {
  const std::string head = "ply\nformat ascii 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_EQ(message("solid cube\n"), "m.ply: is no PLY file; its first line must be 'ply'");
  EXPECT_EQ(message("ply\nformat binary_big_endian 1.0\n"),
            "m.ply:2: format 'binary_big_endian' is not supported; write it as ascii or binary_little_endian");
  EXPECT_EQ(message(head + "element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n"),
            "m.ply: its vertices have no 'z'");
  EXPECT_EQ(message(head + "element vertex 2\n" + xyz + "1 2 3\n1 2 three\n"), "m.ply:9: 'three' is not a number");
  EXPECT_EQ(message(head + "element vertex 2\n" + xyz + "1 2 3\n1 2 nan\n"), "m.ply:9: 'nan' is not a finite number");
  EXPECT_EQ(message(head + "element vertex 2\n" + xyz + "1 2 3\n"),
            "m.ply: is cut off in row 2 of 2 of element 'vertex'; copy or write the file again");
  EXPECT_EQ(message(head + "element vertex many\n"), "m.ply:3: 'many' is not a whole number");
  EXPECT_EQ(message(head + "element vertex 1\nproperty quad x\n"), "m.ply:4: the type of this property is not known");
  EXPECT_EQ(message(head + "elephant 3\n"), "m.ply:3: 'elephant' is not understood here");
  EXPECT_EQ(message(head + "element face 0\nproperty list uchar int i\nend_header\n"),
            "m.ply: holds no vertices; an element 'vertex' is wanted");
  EXPECT_EQ(message("ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + xyz + "\x01\x02\x03\x04" +
                    std::string("\x00\x00\xc0\x7f\x00\x00\xc0\x7f", 8)),
            "m.ply: vertex 0 is not finite; remove it");
}

TEST_F(MapFile, OfTheBunnyHasItsVertices) {
  const auto file = test::data_directory("bunny") / "bun_zipper_res4.ply";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const PointMap map = read_map_ply(file);
  ASSERT_EQ(map.points.size(), 453u);
  EXPECT_EQ(map.points[0].p_world, Eigen::Vector3d(-0.0312216, 0.126304, 0.00514924));
}

}  // namespace
}  // namespace alidade
