// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/two_view.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 3;
constexpr double kDegree = 3.14159265358979 / 180;

class SolveTwoViews : public testing::Test {
 protected:
  // Pairs of `points` (in the axes of camera a) seen by both cameras, with half a pixel of noise.
  std::vector<PixelPair> see(const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& T_a_b) {
    std::vector<PixelPair> pairs;
    for (const Eigen::Vector3d& p_a : points) {
      const auto a = project(camera_, p_a);
      const auto b = project(camera_, T_a_b.inverse() * p_a);
      if (!a || !b || !is_inside(camera_, a->pixel) || !is_inside(camera_, b->pixel)) continue;
      pairs.push_back({a->pixel + noise(), b->pixel + noise()});
    }
    return pairs;
  }

  Eigen::Vector2d noise() { return {random_.normal(noise_px_), random_.normal(noise_px_)}; }

  std::vector<Eigen::Vector3d> volume(int count) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < count; ++i) {
      const double z = random_.uniform(3, 9);
      points.emplace_back(z * random_.uniform(-0.5, 0.5), z * random_.uniform(-0.4, 0.4), z);
    }
    return points;
  }

  // A plane at 5 m, tilted by 30 degrees.
  std::vector<Eigen::Vector3d> plane(int count) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < count; ++i) {
      const double x = random_.uniform(-2.2, 2.2);
      points.emplace_back(x, random_.uniform(-1.7, 1.7), 5 + 0.577 * x);
    }
    return points;
  }

  static Eigen::Isometry3d motion(const Eigen::Vector3d& t, const Eigen::Vector3d& rotation_vector) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = t;
    T.linear() = exp_so3(rotation_vector);
    return T;
  }

  void expect_pose(const TwoViewGeometry& found, const Eigen::Isometry3d& T_a_b, double most_deg) {
    EXPECT_LT(rotation_angle(found.T_a_b.linear().transpose() * T_a_b.linear()), most_deg * kDegree);
    EXPECT_NEAR(found.T_a_b.translation().norm(), 1.0, 1e-9);
    const double cosine = found.T_a_b.translation().dot(T_a_b.translation().normalized());
    EXPECT_GT(cosine, std::cos(5 * most_deg * kDegree)) << found.T_a_b.translation().transpose();
  }

  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  double noise_px_ = 0.3;
};

TEST_F(SolveTwoViews, RecoversTheMotion) {
  const Eigen::Isometry3d T_a_b = motion({0.8, 0.1, -0.2}, {0.02, -0.12, 0.03});
  const auto pairs = see(volume(300), T_a_b);
  const auto found = solve_two_views(camera_, pairs);
  ASSERT_EQ(found.outcome, TwoViewOutcome::Solved) << explain(found, {});
  expect_pose(found, T_a_b, 0.5);
  EXPECT_GT(found.inliers.size(), 0.9 * static_cast<double>(pairs.size()));
  EXPECT_LT(found.homography_share, 0.9);
}

// The median angle under which the points see the two centres.
TEST_F(SolveTwoViews, TellsTheParallax) {
  noise_px_ = 0;
  const Eigen::Isometry3d T_a_b = motion({0.8, 0, 0}, {0, -0.1, 0});
  const std::vector<Eigen::Vector3d> points(volume(300));
  const auto found = solve_two_views(camera_, see(points, T_a_b));
  std::vector<double> angles;
  for (const Eigen::Vector3d& p : points) {
    if (see({p}, T_a_b).empty()) continue;
    const double cosine = p.normalized().dot((p - T_a_b.translation()).normalized());
    angles.push_back(std::acos(cosine) / kDegree);
  }
  std::sort(angles.begin(), angles.end());
  EXPECT_NEAR(found.median_parallax_deg, angles[angles.size() / 2], 0.3);
}

TEST_F(SolveTwoViews, LeavesOutFalsePairs) {
  const Eigen::Isometry3d T_a_b = motion({0.1, 0.9, 0.1}, {0.1, 0.0, -0.05});
  auto pairs = see(volume(300), T_a_b);
  const std::size_t good = pairs.size();
  for (std::size_t i = 0; i < good / 2; ++i) {  // a third of all
    pairs.push_back(
        {{random_.uniform(0, 640), random_.uniform(0, 480)}, {random_.uniform(0, 640), random_.uniform(0, 480)}});
  }
  const auto found = solve_two_views(camera_, pairs);
  ASSERT_EQ(found.outcome, TwoViewOutcome::Solved) << explain(found, {});
  expect_pose(found, T_a_b, 0.5);
  int false_inliers = 0;
  for (int i : found.inliers) false_inliers += i >= static_cast<int>(good);
  EXPECT_LE(false_inliers, 6);
}

