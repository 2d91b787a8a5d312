// SPDX-License-Identifier: Apache-2.0
#include "uav/batch/bearing_rows.h"

#include <chrono>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "geometry/tangent.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

Bearing skewed() {
  Bearing bearing;
  bearing.time = Timestamp(3s);
  bearing.origin_world = {10, -20, 5};
  bearing.direction_world = Eigen::Vector3d(1, 2, -0.5).normalized();
  bearing.covariance << 4e-6, 1e-6, 1e-6, 2e-6;
  return bearing;
}

TEST(BearingRows, AreZeroAlongTheLineOfSight) {
  const Bearing bearing = skewed();
  const MotionFrame frame{Timestamp(1s), {1, 1, 1}};
  const BearingRows rows = rows_of(bearing, frame);
  EXPECT_DOUBLE_EQ(rows.t_s, 2.0);
  const Eigen::Vector3d p = bearing.origin_world + 70.0 * bearing.direction_world - frame.anchor_world;
  const BearingError at = bearing_error(rows, p);
  EXPECT_LT(at.error.norm(), 1e-9);
  EXPECT_NEAR(at.depth_m, 70.0, 1e-9);
  EXPECT_LT(bearing_error(rows, rows.origin - rows.direction).depth_m, 0.0);
}

// χ² of an error e along the covariance's own axes is eᵀ R⁻¹ e.
TEST(BearingRows, MeasureByTheCovariance) {
  const Bearing bearing = skewed();
  const BearingRows rows = rows_of(bearing, {bearing.time, bearing.origin_world});
  const Eigen::Vector2d e(1e-4, -3e-4);
  const Eigen::Vector3d p = 50.0 * (bearing.direction_world + tangent_basis(bearing.direction_world) * e);
  EXPECT_NEAR(bearing_error(rows, p).error.squaredNorm(), e.dot(bearing.covariance.inverse() * e), 1e-9);
}

TEST(BearingRows, MoveWithThePointAsTheirDerivativeSays) {
  const Bearing bearing = skewed();
  const BearingRows rows = rows_of(bearing, {bearing.time, bearing.origin_world});
  const Eigen::Vector3d p = 50.0 * bearing.direction_world + Eigen::Vector3d(0.3, -0.2, 0.4);
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
    const Eigen::Vector2d central =
        (bearing_error(rows, p + step).error - bearing_error(rows, p - step).error) / (2 * kStep);
    EXPECT_TRUE(central.isApprox(bearing_error(rows, p).J.col(i), 1e-6));
  }
}

TEST(MotionFrame, LiesAmongTheBearings) {
  Bearing later = skewed();
  later.time += 4s;
  const std::vector<Bearing> bearings{skewed(), later};
  EXPECT_EQ(frame_of(bearings).reference, Timestamp(5s));
  EXPECT_EQ(frame_of(bearings).anchor_world, skewed().origin_world);
  EXPECT_THROW(frame_of({}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
