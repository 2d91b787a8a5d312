// SPDX-License-Identifier: Apache-2.0
#include "camera/line_detector.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/pose.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

constexpr double kPi = std::numbers::pi;
const Camera kCamera{640, 480, 517.3, 516.5, 318.6, 255.3, BrownConrady{0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
const SweepTerms kTerms{0.018, -0.048, 0.0044, 0.0169, 1.705, 0.0, 0.0};
const SweepTerms kFullTerms{-0.0063, 0.0474, 0.193, -0.0054, 2.25, 0.172, 2.64};

std::vector<LineModel> models() {
  return {FocalLine{},
          LineCamera{2048, 1500, 1023.5},
          LineCamera{2048, 1500, 1023.5, -0.12, 0.03, -0.004},
          Lighthouse1{0, {}},
          Lighthouse1{0, kTerms},
          Lighthouse1{1, kTerms},
          Lighthouse2{0, kTerms},
          Lighthouse2{1, kTerms},
          Lighthouse2Full{0, kFullTerms},
          Lighthouse2Full{1, kFullTerms},
          PixelAxis{kCamera, 0},
          PixelAxis{kCamera, 1}};
}

bool looks_along_x(const LineModel& model) {
  return std::holds_alternative<Lighthouse1>(model) || std::holds_alternative<Lighthouse2>(model);
}

// A point of the model's frame at `depth` ahead, `right` and `up` of its line of view.
Eigen::Vector3d point_ahead(const LineModel& model, double depth, double right, double up) {
  if (looks_along_x(model)) return {depth, -right, up};
  if (std::holds_alternative<Lighthouse2Full>(model)) return {right, up, -depth};
  return {right, -up, depth};
}

std::vector<Eigen::Vector3d> points_in_view(const LineModel& model) {
  std::vector<Eigen::Vector3d> points;
  for (double depth : {0.4, 3.0, 20.0}) {
    for (double right : {-0.45, -0.1, 0.0, 0.3}) {
      for (double up : {-0.3, 0.0, 0.07, 0.4}) points.push_back(point_ahead(model, depth, depth * right, depth * up));
    }
  }
  return points;
}

LineDetector placed(const LineModel& model) {
  LineDetector detector{3, "north", model};
  detector.T_world_station.linear() = exp_so3({0.3, -1.1, 0.7});
  detector.T_world_station.translation() = Eigen::Vector3d(2.0, -1.0, 2.5);
  detector.T_station_detector.linear() = exp_so3({-0.2, 0.1, 1.4});
  detector.T_station_detector.translation() = Eigen::Vector3d(0.1, 0.0, -0.2);
  return detector;
}

Eigen::Vector3d to_world(const LineDetector& detector, const Eigen::Vector3d& p) {
  return detector.T_world_station * detector.T_station_detector * p;
}

TEST(LineModel, HasTheJacobianOfCentralDifferences) {
  for (const LineModel& model : models()) {
    for (const Eigen::Vector3d& p : points_in_view(model)) {
      const double h = 1e-5 * p.norm();
      Eigen::RowVector3d J;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
        J[i] = (project(model, p + step)->value - project(model, p - step)->value) / (2 * h);
      }
      const auto found = project(model, p);
      ASSERT_TRUE(found) << model.index() << ": " << p.transpose();
      EXPECT_LT((found->J_value_point - J).norm(), 1e-8 * J.norm()) << model.index() << ": " << p.transpose();
    }
  }
}

TEST(LineModel, ReadsAllPointsOfALineThroughItsCentreAlike) {
  for (const LineModel& model : models()) {
    for (const Eigen::Vector3d& p : points_in_view(model)) {
      EXPECT_NEAR(project(model, p)->value, project(model, Eigen::Vector3d(7 * p))->value, 1e-12);
    }
  }
}

// Without distortion all points of a plane through the focal line are read alike.
TEST(LineModel, ReadsTheAngleAboutItsFocalLine) {
  EXPECT_NEAR(project(FocalLine{}, Eigen::Vector3d(1, 5, std::sqrt(3.0)))->value, kPi / 6, 1e-15);
  EXPECT_NEAR(project(Lighthouse1{0, {}}, Eigen::Vector3d(2, 2, -1))->value, kPi / 4, 1e-15);
  EXPECT_NEAR(project(Lighthouse1{1, {}}, Eigen::Vector3d(2, 7, 2))->value, kPi / 4, 1e-15);
  EXPECT_NEAR(project(LineCamera{2048, 1500, 1000}, Eigen::Vector3d(0.5, 7, 2))->value, 1375.0, 1e-12);
}

// The planes n = (-sin a, cos a, -+tan 30°) are those of the second generation without factory terms.
TEST(LineModel, OfTheSecondGenerationReadsTiltedPlanes) {
  for (int sweep : {0, 1}) {
    for (double a : {-0.7, 0.0, 0.4}) {
      const Eigen::Vector3d n(-std::sin(a), std::cos(a), (sweep == 0 ? -1 : 1) * std::tan(kPi / 6));
      const Eigen::Vector3d across = n.cross(Eigen::Vector3d::UnitX()).normalized();
      const Eigen::Vector3d p = 2.0 * n.cross(across).normalized() * (n.cross(across).x() < 0 ? -1 : 1) + 0.3 * across;
      EXPECT_NEAR(project(Lighthouse2{sweep, {}}, p)->value, a, 1e-12) << sweep << " " << p.transpose();
    }
  }
}

// README of marker1d: "without curve and ogee the same is raw = B - asin k - 90°".
TEST(LineModel, InFullIsTheSecondGenerationWithoutCurveAndOgee) {
  for (int sweep : {0, 1}) {
    const SweepTerms terms{0.01, 0.05, 0, 0, 0, 0, 0};
    for (const Eigen::Vector3d& p : points_in_view(Lighthouse2Full{})) {
      const Eigen::Vector3d forward_up(-p.z(), -p.x(), p.y());  // the same point with x forward, z up
      const auto full = project(Lighthouse2Full{sweep, terms}, p);
      const auto other = project(Lighthouse2{sweep, terms}, forward_up);
      EXPECT_NEAR(full->value, other->value, 1e-12) << sweep << " " << p.transpose();
    }
  }
}

TEST(LineModel, SeesNothingBehindItOrOnItsFocalLine) {
  for (const LineModel& model : models()) {
    EXPECT_FALSE(project(model, point_ahead(model, -1, 0.1, 0.1))) << model.index();
    EXPECT_FALSE(project(model, point_ahead(model, 0, 0, 1))) << model.index();
    EXPECT_FALSE(project(model, Eigen::Vector3d::Zero())) << model.index();
    for (int i = 0; i < 3; ++i) {
      Eigen::Vector3d p = point_ahead(model, 1, 0.1, 0.1);
      p[i] = std::nan("");
      EXPECT_FALSE(project(model, p)) << model.index();
      p[i] = std::numeric_limits<double>::infinity();
      EXPECT_FALSE(project(model, p)) << model.index();
    }
  }
}

TEST(LineModel, SeesNothingAboveATiltedSweep) {
  EXPECT_FALSE(project(Lighthouse2{0, {}}, Eigen::Vector3d(1, 0, 1.75)));  // tan 30° 1.75 > 1
  EXPECT_FALSE(project(Lighthouse2Full{0, {}}, Eigen::Vector3d(0, 1.75, -1)));
}

TEST(LineModel, SeesNothingWhereTheLensFoldsBack) {
  const LineCamera camera{640, 500, 320, -0.25};  // q (1 - q²/4) grows up to q² = 4/3
  EXPECT_TRUE(project(camera, Eigen::Vector3d(1.15, 3, 1)));
  EXPECT_FALSE(project(camera, Eigen::Vector3d(1.16, 3, 1)));
}

TEST(LineDetector, ReadsPointsOfTheWorldInItsFrame) {
  for (const LineModel& model : models()) {
    const LineDetector detector = placed(model);
    const Eigen::Vector3d p = point_ahead(model, 2, 0.3, -0.2);
    const auto expected = project(model, p);
    const auto found = project(detector, to_world(detector, p));
    EXPECT_NEAR(found->value, expected->value, 1e-12 * (1 + std::abs(expected->value)));
    const Eigen::Matrix3d R = (detector.T_world_station * detector.T_station_detector).linear();
    EXPECT_LT((found->J_value_point * R - expected->J_value_point).norm(), 1e-9);
  }
}

TEST(PlaneNear, HoldsThePointThatIsReadAndTheCentre) {
  for (const LineModel& model : models()) {
    const LineDetector detector = placed(model);
    for (const Eigen::Vector3d& p : points_in_view(model)) {
      const Eigen::Vector3d p_world = to_world(detector, p);
      const auto plane = plane_near(detector, project(model, p)->value, p_world);
      ASSERT_TRUE(plane);
      EXPECT_NEAR(plane->normal.norm(), 1.0, 1e-12);
      EXPECT_NEAR(distance(*plane, p_world), 0.0, 1e-12 * p.norm());
      EXPECT_NEAR(distance(*plane, centre_world(detector)), 0.0, 1e-12 * p.norm());
    }
  }
}

// From a centimetre beside, the plane misses the point by the surface's curvature only.
TEST(PlaneNear, IsExactToFirstOrderAboutANeighbour) {
  for (const LineModel& model : models()) {
    const LineDetector detector = placed(model);
    const Eigen::Vector3d p = point_ahead(model, 3.0, 0.6, -0.5);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d beside = to_world(detector, p + 0.01 * Eigen::Vector3d::Unit(i));
      const auto plane = plane_near(detector, project(model, p)->value, beside);
      EXPECT_NEAR(distance(*plane, to_world(detector, p)), 0.0, 2e-6) << model.index();
    }
  }
}

