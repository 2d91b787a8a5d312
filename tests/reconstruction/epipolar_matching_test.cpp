// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/epipolar_matching.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 37;

// Two posed views of 60 points; feature i of both shows point i, with a descriptor of its own.
class MatchAlongEpipolarLines : public testing::Test {
 protected:
  MatchAlongEpipolarLines() {
    std::vector<MapPoint> points(60);
    for (MapPoint& p : points)
      p.p_world = {random_.uniform(-1.5, 1.5), random_.uniform(-1.5, 1.5), random_.uniform(-1, 1)};
    for (std::size_t k = 0; k < 2; ++k) {
      poses_[k] = test::looking_at({6, 1.5 * static_cast<double>(k), 0.5}, {0, 0, 0});
      for (const Sighting& s : test::sightings_from(camera_, points, poses_[k], 0.0, random_)) {
        features_[k].pixels.push_back(s.pixel);
      }
      features_[k].descriptors = cv::Mat::zeros(60, 128, CV_32F);
      for (int i = 0; i < 60; ++i) features_[k].descriptors.at<float>(i, i) = 400;
    }
    subset_.resize(60);
    std::iota(subset_.begin(), subset_.end(), 0);
  }

  std::vector<Match> match(const EpipolarOptions& options = {}) const {
    return match_along_epipolar_lines(camera_, {features_[0], subset_, poses_[0]}, {features_[1], subset_, poses_[1]},
                                      options);
  }

  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  std::array<Eigen::Isometry3d, 2> poses_;
  std::array<Features, 2> features_;
  std::vector<int> subset_;
};

TEST_F(MatchAlongEpipolarLines, FindsEveryPoint) {
  ASSERT_EQ(features_[0].size(), 60);
  ASSERT_EQ(features_[1].size(), 60);
  const auto matches = match();
  EXPECT_EQ(matches.size(), 60u);
  for (const Match& m : matches) EXPECT_EQ(m.a, m.b);
}

TEST_F(MatchAlongEpipolarLines, TakesPartOnlyWithTheSubset) {
  subset_ = {3, 8, 21};
  const auto matches = match();
  ASSERT_EQ(matches.size(), 3u);
  EXPECT_EQ(matches[1].a, 8);
  EXPECT_EQ(matches[1].b, 8);
}

// The epipolar lines of these views run within a few degrees of the rows.
TEST_F(MatchAlongEpipolarLines, LooksOnlyInTheBand) {
  features_[1].pixels[7].y() += 4;
  EXPECT_EQ(match().size(), 59u);
  EpipolarOptions wide;
  wide.band_px = 5;
  EXPECT_EQ(match(wide).size(), 60u);
}

// With all descriptors alike none is distinct, except where a band holds one feature alone.
TEST_F(MatchAlongEpipolarLines, NeedsADistinctDescriptor) {
  for (Features& f : features_) f.descriptors.setTo(cv::Scalar(30));
  EpipolarOptions options;
  options.band_px = 20;
  EXPECT_TRUE(match(options).empty());
}

TEST_F(MatchAlongEpipolarLines, NeedsANearDescriptor) {
  features_[1].descriptors.at<float>(5, 100) = 220;  // 220 from its partner, 600 from all others
  EXPECT_EQ(match().size(), 59u);
  EpipolarOptions loose;
  loose.most_distance = 230;
  EXPECT_EQ(match(loose).size(), 60u);
}

// Feature 9 of a is shown twice in a: only the one nearer to b's descriptor is chosen back.
TEST_F(MatchAlongEpipolarLines, AreMutual) {
  features_[0].pixels[10] = features_[0].pixels[9];
  features_[0].descriptors.row(10).setTo(cv::Scalar(0));
  features_[0].descriptors.at<float>(10, 9) = 400;
  features_[0].descriptors.at<float>(10, 120) = 100;
  const auto matches = match();
  EXPECT_EQ(matches.size(), 59u);
  for (const Match& m : matches) EXPECT_EQ(m.a, m.b);
}

TEST_F(MatchAlongEpipolarLines, AreNoneWhereTheCentresCoincide) {
  poses_[1] = poses_[0];
  EXPECT_TRUE(match().empty());
}

// A pixel that the lens model cannot undistort lies on no line, though its descriptor would fit best.
TEST_F(MatchAlongEpipolarLines, PassOverPixelsOutsideTheLensModel) {
  camera_.distortion = BrownConrady{-0.6, 0, 0, 0, 0};
  const Eigen::Vector2d outside(3000, 2500);
  ASSERT_FALSE(undistort(camera_, outside));
  for (std::size_t k = 0; k < 2; ++k) {
    Eigen::Isometry3d T_camera_world = poses_[k].inverse();
    features_[k].pixels[4] = project(camera_, T_camera_world * Eigen::Vector3d(0.3, 0.1, 0.4))->pixel;
  }
  features_[1].pixels[5] = outside;
  features_[1].descriptors.row(4).copyTo(features_[1].descriptors.row(5));
  const auto matches = match();
  EXPECT_EQ(std::count_if(matches.begin(), matches.end(), [](const Match& m) { return m.a == 4 && m.b == 4; }), 1);
}

}  // namespace
}  // namespace alidade
