// SPDX-License-Identifier: Apache-2.0
#include "marker1d/paper_pose.h"

#include <algorithm>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "marker1d/paper_rotation.h"
#include "tests/geometry/random_geometry.h"
#include "tests/marker1d/body_frames.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 29;

BodyScene scene_of(int markers, double sigma_rad) {
  BodySceneOptions options;
  options.frames = 200;
  options.markers = markers;
  options.sigma_rad = sigma_rad;
  return BodyScene(options);
}

double cost_of(const RigidBody& body, std::span<const MarkerPlane> planes, const Eigen::Isometry3d& T) {
  double sum = 0;
  for (const MarkerPlane& plane : planes) {
    const double d = distance(plane.plane_world, T * body.markers[static_cast<std::size_t>(plane.marker)].p_body);
    sum += d * d;
  }
  return sum;
}

TEST(PaperCost, IsTheSumOfSquaresWithTheBestTranslation) {
  BodyScene scene = scene_of(4, 1e-3);
  const auto frames = test::body_frames(scene);
  const RigidBody& body = scene.bodies()[0];
  test::RandomGeometry random(kSeed);
  const auto& planes = frames[0].planes.planes;
  const auto cost = eliminate_translation(test::sum(body, planes));
  ASSERT_TRUE(cost);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = random.pose().linear();
    T.translation() = cost->translation(T.linear());
    const double E = cost_of(body, planes, T);
    EXPECT_NEAR((*cost)(T.linear()), E, 1e-12 * std::max(1.0, E)) << "seed " << kSeed;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double step : {-1e-3, 1e-3}) {
        EXPECT_GT(cost_of(body, planes, Eigen::Translation3d(step * Eigen::Vector3d::Unit(axis)) * T), E);
      }
    }
  }
}

TEST(PaperEquations, AreTheDerivativesOfTheCost) {
  BodyScene scene = scene_of(4, 1e-3);
  const auto frames = test::body_frames(scene);
  const auto cost = eliminate_translation(test::sum(scene.bodies()[0], frames[0].planes.planes));
  ASSERT_TRUE(cost);
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Matrix3d A_ref = random.pose().linear();
    const Eigen::Vector3d P = 0.7 * random.uniform(0, 1) * random.direction();
    const PaperEquations equations = paper_equations(*cost, P, A_ref);
    for (int j = 0; j < 3; ++j) {
      const auto difference = [&](double h) {
        const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(j);
        const auto f = [&](const Eigen::Vector3d& at) { return paper_equations(*cost, at, A_ref).f; };
        const auto E = [&](const Eigen::Vector3d& at) { return (*cost)(paper_rotation(at) * A_ref); };
        Eigen::Vector4d d;
        d << (f(P + step) - f(P - step)) / (2 * h), (E(P + step) - E(P - step)) / (4 * h);
        return d;
      };
      const Eigen::Vector4d expected = (4.0 * difference(5e-4) - difference(1e-3)) / 3.0;
      EXPECT_LT((equations.J.col(j) - expected.head<3>()).norm(), 1e-9 * equations.J.norm()) << "seed " << kSeed;
      EXPECT_NEAR(equations.f(j), expected(3), 1e-9 * equations.J.norm()) << "seed " << kSeed;
    }
  }
}

TEST(PaperPose, IsExactForExactPlanes) {
  for (const int markers : {3, 4, 8}) {
    BodyScene scene = scene_of(markers, 0.0);
    test::RandomGeometry random(kSeed);
    for (const test::BodyFrame& frame : test::body_frames(scene)) {
      const auto cost = eliminate_translation(test::sum(scene.bodies()[0], frame.planes.planes));
      ASSERT_TRUE(cost);
      const Eigen::Matrix3d start = frame.T_world_body.linear() * exp_so3(0.3 * random.direction());
      const auto pose = solve_paper_pose(*cost, start);
      ASSERT_TRUE(pose);
      EXPECT_TRUE(pose->is_minimum);
      EXPECT_LT(difference(frame.T_world_body, pose->T_world_body).head<3>().norm(), 1e-12) << "seed " << kSeed;
      EXPECT_LT(difference(frame.T_world_body, pose->T_world_body).tail<3>().norm(), 1e-11) << "seed " << kSeed;
    }
  }
}

