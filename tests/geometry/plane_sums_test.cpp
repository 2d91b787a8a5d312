// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_sums.h"

#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "geometry/rotation_descent.h"
#include "tests/geometry/random_planes.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 21;
constexpr int kPlanes[] = {3, 5, 1, 4};

double chi2_by_plane(std::span<const PlaneConstraint> constraints, const Eigen::Isometry3d& T) {
  double sum = 0;
  for (const PlaneConstraint& c : constraints) sum += c.weight * std::pow(distance(c.plane_world, T * c.p_body), 2);
  return sum;
}

Eigen::Isometry3d with_best_translation(const RotationCost& cost, const Eigen::Matrix3d& R) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R;
  T.translation() = cost.translation(R);
  return T;
}

TEST(PlaneGram, HasTheCostOfItsPlanes) {
  test::RandomGeometry random(kSeed);
  PlaneGram gram;
  const Eigen::Vector3d p = random.vector();
  double expected = 0;
  for (int i = 0; i < 5; ++i) {
    const PlaneConstraint c{p, {random.direction(), random.normal()}, random.uniform(0.5, 2.0)};
    gram.add(c.plane_world, c.weight);
    expected += c.weight * std::pow(distance(c.plane_world, p), 2);
  }
  EXPECT_NEAR(gram.cost(p), expected, 1e-13 * expected);
}

TEST(PlaneSums, HaveTheChi2OfTheirPlanesAtAnyPose) {
  test::RandomGeometry random(kSeed);
  const auto constraints = test::random_planes(random, random.pose(), kPlanes, 3e-4);
  const PlaneSums sums = sum_planes(constraints);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Isometry3d T = random.pose();
    const double expected = chi2_by_plane(constraints, T);
    EXPECT_NEAR(chi2(sums, T), expected, 1e-13 * expected) << "seed " << kSeed;
  }
}

TEST(PlaneSums, AreTheSameOneByOneAndByPoint) {
  test::RandomGeometry random(kSeed);
  const auto constraints = test::random_planes(random, random.pose(), kPlanes, 3e-4);
  PlaneSums one_by_one;
  for (const PlaneConstraint& constraint : constraints) one_by_one.add(constraint);
  const PlaneSums by_point = sum_planes(constraints);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) EXPECT_TRUE(one_by_one.normals(i, j).isApprox(by_point.normals(i, j), 1e-13));
  }
  EXPECT_TRUE(one_by_one.offsets().isApprox(by_point.offsets(), 1e-13));
  EXPECT_NEAR(one_by_one.squares(), by_point.squares(), 1e-13 * by_point.squares());
}

// Two planes are added and taken back, once as planes and once as a point's Gram.
TEST(PlaneSums, ForgetWhatIsRemoved) {
  test::RandomGeometry random(kSeed);
  auto constraints = test::random_planes(random, random.pose(), kPlanes, 3e-4);
  const PlaneSums without = sum_planes(std::span(constraints).first(constraints.size() - 2));
  PlaneSums sums = sum_planes(constraints);
  sums.remove(constraints[constraints.size() - 1]);
  PlaneGram gram;
  gram.add(constraints[0].plane_world, 1.0);
  gram.add(constraints[constraints.size() - 2].plane_world, constraints[constraints.size() - 2].weight);
  gram.remove(constraints[0].plane_world, 1.0);
  sums.remove(constraints[constraints.size() - 2].p_body, gram);
  const Eigen::Isometry3d T = random.pose();
  EXPECT_NEAR(chi2(sums, T), chi2(without, T), 1e-13 * chi2(without, T));
  EXPECT_TRUE(information(sums, T).isApprox(information(without, T), 1e-12));
}