TEST(PlaneNear, IsExactWhereTheModelsPlanesAre) {
  const LineModel exact[] = {FocalLine{}, LineCamera{2048, 1500, 1023.5, -0.12}, Lighthouse1{1, {}}, Lighthouse2{0, {}},
                             Lighthouse2Full{1, {0.1, 0.05}}};
  for (const LineModel& model : exact) {
    const LineDetector detector = placed(model);
    const auto points = points_in_view(model);
    const Eigen::Vector3d p = point_ahead(model, 2, 0.35, 0.3);
    for (const Eigen::Vector3d& near : points) {
      const auto plane = plane_near(detector, project(model, p)->value, to_world(detector, near));
      EXPECT_NEAR(distance(*plane, to_world(detector, p)), 0.0, 1e-9) << model.index() << ": " << near.transpose();
    }
  }
}

TEST(PlaneNear, IsEmptyOutOfView) {
  for (const LineModel& model : models()) {
    const LineDetector detector = placed(model);
    EXPECT_FALSE(plane_near(detector, 0.1, to_world(detector, point_ahead(model, -1, 0, 0))));
    EXPECT_FALSE(plane_near(detector, std::nan(""), to_world(detector, point_ahead(model, 1, 0, 0))));
  }
}

TEST(PlaneOf, GivesBackItsValue) {
  for (const LineModel& model : models()) {
    const LineDetector detector = placed(model);
    for (double right : {-0.45, -0.1, 0.0, 0.2}) {
      const double value = project(model, point_ahead(model, 1, right, right))->value;
      const auto plane = plane_of(detector, value);
      ASSERT_TRUE(plane) << model.index();
      EXPECT_NEAR(distance(*plane, centre_world(detector)), 0.0, 1e-12);
      // The axis point of a pixel's row is exact only where the tangential distortion bends nothing: to first order.
      const bool pixel = std::holds_alternative<PixelAxis>(model);
      EXPECT_NEAR(*value_of(detector, *plane), value, pixel ? 0.5 : 1e-9) << model.index() << " " << right;
    }
  }
}

