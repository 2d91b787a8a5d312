// SPDX-License-Identifier: Apache-2.0
#include "tracking/map_search.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 67;

// J P Jᵀ + J_X P_X J_Xᵀ + σ²I, the derivatives by central differences.
TEST(ExpectPoint, HasTheInnovationCovariance) {
  test::RandomGeometry random(kSeed);
  const Camera camera = test::vga_camera();
  PoseBelief belief;
  belief.T_world_camera = test::looking_at({6, 1, 0.5}, {0, 0, 0});
  Matrix6d A;
  for (double& value : A.reshaped()) value = random.normal(0.01);
  belief.covariance = A * A.transpose();
  MapPoint point;
  point.p_world = {0.5, -0.7, 0.3};
  Eigen::Matrix3d B;
  for (double& value : B.reshaped()) value = random.normal(0.02);
  point.covariance_world = B * B.transpose();
  const auto pixel = [&](const Vector6d& xi, const Eigen::Vector3d& d) {
    return project(camera, (belief.T_world_camera * perturbation(xi)).inverse() * (point.p_world + d))->pixel;
  };
  Eigen::Matrix<double, 2, 6> J;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = 1e-6 * Vector6d::Unit(i);
    J.col(i) = (pixel(step, {0, 0, 0}) - pixel(-step, {0, 0, 0})) / 2e-6;
  }
  Eigen::Matrix<double, 2, 3> J_X;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(i);
    J_X.col(i) = (pixel(Vector6d::Zero(), step) - pixel(Vector6d::Zero(), -step)) / 2e-6;
  }
  const auto expected = expect(camera, belief, point, 0.8);
  ASSERT_TRUE(expected);
  EXPECT_EQ(expected->pixel, pixel(Vector6d::Zero(), {0, 0, 0}));
  const Eigen::Matrix2d S = J * belief.covariance * J.transpose() + J_X * point.covariance_world * J_X.transpose() +
                            0.64 * Eigen::Matrix2d::Identity();
  EXPECT_LT((expected->S - S).norm(), 1e-5 * S.norm()) << "seed " << kSeed;
}

TEST(ExpectPoint, IsEmptyBehindTheCameraAndOutsideTheImage) {
  MapPoint point;
  point.p_world = {0, 0, -3};
  EXPECT_FALSE(expect(test::vga_camera(), {}, point, 1));
  point.p_world = {2.2, 0, 3};
  EXPECT_FALSE(expect(test::vga_camera(), {}, point, 1));
  point.p_world = {0, 0, 3};
  EXPECT_TRUE(expect(test::vga_camera(), {}, point, 1));
}

// Feature i shows point i of a map before the camera, each with a descriptor of its own.
class SearchPoints : public testing::Test {
 protected:
  SearchPoints() {
    map_.points.resize(6);
    features_.descriptors = cv::Mat::zeros(6, 128, CV_32F);
    for (int i = 0; i < 6; ++i) {
      const auto index = static_cast<std::size_t>(i);
      map_.points[index].p_world = {-1.0 + 0.4 * i, 0.1 * i, 4.0};
      map_.points[index].descriptor[index] = 250;
      features_.descriptors.at<float>(i, i) = 250;
      features_.pixels.push_back(project(camera_, map_.points[index].p_world)->pixel);
      features_.pixels.back().x() += 2.0;
      all_.push_back(i);
    }
  }

  std::vector<FoundPoint> search(const SearchOptions& options = {}) const {
    return search_points(camera_, map_, all_, belief_, features_, taken_, options);
  }

  Camera camera_ = test::vga_camera();
  PointMap map_;
  Features features_;
  PoseBelief belief_;
  std::vector<int> all_;
  std::vector<bool> taken_ = std::vector<bool>(6, false);
};

TEST_F(SearchPoints, FindsEveryPointNearItsPlace) {
  const auto found = search();
  ASSERT_EQ(found.size(), 6u);
  for (const FoundPoint& f : found) {
    EXPECT_EQ(f.point, f.feature);
    EXPECT_EQ(f.pixel, features_.pixels[static_cast<std::size_t>(f.feature)]);
  }
}

// 2 px off: outside the ellipse of 0.5 px noise and below the least radius only if that is larger.
TEST_F(SearchPoints, LooksOnlyInsideTheEllipse) {
  SearchOptions options;
  options.sigma_px = 0.5;
  options.least_radius_px = 1.0;
  EXPECT_TRUE(search(options).empty());
  belief_.covariance(0, 0) = 1e-4;  // 1 cm across: 1.3 px
  EXPECT_EQ(search(options).size(), 6u);
  belief_.covariance.setZero();
  belief_.covariance(1, 1) = 1e-4;  // the ellipse is wide, but in the other direction
  EXPECT_TRUE(search(options).empty());
}

TEST_F(SearchPoints, PassesOverTakenFeaturesAndOtherPoints) {
  taken_[2] = true;
  all_ = {1, 2, 3};
  const auto found = search();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].point, 1);
  EXPECT_EQ(found[1].point, 3);
}

// Point 4 comes to lie on point 1, with a descriptor a little off: whatever the order, point 1 has the feature.
TEST_F(SearchPoints, GivesAFeatureToThePointWithTheNearestDescriptor) {
  map_.points[4] = map_.points[1];
  map_.points[4].descriptor[1] = 220;
  for (const std::vector<int>& order : {std::vector<int>{1, 4}, std::vector<int>{4, 1}}) {
    all_ = order;
    const auto found = search();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].point, 1);
  }
}

TEST_F(SearchPoints, MatchesByDescriptorAloneWhereverTheyAre) {
  for (Eigen::Vector2d& pixel : features_.pixels) pixel += Eigen::Vector2d(100, 50);
  EXPECT_TRUE(search().empty());
  const auto found = match_points(map_, {5, 3, 0}, features_, 0.8);
  ASSERT_EQ(found.size(), 3u);
  for (const FoundPoint& f : found) {
    EXPECT_EQ(f.point, f.feature);
    EXPECT_EQ(f.pixel, features_.pixels[static_cast<std::size_t>(f.feature)]);
  }
}

TEST_F(SearchPoints, MakesObservations) {
  map_.points[3].covariance_world = 2 * Eigen::Matrix3d::Identity();
  const auto observations = as_observations(map_, {{3, -1, {5, 6}}}, 0.7);
  ASSERT_EQ(observations.size(), 1u);
  EXPECT_EQ(observations[0].pixel, Eigen::Vector2d(5, 6));
  EXPECT_EQ(observations[0].sigma_px, 0.7);
  EXPECT_EQ(observations[0].p_world, map_.points[3].p_world);
  EXPECT_EQ(observations[0].covariance_world, map_.points[3].covariance_world);
}

}  // namespace
}  // namespace alidade
