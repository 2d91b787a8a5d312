// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_state.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "tests/tracking/camera_states.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 53;
constexpr MotionNoise kNoNoise{0, 0};

Timestamp after(const CameraState& state, double seconds) {
  return state.time + from_seconds(seconds);
}

TEST(PredictCameraState, MovesWithConstantVelocity) {
  CameraState state;
  state.v_world = {1, -2, 0.5};
  state.omega_camera = {0, 0, 0.4};
  state.T_world_camera.linear() = exp_so3(Eigen::Vector3d(0.3, 0, 0));
  const CameraState next = predict(state, after(state, 0.5), kNoNoise);
  EXPECT_LT((next.T_world_camera.translation() - Eigen::Vector3d(0.5, -1, 0.25)).norm(), 1e-12);
  const Eigen::Matrix3d R = state.T_world_camera.linear() * exp_so3(Eigen::Vector3d(0, 0, 0.2));
  EXPECT_LT((next.T_world_camera.linear() - R).norm(), 1e-12);
  EXPECT_EQ(next.v_world, state.v_world);
  EXPECT_EQ(next.omega_camera, state.omega_camera);
  EXPECT_EQ(next.time, after(state, 0.5));
}

TEST(PredictCameraState, CarriesTheCovarianceByItsDerivative) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    const CameraState state = test::random_state(random, 0.1);
    const CameraState next = predict(state, after(state, 0.3), kNoNoise);
    Matrix12d F;
    for (int i = 0; i < 12; ++i) {
      const test::Vector12d step = 1e-6 * test::Vector12d::Unit(i);
      const CameraState up = predict(test::moved(state, step), after(state, 0.3), kNoNoise);
      const CameraState down = predict(test::moved(state, -step), after(state, 0.3), kNoNoise);
      F.col(i) = (test::error_between(next, up) - test::error_between(next, down)) / 2e-6;
    }
    const Matrix12d expected = F * state.covariance * F.transpose();
    EXPECT_LT((next.covariance - expected).cwiseAbs().maxCoeff(), 1e-7) << "seed " << kSeed << ", trial " << trial;
  }
}

// Eqs. 5 and 6: an acceleration acts on the velocity at once, and by it on the whole interval's motion.
TEST(PredictCameraState, AddsTheAccelerationsByTheirDerivative) {
  test::RandomGeometry random(kSeed);
  CameraState state = test::random_state(random, 0.1);
  state.covariance.setZero();
  const double dt = 0.3;
  const CameraState next = predict(state, after(state, dt), {2.0, 0.5});
  Eigen::Matrix<double, 12, 6> G;
  for (int i = 0; i < 6; ++i) {
    test::Vector12d step = test::Vector12d::Zero();
    step(6 + i) = 1e-6 * dt;
    const CameraState up = predict(test::moved(state, step), after(state, dt), kNoNoise);
    const CameraState down = predict(test::moved(state, -step), after(state, dt), kNoNoise);
    G.col(i) = (test::error_between(next, up) - test::error_between(next, down)) / 2e-6;
  }
  Vector6d q;
  q << 4, 4, 4, 0.25, 0.25, 0.25;
  const Matrix12d expected = G * q.asDiagonal() * G.transpose();
  EXPECT_LT((next.covariance - expected).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(PredictCameraState, StaysForAnEarlierTime) {
  test::RandomGeometry random(kSeed);
  const CameraState state = test::random_state(random, 0.1);
  const CameraState same = predict(state, after(state, -1.0), {1, 1});
  EXPECT_LT((same.T_world_camera.matrix() - state.T_world_camera.matrix()).norm(), 1e-12);
  EXPECT_LT((same.covariance - state.covariance).norm(), 1e-12);
}

// z = pose + noise with H = [I 0]: K = P Hᵀ (H P Hᵀ + R)⁻¹, x + K y, (I - K H) P.
TEST(AbsorbPose, IsTheKalmanUpdate) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    const CameraState predicted = test::random_state(random, 0.1);
    Matrix6d A;
    for (double& value : A.reshaped()) value = random.normal(0.1);
    const Matrix6d R = A * A.transpose();
    Vector6d y;
    y << random.vector(0.1), random.vector(0.1);
    const Matrix12d& P = predicted.covariance;
    const Eigen::Matrix<double, 12, 6> K = P.leftCols<6>() * (P.topLeftCorner<6, 6>() + R).inverse();
    const Matrix12d P_after = P - K * P.topRows<6>();
    const test::Vector12d x = K * y;
    const CameraState state =
        absorb(predicted, predicted.T_world_camera * perturbation(x.head<6>()), P_after.topLeftCorner<6, 6>());
    EXPECT_LT((test::error_between(predicted, state) - x).norm(), 1e-8) << "seed " << kSeed << ", trial " << trial;
    EXPECT_LT((state.covariance - P_after).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(state.covariance, Matrix12d(state.covariance.transpose()));
  }
}

// From 1 to 2 m/s and 0 to 0.3 rad/s within 0.1 s: mean squares of 2/3 (10 m/s²)² and 2/3 (3 rad/s²)².
TEST(AdaptMotionNoise, BlendsInTheChangeOfVelocity) {
  CameraState before, now;
  before.v_world = {1, 0, 0};
  now.v_world = {2, 0, 0};
  now.omega_camera = {0, 0.3, 0};
  now.time = after(before, 0.1);
  const MotionNoise noise = adapt({4, 2}, before, now, 0.25);
  EXPECT_NEAR(noise.acceleration, std::sqrt(0.75 * 16 + 0.25 * 100 * 2 / 3), 1e-9);
  EXPECT_NEAR(noise.angular_acceleration, std::sqrt(0.75 * 4 + 0.25 * 9 * 2 / 3), 1e-9);
}

TEST(AdaptMotionNoise, CalmsDownButNotToZero) {
  CameraState before, now;
  now.time = after(before, 0.1);
  EXPECT_NEAR(adapt({4, 2}, before, now, 0.25).acceleration, 4 * std::sqrt(0.75), 1e-9);
  EXPECT_NEAR(adapt({4, 2}, before, now, 1.0).acceleration, 0.04, 1e-9);
  now.time = before.time;
  now.v_world = {5, 0, 0};
  EXPECT_EQ(adapt({4, 2}, before, now, 0.25).acceleration, 4);
}

TEST(RestingState, KnowsNothingOfTheVelocities) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d T = random.pose();
  const Matrix6d P = 0.5 * Matrix6d::Identity();
  const CameraState state = resting_state(Timestamp(from_seconds(3)), T, P, 2.0, 0.3);
  EXPECT_EQ(state.T_world_camera.matrix(), T.matrix());
  EXPECT_EQ(to_seconds(state.time.time_since_epoch()), 3.0);
  EXPECT_TRUE(state.v_world.isZero() && state.omega_camera.isZero());
  test::Vector12d variances;
  variances << Vector6d::Constant(0.5), Eigen::Vector3d::Constant(4), Eigen::Vector3d::Constant(0.09);
  EXPECT_LT((state.covariance - Matrix12d(variances.asDiagonal())).norm(), 1e-12);
}

}  // namespace
}  // namespace alidade
