// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/cue.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace alidade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Timestamp at(double seconds) {
  return Timestamp(from_seconds(seconds));
}

Receiver receiver_of(const Vector3d& p_world) {
  Receiver receiver;
  receiver.T_world_receiver.translation() = p_world;
  receiver.T_world_receiver.linear() =
      (Eigen::AngleAxisd(0.4, Vector3d::UnitX()) * Eigen::AngleAxisd(-0.7, Vector3d::UnitY())).toRotationMatrix();
  receiver.sigma = 1e-3;
  return receiver;
}

TargetState flying() {
  TargetState state;
  state.p_world = {30, -20, 120};
  state.v_world = {15, 8, -4};
  state.covariance.diagonal().head<3>() << 0.5, 0.8, 2.0;
  state.covariance.diagonal().segment<3>(3) << 0.2, 0.3, 0.5;
  state.covariance(0, 3) = state.covariance(3, 0) = 0.1;
  return state;
}

// What a receiver reads of a target that is there is the cue.
TEST(Cue, IsWhatTheReceiverWouldRead) {
  const Receiver receiver = receiver_of({5, 10, -15});
  const auto cue = cue_at(receiver, flying(), at(0.4));
  ASSERT_TRUE(cue);
  const auto reading = reading_of(receiver, moved_to(flying(), at(0.4)).p_world, at(0.4));
  EXPECT_LT((cue->azimuth_elevation - reading->value).norm(), 1e-12);
  EXPECT_NEAR(cue->range_m, (moved_to(flying(), at(0.4)).p_world - Vector3d(5, 10, -15)).norm(), 1e-9);
}

// The paper's axes point the other way up: the same place, its elevation with the other sign.
TEST(Cue, IsInTheAxesOfTheReceiver) {
  Receiver down = receiver_of({5, 10, -15}), up = down;
  up.axes = FinderAxes::YUp;
  const auto cue = cue_at(up, flying(), at(0.4)), other = cue_at(down, flying(), at(0.4));
  const auto reading = reading_of(up, moved_to(flying(), at(0.4)).p_world, at(0.4));
  EXPECT_LT((cue->azimuth_elevation - reading->value).norm(), 1e-12);
  EXPECT_NEAR(cue->azimuth_elevation[1], -other->azimuth_elevation[1], 1e-12);
  EXPECT_NEAR(cue->covariance(0, 1), -other->covariance(0, 1), 1e-15);
  EXPECT_NEAR(cue->covariance(1, 1), other->covariance(1, 1), 1e-15);
  const Vector2d looks_at = other->azimuth_elevation.cwiseProduct(Vector2d(1.0, -1.0));
  const auto steered = cue_for({up, 1.0, 0.0, looks_at}, flying(), at(0.4));  // it looks there already
  EXPECT_LT(to_seconds(steered->time - at(0.4)), 1e-6);
}

TEST(Cue, IsTimedByTheReceiversOwnClockToo) {
  Receiver receiver = receiver_of({0, 0, 0});
  receiver.clock.offset_s = 0.25;
  const auto cue = cue_at(receiver, flying(), at(1));
  EXPECT_EQ(cue->time, at(1));
  EXPECT_EQ(cue->own_time, at(0.75));
}

// Central differences of angles about the state and about the pose.
TEST(Cue, CarriesTheCovarianceOfStateAndPose) {
  Receiver receiver = receiver_of({5, 10, -15});
  const TargetState state = flying();
  constexpr double kStep = 1e-5;
  const auto angles = [&](const Receiver& r, const TargetState& s) { return cue_at(r, s, at(0))->azimuth_elevation; };
  Eigen::Matrix<double, 2, 3> J_p;
  for (int axis = 0; axis < 3; ++axis) {
    TargetState ahead = state, behind = state;
    ahead.p_world(axis) += kStep;
    behind.p_world(axis) -= kStep;
    J_p.col(axis) = (angles(receiver, ahead) - angles(receiver, behind)) / (2 * kStep);
  }
  const Eigen::Matrix2d of_state = J_p * state.covariance.topLeftCorner<3, 3>() * J_p.transpose();
  EXPECT_TRUE(cue_at(receiver, state, at(0))->covariance.isApprox(of_state, 1e-6));
  Eigen::Matrix<double, 2, 6> J_pose;
  for (int axis = 0; axis < 6; ++axis) {
    Receiver ahead = receiver, behind = receiver;
    ahead.T_world_receiver = receiver.T_world_receiver * perturbation(kStep * Vector6d::Unit(axis));
    behind.T_world_receiver = receiver.T_world_receiver * perturbation(-kStep * Vector6d::Unit(axis));
    J_pose.col(axis) = (angles(ahead, state) - angles(behind, state)) / (2 * kStep);
  }
  Vector6d sigmas;
  sigmas << 0.3, 0.4, 0.5, 0.01, 0.015, 0.02;
  const Matrix6d correlations = 0.5 * (Matrix6d::Identity() + Matrix6d::Ones());
  receiver.pose_covariance = sigmas.asDiagonal() * correlations * sigmas.asDiagonal();
  const Eigen::Matrix2d of_both = of_state + J_pose * *receiver.pose_covariance * J_pose.transpose();
  EXPECT_TRUE(cue_at(receiver, state, at(0))->covariance.isApprox(of_both, 1e-6));
}

