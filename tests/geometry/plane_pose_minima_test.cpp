// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_pose_minima.h"

#include <map>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/rotation_descent.h"
#include "tests/geometry/random_planes.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 23;
constexpr double kSigma_m = 3e-4;
constexpr double kExact = 1e-8;  // χ² of 0.03 micrometres

double angle_between(const PlanePose& a, const Eigen::Isometry3d& b) {
  return rotation_angle(a.T_world_body.linear().transpose() * b.linear());
}

bool has(std::span<const PlanePose> poses, const Eigen::Isometry3d& T, double rad) {
  return std::any_of(poses.begin(), poses.end(), [&](const PlanePose& pose) { return angle_between(pose, T) < rad; });
}

// Squared error in units of the pose's own information; 60 is exceeded once in 2e10 for six degrees of freedom.
double squared_sigmas(const PlanePose& pose, const Eigen::Isometry3d& truth) {
  const Vector6d error = difference(pose.T_world_body, truth);
  return error.dot(pose.information * error);
}

std::map<int, int> count_exact_poses(std::span<const int> planes, double sigma_m, int trials) {
  test::RandomGeometry random(kSeed);
  std::map<int, int> histogram;
  for (int trial = 0; trial < trials; ++trial) {
    const auto constraints = test::random_planes(random, random.pose(), planes, sigma_m);
    int exact = 0;
    for (const PlanePose& pose : all_minima(constraints)) exact += pose.chi2 < kExact;
    ++histogram[exact];
  }
  return histogram;
}

// Three quadrics in a quaternion meet in eight points: real ones come in pairs. 2+2+2: 2 (52 %), 4 (44 %) or 6; 1+2+3:
// 2 (39 %) or 4, since the marker with three planes is a point, the one with two has two places at its distance from
// it, and a circle then meets the last plane twice.
TEST(AllMinima, OfSixPlanesHaveAnEvenNumberOfExactPoses) {
  constexpr int k222[] = {2, 2, 2}, k123[] = {1, 2, 3};
  const auto of_222 = count_exact_poses(k222, 0.0, 500), of_123 = count_exact_poses(k123, 0.0, 500);
  int odd = 0;
  for (const auto& [count, times] : of_222) odd += count % 2 ? times : 0;
  for (const auto& [count, times] : of_123) odd += count % 2 ? times : 0;
  EXPECT_LE(odd, 3) << "seed " << kSeed;  // pairs that are about to merge
  EXPECT_GT(of_222.at(2), 200);
  EXPECT_GT(of_222.at(4), 150);
  EXPECT_GT(of_222.at(6), 5);
  EXPECT_GT(of_123.at(4), 250);
  EXPECT_EQ(of_123.count(6), 0u);
}

TEST(AllMinima, OfSevenExactPlanesHaveOneExactPose) {
  constexpr int k322[] = {3, 2, 2};
  const auto histogram = count_exact_poses(k322, 0.0, 500);
  EXPECT_GT(histogram.at(1), 490) << "seed " << kSeed;
}

TEST(AllMinima, AreExactForExactPlanes) {
  test::RandomGeometry random(kSeed);
  constexpr int kPlanes[] = {3, 4, 3};
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Isometry3d truth = random.pose();
    const auto minima = all_minima(test::random_planes(random, truth, kPlanes, 0.0));
    ASSERT_FALSE(minima.empty());
    EXPECT_LT(difference(truth, minima.front().T_world_body).norm(), 1e-10) << trial << " seed " << kSeed;
  }
}

// A descent from 300 random rotations finds no low minimum that is not among them, unless a valley is so flat that 1
// rad along it is within the noise.
TEST(AllMinima, MissNone) {
  test::RandomGeometry random(kSeed);
  int missed = 0;
  for (const std::vector<int>& planes : {std::vector<int>{2, 2, 2}, {1, 2, 3}, {3, 2, 2}, {4, 4, 4}}) {
    for (int trial = 0; trial < 60; ++trial) {
      const auto constraints = test::random_planes(random, random.pose(), planes, kSigma_m);
      const auto minima = all_minima(constraints);
      ASSERT_FALSE(minima.empty());
      const RotationCost cost = eliminate_translation(sum_planes(constraints));
      bool is_missed = false;
      for (int start = 0; start < 300; ++start) {
        const RotationMinimum found = descend(cost, random.pose().linear());
        if (!found.is_minimum || found.cost > minima.front().chi2 + 36 || found.hessian.determinant() < 1e10) continue;
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = found.R_world_body;
        is_missed = is_missed || !has(minima, T, 1e-3);
      }
      missed += is_missed;
    }
  }
  EXPECT_EQ(missed, 0) << "seed " << kSeed;
}