TEST(PlaneSums, HaveTheInformationOfTheRightPerturbation) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d T = random.pose();
  const auto constraints = test::random_planes(random, T, kPlanes, 3e-4);
  Matrix6d expected = Matrix6d::Zero();
  for (const PlaneConstraint& c : constraints) {
    Vector6d J;
    constexpr double kStep = 1e-5;
    for (int i = 0; i < 6; ++i) {
      const Vector6d xi = kStep * Vector6d::Unit(i);
      J(i) = (distance(c.plane_world, T * perturbation(xi) * c.p_body) -
              distance(c.plane_world, T * perturbation(-xi) * c.p_body)) /
             (2 * kStep);
    }
    expected += c.weight * J * J.transpose();
  }
  EXPECT_LT((information(sum_planes(constraints), T) - expected).norm(), 1e-8 * expected.norm()) << "seed " << kSeed;
}

TEST(EliminateTranslation, LeavesTheChi2OfTheBestTranslation) {
  test::RandomGeometry random(kSeed);
  const auto constraints = test::random_planes(random, random.pose(), kPlanes, 3e-4);
  const RotationCost cost = eliminate_translation(sum_planes(constraints));
  EXPECT_EQ(cost.translation_rank, 3);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Isometry3d T = with_best_translation(cost, random.pose().linear());
    const double best = chi2_by_plane(constraints, T);
    EXPECT_NEAR(cost(T.linear()), best, 1e-12 * best);
    for (int i = 0; i < 3; ++i) {
      for (const double step : {1e-3, -1e-3}) {
        Eigen::Isometry3d beside = T;
        beside.translation()(i) += step;
        EXPECT_GT(chi2_by_plane(constraints, beside), best);
      }
    }
  }
}

// Normals across z alone: the height of the body is open, all else is as before.
TEST(EliminateTranslation, LeavesAnOpenTranslationAtZero) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d T = random.pose();
  std::vector<PlaneConstraint> constraints = test::random_planes(random, T, kPlanes, 0.0);
  for (PlaneConstraint& c : constraints) {
    c.plane_world.normal.z() = 0;
    c.plane_world.normal.normalize();
    c.plane_world.offset = c.plane_world.normal.dot(T * c.p_body);
  }
  const RotationCost cost = eliminate_translation(sum_planes(constraints));
  EXPECT_EQ(cost.translation_rank, 2);
  const Eigen::Vector3d b = cost.translation(T.linear());
  EXPECT_NEAR(b.z(), 0.0, 1e-9);
  EXPECT_LT((b - T.translation()).head<2>().norm(), 1e-9);
  EXPECT_EQ(eliminate_translation(PlaneSums{}).translation_rank, 0);
}

TEST(RotationSlope, AgreesWithCentralDifferences) {
  test::RandomGeometry random(kSeed);
  const auto constraints = test::random_planes(random, random.pose(), kPlanes, 3e-4);
  const RotationCost cost = eliminate_translation(sum_planes(constraints));
  constexpr double kStep = 1e-4;
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Matrix3d R = random.pose().linear();
    const RotationSlope at = slope(cost, R);
    EXPECT_NEAR(2.0 * at.half_cost, cost(R), 1e-12 * cost(R));
    Eigen::Matrix3d moved;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Matrix3d ahead = R * exp_so3(kStep * Eigen::Vector3d::Unit(i));
      const Eigen::Matrix3d behind = R * exp_so3(-kStep * Eigen::Vector3d::Unit(i));
      EXPECT_NEAR(at.gradient(i), (cost(ahead) - cost(behind)) / (4 * kStep), 1e-6 * at.hessian.norm());
      moved.col(i) = (slope(cost, ahead).gradient - slope(cost, behind).gradient) / (2 * kStep);
    }
    // The gradient is taken in axes that turn along, which adds a skew part to its derivative.
    const Eigen::Matrix3d expected = 0.5 * (moved + moved.transpose());
    EXPECT_LT((expected - at.hessian).norm(), 1e-7 * at.hessian.norm()) << "seed " << kSeed;
  }
}

}  // namespace
}  // namespace alidade