TEST(PlaneOf, IsEmptyWhereNothingIsReadSo) {
  for (const LineModel& model : models()) {
    EXPECT_FALSE(plane_of(placed(model), std::nan("")));
    const bool is_pixel = residual(model, 10.0, 0.0) == 10.0;
    EXPECT_EQ(plane_of(placed(model), 2.0).has_value(), is_pixel) << model.index();  // an angle beyond 90°
  }
  EXPECT_FALSE(plane_of(placed(LineCamera{640, 500, 320, -0.25}), 320 + 500));  // q (1 - q²/4) stays below 0.77
}

TEST(ValueOf, IsEmptyForThePlaneAcrossTheAxis) {
  LineDetector detector{0, "a", FocalLine{}};
  EXPECT_FALSE(value_of(detector, {Eigen::Vector3d::UnitY(), 0.0}));
  EXPECT_FALSE(value_of(detector, {Eigen::Vector3d::UnitZ(), 0.0}));  // at 90°
  EXPECT_NEAR(*value_of(detector, {Eigen::Vector3d(-1, 0, 1).normalized(), 0.0}), kPi / 4, 1e-15);
  EXPECT_NEAR(*value_of(detector, {Eigen::Vector3d(1, 0, -1).normalized(), 0.0}), kPi / 4, 1e-15);
}

TEST(Residual, IgnoresWholeTurnsOfAnglesOnly) {
  EXPECT_NEAR(residual(FocalLine{}, kPi - 0.1, -kPi + 0.1), -0.2, 1e-12);
  EXPECT_NEAR(residual(Lighthouse2Full{}, 0.3, 0.1), 0.2, 1e-15);
  EXPECT_EQ(residual(LineCamera{}, 100.0, 1.0), 99.0);
  EXPECT_EQ(residual(PixelAxis{}, 100.0, 1.0), 99.0);
}

}  // namespace
}  // namespace alidade