// Planes do not know front from back: points of a plane have an exact twin behind the camera.
TEST(AllMinima, OfAPlanarSceneHaveATwinBehindTheCamera) {
  test::RandomGeometry random(kSeed);
  Eigen::Isometry3d T_camera_scene = random.pose(0.1);
  T_camera_scene.translation().z() += 3;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 6; ++i) points.push_back({random.normal(0.5), random.normal(0.5), 0.0});
  const auto minima = all_minima(test::pixel_planes(random, T_camera_scene, points, 0.0));
  ASSERT_GE(minima.size(), 2u);
  EXPECT_LT(minima[1].chi2, kExact);
  const Eigen::Isometry3d& a = minima[0].T_world_body;
  const Eigen::Isometry3d& b = minima[1].T_world_body;
  for (const Eigen::Vector3d& p : points) EXPECT_LT((a * p + b * p).norm(), 1e-8);
  EXPECT_TRUE(has(std::span(minima).first(2), T_camera_scene, 1e-9));
}

// Camera resection without a start: half a pixel of noise at a focal length of 1000 px. Those in front of the camera
// are judged.
TEST(AllMinima, ResectACameraAmongRandomPoints) {
  test::RandomGeometry random(kSeed);
  int certain = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::Isometry3d T_camera_scene = random.pose(0.1);
    T_camera_scene.translation().z() += 4;
    std::vector<Eigen::Vector3d> points(8);
    for (Eigen::Vector3d& p : points) p = random.vector(0.7);
    const auto constraints = test::pixel_planes(random, T_camera_scene, points, 5e-4);
    auto minima = all_minima(constraints);
    std::erase_if(minima, [&](const PlanePose& pose) {
      return std::any_of(points.begin(), points.end(), [&](const auto& p) { return (pose.T_world_body * p).z() < 0; });
    });
    const PlaneJudgement judgement = judge_minima(constraints, minima);
    if (judgement.verdict != PlaneVerdict::Certain) continue;
    ++certain;
    EXPECT_LT(squared_sigmas(judgement.candidates.front(), T_camera_scene), 60) << trial << " seed " << kSeed;
  }
  EXPECT_GT(certain, 95);
}

TEST(AllMinima, RefuseWhatIsNoPlaneAndNoWeight) {
  test::RandomGeometry random(kSeed);
  constexpr int kPlanes[] = {2, 2, 2};
  const auto good = test::random_planes(random, random.pose(), kPlanes, 0.0);
  EXPECT_TRUE(all_minima({}).empty());
  auto bad = good;
  bad[3].plane_world.normal *= 1.01;
  EXPECT_THROW(all_minima(bad), std::invalid_argument);
  bad = good;
  bad[3].weight = std::nan("");
  EXPECT_THROW(all_minima(bad), std::invalid_argument);
}

TEST(JudgeMinima, CallSixPlanesAmbiguousWithTheTruthAmongTheCandidates) {
  test::RandomGeometry random(kSeed);
  constexpr int kPlanes[] = {2, 2, 2};
  int ambiguous = 0, with_truth = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Isometry3d truth = random.pose();
    const auto constraints = test::random_planes(random, truth, kPlanes, kSigma_m);
    const PlaneJudgement judgement = judge_minima(constraints, all_minima(constraints));
    EXPECT_NE(judgement.verdict, PlaneVerdict::Certain) << trial;
    if (judgement.verdict != PlaneVerdict::Ambiguous) continue;
    ++ambiguous;
    const RotationMinimum nearest = descend(eliminate_translation(sum_planes(constraints)), truth.linear());
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = nearest.R_world_body;
    with_truth += has(judgement.candidates, T, 1e-3) || has(judgement.candidates, truth, 0.05);
  }
  EXPECT_GT(ambiguous, 250);
  EXPECT_EQ(with_truth, ambiguous) << "seed " << kSeed;
}

TEST(JudgeMinima, CallNoWrongPoseCertain) {
  test::RandomGeometry random(kSeed);
  int certain = 0;
  for (const std::vector<int>& planes : {std::vector<int>{3, 2, 2}, {3, 3, 2}, {1, 2, 2, 3}, {8, 8, 8, 8}}) {
    for (int trial = 0; trial < 250; ++trial) {
      const Eigen::Isometry3d truth = random.pose();
      const auto constraints = test::random_planes(random, truth, planes, kSigma_m);
      const PlaneJudgement judgement = judge_minima(constraints, all_minima(constraints));
      if (judgement.verdict != PlaneVerdict::Certain) continue;
      ++certain;
      EXPECT_LT(squared_sigmas(judgement.candidates.front(), truth), 60) << trial << " seed " << kSeed;
    }
  }
  EXPECT_GT(certain, 750);
}

TEST(JudgeMinima, SayWhatIsOpenAndWhatIsWrong) {
  test::RandomGeometry random(kSeed);
  constexpr int kTwoMarkers[] = {4, 4}, kEnough[] = {4, 4, 4};
  const auto open = test::random_planes(random, random.pose(), kTwoMarkers, kSigma_m);
  EXPECT_EQ(judge_minima(open, all_minima(open)).verdict, PlaneVerdict::Undetermined);
  EXPECT_EQ(judge_minima({}, {}).verdict, PlaneVerdict::Undetermined);
  auto wrong = test::random_planes(random, random.pose(), kEnough, kSigma_m);
  wrong[5].plane_world.offset += 0.05;
  EXPECT_EQ(judge_minima(wrong, all_minima(wrong)).verdict, PlaneVerdict::Unexplained);
}

}  // namespace
}  // namespace alidade