TEST_F(SolveTwoViews, SeesThatARotationGivesNoDepth) {
  const auto found = solve_two_views(camera_, see(volume(300), motion({0, 0, 0}, {0.03, 0.15, 0.02})));
  EXPECT_EQ(found.outcome, TwoViewOutcome::TooLittleParallax) << explain(found, {});
  EXPECT_NE(explain(found, {}).find("sideways"), std::string::npos);
}

TEST_F(SolveTwoViews, SeesThatABaselineIsTooShort) {
  const auto found = solve_two_views(camera_, see(volume(300), motion({0.04, 0, 0}, {0, 0.05, 0})));
  EXPECT_EQ(found.outcome, TwoViewOutcome::TooLittleParallax) << explain(found, {});
}

// A plane leaves two motions; where the tilt tells them apart the right one is taken, otherwise it is said.
TEST_F(SolveTwoViews, RecoversTheMotionBeforeAPlaneOrSaysThatItIsAmbiguous) {
  int solved = 0;
  for (const double across : {0.8, -0.8, 1.5, -1.5}) {
    const Eigen::Isometry3d T_a_b = motion({across, 0.3, 0.2}, {0.02, -0.1 * across, 0.03});
    const auto found = solve_two_views(camera_, see(plane(400), T_a_b));
    EXPECT_GT(found.homography_share, 0.9);
    if (found.outcome == TwoViewOutcome::Solved) {
      ++solved;
      expect_pose(found, T_a_b, 1.0);
    } else {
      EXPECT_EQ(found.outcome, TwoViewOutcome::PlanarAmbiguity) << explain(found, {});
    }
  }
  EXPECT_GE(solved, 1);
}

TEST_F(SolveTwoViews, FindsNoCommonMotionInRandomPairs) {
  std::vector<PixelPair> pairs;
  for (int i = 0; i < 300; ++i) {
    pairs.push_back(
        {{random_.uniform(0, 640), random_.uniform(0, 480)}, {random_.uniform(0, 640), random_.uniform(0, 480)}});
  }
  EXPECT_EQ(solve_two_views(camera_, pairs).outcome, TwoViewOutcome::NoCommonMotion);
}

TEST_F(SolveTwoViews, NeedsEnoughPairs) {
  auto pairs = see(volume(300), motion({0.8, 0, 0}, {0, 0, 0}));
  pairs.resize(59);
  EXPECT_EQ(solve_two_views(camera_, pairs).outcome, TwoViewOutcome::TooFewMatches);
  EXPECT_EQ(solve_two_views(camera_, {}).outcome, TwoViewOutcome::TooFewMatches);
}

TEST_F(SolveTwoViews, IsTheSameTwice) {
  const auto pairs = see(volume(200), motion({0.8, 0.1, -0.2}, {0.02, -0.12, 0.03}));
  const auto first = solve_two_views(camera_, pairs);
  const auto second = solve_two_views(camera_, pairs);
  EXPECT_EQ(first.T_a_b.matrix(), second.T_a_b.matrix());
  EXPECT_EQ(first.inliers, second.inliers);
}

TEST(ExplainTwoViews, HasASentenceForEveryOutcome) {
  std::vector<std::string> sentences;
  for (auto outcome : {TwoViewOutcome::Solved, TwoViewOutcome::TooFewMatches, TwoViewOutcome::NoCommonMotion,
                       TwoViewOutcome::TooLittleParallax, TwoViewOutcome::PlanarAmbiguity}) {
    TwoViewGeometry geometry;
    geometry.outcome = outcome;
    const std::string sentence = explain(geometry, {});
    EXPECT_FALSE(sentence.empty());
    EXPECT_EQ(std::count(sentences.begin(), sentences.end(), sentence), 0) << sentence;
    sentences.push_back(sentence);
  }
}

}  // namespace
}  // namespace alidade
