// SPDX-License-Identifier: Apache-2.0
#include "estimation/motion_likelihood.h"

#include <gtest/gtest.h>

#include "estimation/motion_step.h"
#include "tests/support/motion_states.h"

namespace alidade {
namespace {

class MotionLikelihoodTest : public testing::Test {
 protected:
  // A state with all its parts correlated, sigmas of about 2 cm, 5 mrad, 0.1 m/s, 0.05 rad/s, 1 m/s² and 1 rad/s².
  MotionState belief() {
    MotionState state = test::random_state(random_, 0.01);
    Vector18d sigmas;
    sigmas << Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.005), Eigen::Vector3d::Constant(0.1),
        Eigen::Vector3d::Constant(0.05), Vector6d::Constant(1.0);
    state.covariance = sigmas.asDiagonal() * correlation() * sigmas.asDiagonal();
    return state;
  }

  Matrix18d correlation() {
    Matrix18d A;
    for (double& a : A.reshaped()) a = random_.normal();
    return 0.5 * Matrix18d::Identity() + 0.5 / 18.0 * A * A.transpose();
  }

  // Measurements of precision 1 / sigma², all of the state or the pose alone.
  MotionLikelihood measured(const MotionState& at, int rows, double sigma) {
    MotionLikelihood z;
    z.at = at;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(40, 18);
    for (double& j : J.leftCols(rows).reshaped()) j = random_.normal();
    Eigen::VectorXd residual(40);
    for (double& r : residual) r = sigma * random_.normal();
    z.information = J.transpose() * J / (sigma * sigma);
    z.gradient = J.transpose() * residual / (sigma * sigma);
    return z;
  }

  test::RandomGeometry random_{7};
};

TEST_F(MotionLikelihoodTest, HasARootOfItsCovariance) {
  const Matrix18d P = belief().covariance;
  const Matrix18d L = covariance_root(P);
  EXPECT_LT((L * L.transpose() - P).norm(), 1e-9 * P.norm());
  EXPECT_TRUE(covariance_root(Matrix18d::Zero()).allFinite());
}

TEST_F(MotionLikelihoodTest, ResetsAnErrorByItsDerivative) {
  const MotionState state = belief();
  Vector18d e = 0.1 * Vector18d::Ones();
  const Matrix18d J = reset_jacobian(e);
  const double step = 1e-6;
  for (int k = 0; k < 18; ++k) {
    const Vector18d d = step * Vector18d::Unit(k);
    const Vector18d moved = (error_between(moved_by(state, e), moved_by(state, e + d)) -
                             error_between(moved_by(state, e), moved_by(state, e - d))) /
                            (2 * step);
    EXPECT_LT((moved - J.col(k)).norm(), 1e-8) << "component " << k;
  }
}

// log p at a state is the same number whichever state the error is counted from, up to the constant: its differences
// between two states are compared.
TEST_F(MotionLikelihoodTest, IsTheSameAboutAnotherState) {
  const MotionState at = belief();
  const MotionLikelihood z = measured(at, 18, 1e-3);
  const MotionState other = moved_by(at, 1e-3 * Vector18d::Ones());
  const MotionLikelihood moved = about(other, z);
  const auto log_p = [](const MotionLikelihood& l, const MotionState& state) {
    const Vector18d e = error_between(l.at, state);
    return l.gradient.dot(e) - 0.5 * e.dot(l.information * e);
  };
  const MotionState a = moved_by(at, -1e-3 * Vector18d::Ones()), b = moved_by(at, 2e-3 * Vector18d::Unit(4));
  EXPECT_NEAR(log_p(z, a) - log_p(z, b), log_p(moved, a) - log_p(moved, b), 1e-2 * std::abs(log_p(z, a)));
}

TEST_F(MotionLikelihoodTest, OfThePoseAloneUpdatesAsThePosesLikelihoodDoes) {
  const MotionState predicted = belief();
  const MotionState seen = moved_by(predicted, 1e-3 * Vector18d::Ones());
  const MotionLikelihood z = measured(seen, 6, 1e-2);
  PoseLikelihood pose;
  pose.T_world_body = seen.T_world_body;
  pose.information = z.information.topLeftCorner<6, 6>();
  pose.gradient = z.gradient.head<6>();
  const MotionState a = absorb(predicted, z), b = absorb(predicted, pose);
  EXPECT_LT(error_between(a, b).norm(), 1e-9);
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-8 * a.covariance.norm());
}

// The posterior of a linear Gaussian problem: P⁻¹ + Λ.
TEST_F(MotionLikelihoodTest, AddsItsInformationToTheStates) {
  const MotionState predicted = belief();
  MotionLikelihood z = measured(predicted, 18, 1e-2);
  z.gradient.setZero();
  const Matrix18d expected = (predicted.covariance.inverse() + z.information).inverse();
  const MotionState state = absorb(predicted, z);
  EXPECT_LT(error_between(predicted, state).norm(), 1e-12);
  EXPECT_LT((state.covariance - expected).norm(), 1e-8 * expected.norm());
}

TEST_F(MotionLikelihoodTest, SpeaksForTheModeThatItIsOf) {
  MotionState state = belief();
  state.covariance *= 1e-6;
  const MotionProcess motion{{{Matrix6d::Zero(), isotropic_noise(1, 1)}, 0.5},
                             {{Matrix6d::Zero(), isotropic_noise(1e5, 1e5)}, 0.5}};
  const Timestamp time = state.time + from_seconds(0.01);
  MotionState seen = predict_without_noise(state, time);
  MotionLikelihood z = measured(seen, 18, 1e-4);
  z.gradient.setZero();
  EXPECT_GT(absorb(state, time, motion, z).mode_weight[0], 0.99);
  z.at = moved_by(seen, 0.05 * Vector18d::Unit(0));
  EXPECT_LT(absorb(state, time, motion, z).mode_weight[0], 0.01);
}

}  // namespace
}  // namespace alidade
