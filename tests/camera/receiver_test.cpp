// SPDX-License-Identifier: Apache-2.0
#include "camera/receiver.h"

#include <chrono>
#include <numbers>

#include <gtest/gtest.h>

#include "camera/rolling_shutter.h"
#include "geometry/rotation.h"
#include "geometry/tangent.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

Receiver finder() {
  Receiver receiver;
  receiver.id = 3;
  receiver.sigma = 1e-3;
  receiver.T_world_receiver.linear() = exp_so3({0.4, -1.1, 0.3});
  receiver.T_world_receiver.translation() = Eigen::Vector3d(10, 20, -3);
  receiver.clock.offset_s = 12.5;
  receiver.clock.rate = -1e-4;
  return receiver;
}

Receiver camera() {
  Receiver receiver = finder();
  receiver.camera = Camera{1920, 1080, 1500, 1480, 970, 530, BrownConrady{0.1, -0.2, 0.001, -0.001, 0.05}, 0.03};
  receiver.sigma = 1.5;
  return receiver;
}

Eigen::Vector3d point_before(const Receiver& receiver) {
  return receiver.T_world_receiver * Eigen::Vector3d(12, -8, 60);
}

TEST(TangentBasis, IsOrthonormalAndRightHandedEverywhere) {
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1),
                                           Eigen::Vector3d(1, -2, 0.5), Eigen::Vector3d(0, 1, -1e-9)}) {
    const Eigen::Vector3d d = direction.normalized();
    const auto basis = tangent_basis(d);
    EXPECT_TRUE((basis.transpose() * basis).isIdentity(1e-12));
    EXPECT_TRUE(basis.col(0).cross(basis.col(1)).isApprox(d, 1e-12));
  }
}

TEST(Receiver, CountsAzimuthTowardsXAndElevationUpwards) {
  constexpr double kQuarter = std::numbers::pi / 2;
  EXPECT_TRUE(direction_of_angles({0, 0}).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(direction_of_angles({kQuarter, 0}).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(direction_of_angles({0, kQuarter}).isApprox(-Eigen::Vector3d::UnitY()));
}

TEST(Receiver, GivesTheAnglesBackOfADirection) {
  for (const Eigen::Vector2d& angles : {Eigen::Vector2d(0.3, -0.8), Eigen::Vector2d(-2.9, 1.2)}) {
    EXPECT_TRUE(angles_of_direction(direction_of_angles(angles)).isApprox(angles, 1e-12));
  }
}

TEST(Receiver, CountsElevationTowardsYWhereThatIsUp) {
  Receiver receiver = finder();
  receiver.axes = FinderAxes::YUp;
  EXPECT_TRUE(direction_of_angles({0.4, 1.5707963267948966}, FinderAxes::YUp).isApprox(Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d p_world = point_before(receiver);
  const auto bearing = bearing_of(receiver, *reading_of(receiver, p_world, Timestamp(50s)));
  EXPECT_TRUE(bearing->direction_world.isApprox((p_world - bearing->origin_world).normalized(), 1e-9));
}

TEST(Receiver, TakesClocksThereAndBack) {
  const ReceiverClock clock{3.25, 2e-5, Timestamp(100s), Eigen::Matrix2d::Zero()};
  EXPECT_EQ(common_time(clock, Timestamp(100s)), Timestamp(103250ms));
  EXPECT_EQ(common_time(clock, Timestamp(200s)), Timestamp(203252ms));
  EXPECT_NEAR(to_seconds(own_time(clock, Timestamp(203252ms)) - Timestamp(200s)), 0.0, 2e-9);
}

TEST(Receiver, LooksAtThePointThatItReads) {
  for (const Receiver& receiver : {finder(), camera()}) {
    const Eigen::Vector3d p_world = point_before(receiver);
    const auto reading = reading_of(receiver, p_world, Timestamp(50s));
    ASSERT_TRUE(reading);
    const auto bearing = bearing_of(receiver, *reading);
    ASSERT_TRUE(bearing);
    EXPECT_EQ(bearing->receiver, 3);
    EXPECT_TRUE(bearing->origin_world.isApprox(receiver.T_world_receiver.translation()));
    EXPECT_TRUE(bearing->direction_world.isApprox((p_world - bearing->origin_world).normalized(), 1e-9));
    const double row_s = receiver.camera ? row_time_s(*receiver.camera, reading->value.y()) : 0.0;
    EXPECT_NEAR(to_seconds(bearing->time - Timestamp(50s)), row_s, 3e-9);
  }
}

// The covariance along the tangents is that of the directions of readings moved by their noise.
TEST(Receiver, CarriesTheNoiseOfAReadingIntoTheDirection) {
  Receiver other_axes = finder();
  other_axes.axes = FinderAxes::YUp;
  for (const Receiver& receiver : {finder(), camera(), other_axes}) {
    ReceiverReading reading = *reading_of(receiver, point_before(receiver), Timestamp(50s));
    reading.covariance << 2, 0.7, 0.7, 1;
    if (!receiver.camera) reading.covariance *= 1e-6;
    const Bearing bearing = *bearing_of(receiver, reading);
    const auto basis = tangent_basis(bearing.direction_world);
    Eigen::Matrix2d J;
    for (int i = 0; i < 2; ++i) {
      const double step = receiver.camera ? 0.01 : 1e-5;
      ReceiverReading low = reading, high = reading;
      low.value[i] -= step;
      high.value[i] += step;
      J.col(i) = basis.transpose() *
                 (bearing_of(receiver, high)->direction_world - bearing_of(receiver, low)->direction_world) /
                 (2 * step);
    }
    EXPECT_TRUE(bearing.covariance.isApprox(J * reading.covariance * J.transpose(), 1e-5));
  }
}

TEST(Receiver, ErrsAlikeAcrossTheLineOfSightUnlessTold) {
  const Receiver receiver = finder();
  const Bearing bearing = *bearing_of(receiver, *reading_of(receiver, point_before(receiver), Timestamp(50s)));
  EXPECT_TRUE(bearing.covariance.isApprox(1e-6 * Eigen::Matrix2d::Identity()));
}

TEST(Receiver, SaysWhatIsImpossible) {
  Receiver receiver = finder();
  EXPECT_FALSE(find_fault(receiver));
  receiver.sigma = 2.0;
  EXPECT_NE(find_fault(receiver).value_or("").find("are these degrees?"), std::string::npos);
  receiver = camera();
  receiver.sigma = -1;
  EXPECT_EQ(find_fault(receiver), "sigma must be > 0 px, got -1");
}

TEST(Receivers, GiveBearingsInOrderOfTime) {
  const std::vector<Receiver> receivers{finder()};
  ReceiverReading late = *reading_of(receivers[0], point_before(receivers[0]), Timestamp(51s));
  ReceiverReading early = *reading_of(receivers[0], point_before(receivers[0]), Timestamp(50s));
  const auto bearings = bearings_of(receivers, std::vector{late, early});
  ASSERT_EQ(bearings.size(), 2u);
  EXPECT_LT(bearings[0].time, bearings[1].time);
  late.receiver = 4;
  EXPECT_THROW(bearings_of(receivers, std::vector{late}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
