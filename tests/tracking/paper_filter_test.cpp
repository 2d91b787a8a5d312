// SPDX-License-Identifier: Apache-2.0
#include "tracking/paper_filter.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "estimation/pose_update.h"
#include "tests/support/motion_states.h"
#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 59;

TEST(PaperState, IsTheStateInOtherCoordinates) {
  test::RandomGeometry random(kSeed);
  const MotionState state = test::random_unaccelerated_state(random, 0.1);
  const Vector13d s = to_paper_state(state).s;
  const Eigen::Matrix3d R_camera_world = Eigen::Quaterniond(s(3), s(4), s(5), s(6)).toRotationMatrix();
  EXPECT_EQ(s.head<3>(), state.T_world_body.translation());
  EXPECT_LT((R_camera_world - state.T_world_body.linear().transpose()).norm(), 1e-12);
  EXPECT_EQ(s.segment<3>(7), state.v_world);
  // The paper turns its quaternion by q ⊗ q{ω Δt}: world → camera after a short time.
  const Eigen::Matrix3d turned = R_camera_world * exp_so3(1e-3 * s.tail<3>());
  const MotionState next = predict(state, state.time + from_seconds(1e-3), {});
  EXPECT_LT((turned - next.T_world_body.linear().transpose()).norm(), 1e-9);
}

TEST(PaperState, LeadsBackToTheState) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    MotionState state = test::random_unaccelerated_state(random, 0.1);
    state.time = Timestamp(from_seconds(7));
    const MotionState back = from_paper_state(to_paper_state(state), state.time);
    EXPECT_LT(error_between(state, back).norm(), 1e-9);
    EXPECT_LT((back.covariance - state.covariance).cwiseAbs().maxCoeff(), 1e-9) << "seed " << kSeed;
    EXPECT_EQ(back.time, state.time);
  }
}

TEST(PaperState, CarriesTheCovarianceByItsDerivative) {
  test::RandomGeometry random(kSeed);
  const MotionState state = test::random_unaccelerated_state(random, 0.1);
  Eigen::Matrix<double, 13, 12> J;
  for (int i = 0; i < 12; ++i) {
    const Vector18d step = 1e-6 * Vector18d::Unit(i);
    J.col(i) = (to_paper_state(moved_by(state, step)).s - to_paper_state(moved_by(state, -step)).s) / 2e-6;
  }
  const Matrix13d expected = J * state.covariance.topLeftCorner<12, 12>() * J.transpose();
  EXPECT_LT((to_paper_state(state).P - expected).cwiseAbs().maxCoeff(), 1e-7);
}

// The pixel does not depend on the quaternion's length, so normalising it in the difference changes nothing.
Eigen::Vector2d pixel_of(const Camera& camera, const Vector13d& s, const Eigen::Vector3d& p_world) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(s(3), s(4), s(5), s(6)).normalized();
  return project(camera, q * (p_world - s.head<3>()))->pixel;
}

TEST(PaperMeasurementJacobian, IsTheDerivative) {
  test::RandomGeometry random(kSeed);
  const Camera camera = test::vga_camera();
  for (int trial = 0; trial < 10; ++trial) {
    const MotionState state = test::random_unaccelerated_state(random, 0.1);
    const Eigen::Vector3d p_camera(random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), random.uniform(2, 4));
    const Eigen::Vector3d p_world = state.T_world_body * p_camera;
    const Vector13d s = to_paper_state(state).s;
    const auto H = paper_measurement_jacobian(camera, s, p_world);
    for (int i = 0; i < 13; ++i) {
      const Vector13d step = 1e-6 * Vector13d::Unit(i);
      const Eigen::Vector2d expected =
          (pixel_of(camera, s + step, p_world) - pixel_of(camera, s - step, p_world)) / 2e-6;
      EXPECT_LT((H.col(i) - expected).norm(), 1e-4) << "column " << i << ", trial " << trial << ", seed " << kSeed;
    }
  }
}

TEST(PaperMeasurementJacobian, IsZeroBehindTheCamera) {
  const Vector13d s = to_paper_state(MotionState{}).s;
  EXPECT_TRUE(paper_measurement_jacobian(test::vga_camera(), s, {0, 0, -2}).isZero());
}

class PaperFilter : public testing::Test {
 protected:
  PaperFilter() {
    predicted_ = resting_state({}, map_.keyframes[0].T_world_camera, 1e-4 * Matrix6d::Identity(), 1.0, 1.0);
    predicted_ = predict(predicted_, predicted_.time + from_seconds(0.03), {isotropic_noise(1, 1), Matrix6d::Zero()});
    Vector6d off;
    off << 0.005, -0.0025, 0.005, 0.001, 0.0015, -0.001;
    predicted_.T_world_body = predicted_.T_world_body * perturbation(off);
  }

  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  PointMap map_ = test::make_map(camera_, 60, 1, 0.5, random_);
  MotionState predicted_;
};

// Near the prediction one additive step is as good as the iterated one: within a twentieth of a standard deviation.
TEST_F(PaperFilter, IsNearTheIteratedUpdate) {
  const auto observations = test::observations_of(map_, 0);
  PoseUpdateOptions options;
  options.map_uncertainty = MapUncertainty::Ignored;
  const PosePrior prior{predicted_.T_world_body, predicted_.covariance.topLeftCorner<6, 6>().inverse()};
  const auto exact = update_pose(camera_, prior, observations, options);
  ASSERT_TRUE(exact);
  ASSERT_EQ(exact->inlier_count, static_cast<int>(observations.size()));
  const MotionState state = update_paper_filter(camera_, predicted_, observations);
  const Vector6d off = difference(exact->T_world_camera, state.T_world_body);
  EXPECT_LT(std::sqrt(off.dot(exact->covariance.inverse() * off)), 0.05);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> ratios(state.covariance.topLeftCorner<6, 6>(),
                                                                  exact->covariance);
  EXPECT_GT(ratios.eigenvalues().minCoeff(), 0.95);
  EXPECT_LT(ratios.eigenvalues().maxCoeff(), 1.05);
}

// The velocities follow the pose as in absorb.
TEST_F(PaperFilter, MovesTheVelocitiesAlong) {
  const MotionState state = update_paper_filter(camera_, predicted_, test::observations_of(map_, 0));
  const MotionState expected = absorb(predicted_, state.T_world_body, state.covariance.topLeftCorner<6, 6>());
  EXPECT_GT(expected.v_world.norm(), 0.05);
  EXPECT_LT((state.v_world - expected.v_world).norm(), 0.02 * expected.v_world.norm());
  EXPECT_LT((state.omega_body - expected.omega_body).norm(), 0.02 * expected.omega_body.norm());
}

TEST_F(PaperFilter, StaysWithoutSightings) {
  const MotionState state = update_paper_filter(camera_, predicted_, {});
  EXPECT_LT(error_between(predicted_, state).norm(), 1e-9);
  EXPECT_LT((state.covariance - predicted_.covariance).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace alidade