// Six planes, two of each marker of three, given nearly the right attitude.
TEST(PaperPose, NeedsNoThreePlanesPerMarker) {
  BodyScene scene = scene_of(3, 0.0);
  const auto frames = test::body_frames(scene);
  std::vector<MarkerPlane> six;
  for (const MarkerPlane& plane : frames[0].planes.planes) {
    const auto of_marker = [&plane](const MarkerPlane& other) { return other.marker == plane.marker; };
    const std::size_t row = static_cast<std::size_t>(&plane - frames[0].planes.planes.data()) / 3;
    if (row % 4 == static_cast<std::size_t>(plane.marker) && std::count_if(six.begin(), six.end(), of_marker) < 2) {
      six.push_back(plane);
    }
  }
  ASSERT_EQ(six.size(), 6u);
  const auto cost = eliminate_translation(test::sum(scene.bodies()[0], six));
  ASSERT_TRUE(cost);
  const auto pose = solve_paper_pose(*cost, frames[0].T_world_body.linear() * exp_so3({0.01, 0, 0.01}));
  ASSERT_TRUE(pose);
  EXPECT_LT(difference(frames[0].T_world_body, pose->T_world_body).norm(), 1e-9);
}

// From 55° off the way leads beyond |P|² = 0.6.
TEST(PaperPose, ChangesTheReferenceOnALongWay) {
  BodyScene scene = scene_of(8, 0.0);
  const auto frames = test::body_frames(scene);
  const auto cost = eliminate_translation(test::sum(scene.bodies()[0], frames[0].planes.planes));
  test::RandomGeometry random(kSeed);
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Matrix3d start = frames[0].T_world_body.linear() * exp_so3(0.96 * random.direction());
    const auto pose = solve_paper_pose(*cost, start);
    if (!pose || !pose->is_minimum) continue;
    EXPECT_TRUE((pose->T_world_body.linear().transpose() * pose->T_world_body.linear()).isIdentity(1e-12));
    found += difference(frames[0].T_world_body, pose->T_world_body).norm() < 1e-9 ? 1 : 0;
  }
  EXPECT_GT(found, 20) << "seed " << kSeed;
}

TEST(PaperPose, IsFoundWithoutAStart) {
  for (const int markers : {3, 4, 8}) {
    BodyScene scene = scene_of(markers, 1e-4);
    for (const test::BodyFrame& frame : test::body_frames(scene)) {
      const auto cost = eliminate_translation(test::sum(scene.bodies()[0], frame.planes.planes));
      const auto pose = start_paper_pose(*cost);
      ASSERT_TRUE(pose);
      EXPECT_LT(difference(frame.T_world_body, pose->T_world_body).norm(), 0.02);
    }
  }
}

TEST(PaperSums, APlaneTakenBackWasNeverThere) {
  BodyScene scene = scene_of(4, 1e-4);
  const auto frames = test::body_frames(scene);
  const auto& planes = frames[0].planes.planes;
  PaperSums sums = test::sum(scene.bodies()[0], planes);
  sums.remove(planes[7], 1.0);
  std::vector<MarkerPlane> others = planes;
  others.erase(others.begin() + 7);
  const PaperSums expected = test::sum(scene.bodies()[0], others);
  for (std::size_t m = 0; m < 4; ++m) EXPECT_LT((sums.gram(m) - expected.gram(m)).norm(), 1e-13);
}

TEST(PaperCost, IsEmptyWhereNormalsDoNotSpanSpace) {
  const RigidBody body{"body", {{0, {0.1, 0, 0}}, {1, {0, 0.1, 0}}, {2, {0, 0, 0.1}}}};
  PaperSums sums(body, {0, 0, 0});
  EXPECT_FALSE(eliminate_translation(sums));
  for (int marker = 0; marker < 3; ++marker) {
    sums.add({marker, {Eigen::Vector3d::UnitX(), 0.1}}, 1.0);
    sums.add({marker, {Eigen::Vector3d::UnitY(), 0.1}}, 1.0);
  }
  EXPECT_FALSE(eliminate_translation(sums));
}

TEST(PaperPose, IsEmptyWhereTheAttitudeIsOpen) {
  const RigidBody body{"body", {{0, {0.1, 0, 0}}, {1, {-0.1, 0, 0}}}};  // free to turn about x
  PaperSums sums(body, {0, 0, 0});
  for (int axis = 0; axis < 3; ++axis) {
    sums.add({0, {Eigen::Vector3d::Unit(axis), axis == 0 ? 0.1 : 0.0}}, 1.0);
    sums.add({1, {Eigen::Vector3d::Unit(axis), axis == 0 ? -0.1 : 0.0}}, 1.0);
  }
  const auto cost = eliminate_translation(sums);
  ASSERT_TRUE(cost);
  EXPECT_FALSE(solve_paper_pose(*cost, Eigen::Matrix3d::Identity()));
}

}  // namespace
}  // namespace alidade
