// SPDX-License-Identifier: Apache-2.0
#include "geometry/alignment.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 7;
using Points = std::vector<Eigen::Vector3d>;

Similarity random_similarity(test::RandomGeometry& random) {
  return {random.uniform(0.05, 20.0), random.pose(5.0)};
}

Points random_points(test::RandomGeometry& random, int count) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(random.vector() + Eigen::Vector3d(10, -20, 30));
  return points;
}

Points moved(const Similarity& similarity, const Points& points) {
  Points result;
  for (const Eigen::Vector3d& p : points) result.push_back(similarity * p);
  return result;
}

double sum_of_squares(const Similarity& similarity, const Points& source, const Points& target) {
  double sum = 0;
  for (std::size_t i = 0; i < source.size(); ++i) sum += (similarity * source[i] - target[i]).squaredNorm();
  return sum;
}

TEST(AlignPoints, FindsASimilarityAgain) {
  test::RandomGeometry random(kSeed);
  for (int count : {3, 4, 100}) {
    const Similarity truth = random_similarity(random);
    const Points source = random_points(random, count);
    const auto found = align_points(source, moved(truth, source), AlignmentKind::Similarity);
    ASSERT_TRUE(found) << count;
    EXPECT_NEAR(found->scale, truth.scale, 1e-10 * truth.scale) << count;
    EXPECT_TRUE(found->T_target_source.isApprox(truth.T_target_source, 1e-9)) << count;
  }
}

TEST(AlignPoints, FindsARigidMotionAgainInAPlane) {
  test::RandomGeometry random(kSeed);
  Points source = random_points(random, 20);
  for (Eigen::Vector3d& p : source) p.z() = 4.0;  // a path on level ground
  const Similarity truth{1.0, random.pose(5.0)};
  const auto found = align_points(source, moved(truth, source), AlignmentKind::Rigid);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->scale, 1.0);
  EXPECT_TRUE(found->T_target_source.isApprox(truth.T_target_source, 1e-9));
}

TEST(AlignPoints, LeavesTheScaleAloneWhenRigid) {
  test::RandomGeometry random(kSeed);
  const Points source = random_points(random, 20);
  Points target = source;
  for (Eigen::Vector3d& p : target) p *= 2.0;
  EXPECT_EQ(align_points(source, target, AlignmentKind::Rigid)->scale, 1.0);
  EXPECT_NEAR(align_points(source, target, AlignmentKind::Similarity)->scale, 2.0, 1e-12);
}

// The least sum of squares: no small change of the solution makes it less.
TEST(AlignPoints, IsTheLeastSquaresSolutionUnderNoise) {
  test::RandomGeometry random(kSeed);
  const Points source = random_points(random, 30);
  Points target = moved(random_similarity(random), source);
  for (Eigen::Vector3d& p : target) p += random.vector(0.1);
  const auto best = align_points(source, target, AlignmentKind::Similarity);
  ASSERT_TRUE(best);
  const double least = sum_of_squares(*best, source, target);
  for (int trial = 0; trial < 100; ++trial) {
    Similarity other = *best;
    other.scale *= 1.0 + random.normal(1e-3);
    Vector6d xi;
    xi << random.vector(1e-3), random.vector(1e-3);
    other.T_target_source = other.T_target_source * perturbation(xi);
    EXPECT_GT(sum_of_squares(other, source, target), least) << trial;
  }
}

TEST(AlignPoints, GivesARotationForMirroredPoints) {
  test::RandomGeometry random(kSeed);
  const Points source = random_points(random, 20);
  Points target = source;
  for (Eigen::Vector3d& p : target) p.x() = -p.x();
  const auto found = align_points(source, target, AlignmentKind::Similarity);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->T_target_source.linear().determinant(), 1.0, 1e-12);
}

TEST(AlignPoints, IsIdentityForNone) {
  const auto found = align_points(Points{{1, 2, 3}}, Points{{4, 5, 6}}, AlignmentKind::None);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->scale, 1.0);
  EXPECT_EQ(found->T_target_source.matrix(), Eigen::Matrix4d::Identity());
}

TEST(AlignPoints, IsEmptyWhereTheRotationIsFree) {
  const Points line{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {-3, -6, -9}};
  const Points point(4, Eigen::Vector3d(1, 2, 3));
  const Points two{{0, 0, 0}, {1, 0, 0}};
  const Points fine{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_FALSE(align_points(line, line, AlignmentKind::Rigid));
  EXPECT_FALSE(align_points(fine, line, AlignmentKind::Similarity));
  EXPECT_FALSE(align_points(line, fine, AlignmentKind::Similarity));
  EXPECT_FALSE(align_points(point, point, AlignmentKind::Similarity));
  EXPECT_FALSE(align_points(two, two, AlignmentKind::Rigid));
  EXPECT_FALSE(align_points(Points{}, Points{}, AlignmentKind::Rigid));
}

TEST(AlignPoints, RefusesListsOfDifferentLength) {
  EXPECT_THROW(align_points(Points(3), Points(4), AlignmentKind::Rigid), std::invalid_argument);
}

TEST(TransformPose, MapsWhatTheCameraSees) {
  test::RandomGeometry random(kSeed);
  const Similarity similarity = random_similarity(random);
  StampedPose pose;
  pose.T_world_camera = random.pose();
  const Eigen::Vector3d p_camera = random.vector();
  // A point seen by the camera, mapped with the world, is seen in the same direction at `scale` times the distance.
  const Eigen::Vector3d expected = similarity * (pose.T_world_camera * p_camera);
  EXPECT_TRUE((transform(similarity, pose).T_world_camera * (similarity.scale * p_camera)).isApprox(expected, 1e-10));
}

// The perturbation of the moved pose is the old one with its translation scaled: checked on samples of its factor.
TEST(TransformPose, ScalesTheCovarianceAsThePerturbation) {
  test::RandomGeometry random(kSeed);
  const Similarity similarity = random_similarity(random);
  StampedPose pose;
  pose.T_world_camera = random.pose();
  Matrix6d A;
  for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = random.normal(1e-3);
  pose.covariance = A * A.transpose();
  Matrix6d moved_columns;
  for (int i = 0; i < 6; ++i) {
    StampedPose other = pose;
    other.T_world_camera = pose.T_world_camera * perturbation(A.col(i));
    moved_columns.col(i) =
        difference(transform(similarity, pose).T_world_camera, transform(similarity, other).T_world_camera);
  }
  const Matrix6d expected = moved_columns * moved_columns.transpose();
  EXPECT_TRUE(transform(similarity, pose).covariance->isApprox(expected, 1e-9));
}

TEST(TransformTrajectory, KeepsTimesAndLength) {
  test::RandomGeometry random(kSeed);
  Trajectory trajectory(3);
  for (std::size_t i = 0; i < 3; ++i) {
    trajectory[i].time = Timestamp(std::chrono::seconds(i));
    trajectory[i].T_world_camera = random.pose();
  }
  const Trajectory moved_trajectory = transform({2.0, random.pose()}, trajectory);
  ASSERT_EQ(moved_trajectory.size(), 3u);
  EXPECT_EQ(moved_trajectory[2].time, trajectory[2].time);
  EXPECT_NEAR(path_length(moved_trajectory), 2.0 * path_length(trajectory), 1e-12);
  EXPECT_FALSE(moved_trajectory[0].covariance);
}

}  // namespace
}  // namespace alidade