// Drawn states, flown on with white acceleration: χ² of 2 degrees, mean of 3,000 within 4 standard deviations.
TEST(Cue, HoldsItsCovarianceAtAllLeadTimes) {
  const Receiver receiver = receiver_of({5, 10, -15});
  const TargetState state = flying();
  const TargetMotion motion{2.0, 0.0};
  const Eigen::Matrix<double, 6, 6> root = state.covariance.topLeftCorner<6, 6>().llt().matrixL();
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (const double lead_s : {0.1, 1.0}) {
    constexpr int kCues = 3000, kSteps = 50;
    const auto cue = cue_at(receiver, state, at(lead_s), motion);
    double sum = 0.0;
    for (int i = 0; i < kCues; ++i) {
      Eigen::Matrix<double, 6, 1> e;
      for (double& x : e) x = normal(random);
      e = root * e;
      Vector3d p = state.p_world + e.head<3>(), v = state.v_world + e.tail<3>();
      const double dt = lead_s / kSteps;
      for (int step = 0; step < kSteps; ++step) {
        p += dt * v;
        for (double& x : v) x += std::sqrt(motion.acceleration_density * dt) * normal(random);
      }
      const Vector2d off = reading_of(receiver, p, at(lead_s))->value - cue->azimuth_elevation;
      sum += off.dot(cue->covariance.ldlt().solve(off));
    }
    EXPECT_NEAR(sum / (2.0 * kCues), 1.0, 4.0 / std::sqrt(kCues)) << lead_s;
  }
}

// It turns by exactly the angle that it has time for, and meets the target where it is by then.
TEST(CueForASteeredReceiver, MeetsTheTargetWhenItHasTurned) {
  SteeredReceiver steered{receiver_of({5, 10, -15}), 0.5, 0.1, Vector2d(0.3, -0.1)};
  const auto cue = cue_for(steered, flying(), at(2));
  ASSERT_TRUE(cue);
  const double turned =
      std::acos(direction_of_angles(*steered.azimuth_elevation).dot(direction_of_angles(cue->azimuth_elevation)));
  EXPECT_NEAR(to_seconds(cue->time - at(2)), turned / 0.5 + 0.1, 1e-6);
  const auto reading = reading_of(steered.receiver, moved_to(flying(), cue->time).p_world, cue->time);
  EXPECT_LT((cue->azimuth_elevation - reading->value).norm(), 1e-9);
}

TEST(CueForASteeredReceiver, IsEmptyWhereTheTargetOutrunsIt) {
  SteeredReceiver steered{receiver_of({0, 0, 0}), 1e-3, 0.0, Vector2d(3.0, 0.0)};
  EXPECT_FALSE(cue_for(steered, flying(), at(0)));
}

TEST(Cue, IsEmptyRightAboveAReceiver) {
  Receiver receiver;  // its y axis, which points down, is the world's
  TargetState state = flying();
  state.p_world = {0, -50, 0};
  EXPECT_FALSE(cue_at(receiver, state, state.time));
}

TEST(CueForASteeredReceiver, RefusesAReceiverThatDoesNotTurn) {
  SteeredReceiver steered;
  steered.slew_rad_s = 0.0;
  EXPECT_THROW(cue_for(steered, flying(), at(0)), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
