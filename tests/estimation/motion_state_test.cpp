// SPDX-License-Identifier: Apache-2.0
#include "estimation/motion_state.h"

#include <cmath>
#include <functional>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "tests/support/motion_states.h"

namespace alidade {
namespace {

// What is expected is computed at dynamic size: one set of expressions to compile, for matrices of every size.
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr unsigned kSeed = 53;

Timestamp after(const MotionState& state, double seconds) {
  return state.time + from_seconds(seconds);
}

double largest_difference(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

// The derivative of f at zero, by central differences.
MatrixXd derivative(const std::function<VectorXd(const VectorXd&)>& f, int size, double step) {
  MatrixXd J(f(VectorXd::Zero(size)).size(), size);
  for (int i = 0; i < size; ++i) {
    VectorXd x = VectorXd::Zero(size);
    x(i) = step;
    const VectorXd ahead = f(x);
    x(i) = -step;
    J.col(i) = (ahead - f(x)) / (2 * step);
  }
  return J;
}

// How the error of a state moves with that of the state `from` it was made.
MatrixXd derivative_of(const std::function<MotionState(const MotionState&)>& made, const MotionState& from) {
  const MotionState still = made(from);
  return derivative([&](const VectorXd& x) { return error_between(still, made(moved_by(from, x))); }, 18, 1e-6);
}

Vector6d draw(test::RandomGeometry& random, double sigma_m, double sigma_rad) {
  Vector6d xi;
  xi << random.vector(sigma_m), random.vector(sigma_rad);
  return xi;
}

TEST(MoveMotionState, IsUndoneByTheErrorBetween) {
  test::RandomGeometry random(kSeed);
  const MotionState state = test::random_state(random, 0.1);
  Vector18d error;
  for (double& value : error) value = random.normal(0.3);
  const MotionState moved = moved_by(state, error);
  EXPECT_LT((error_between(state, moved) - error).norm(), 1e-12);
  EXPECT_LT((moved.T_world_body.translation() - state.T_world_body * error.head<3>()).norm(), 1e-12);
  EXPECT_LT((moved.alpha_body - state.alpha_body - error.tail<3>()).norm(), 1e-12);
}

TEST(PredictMotion, MovesWithConstantVelocity) {
  MotionState state;
  state.v_world = {1, -2, 0.5};
  state.omega_body = {0, 0, 0.4};
  state.T_world_body.linear() = exp_so3(Eigen::Vector3d(0.3, 0, 0));
  const MotionState next = predict(state, after(state, 0.5), {});
  EXPECT_LT((next.T_world_body.translation() - Eigen::Vector3d(0.5, -1, 0.25)).norm(), 1e-12);
  const Eigen::Matrix3d R = state.T_world_body.linear() * exp_so3(Eigen::Vector3d(0, 0, 0.2));
  EXPECT_LT((next.T_world_body.linear() - R).norm(), 1e-12);
  EXPECT_EQ(next.v_world, state.v_world);
  EXPECT_EQ(next.omega_body, state.omega_body);
  EXPECT_EQ(next.time, after(state, 0.5));
}

// From rest with 2 m/s² and 0.8 rad/s² for half a second: 1 m/s and 0.4 rad/s, a quarter of a metre and 0.1 rad.
TEST(PredictMotion, GathersSpeedWithConstantAcceleration) {
  MotionState state;
  state.a_world = {0, 2, 0};
  state.alpha_body = {0.8, 0, 0};
  const MotionState next = predict(state, after(state, 0.5), {});
  EXPECT_LT((next.v_world - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((next.omega_body - Eigen::Vector3d(0.4, 0, 0)).norm(), 1e-12);
  EXPECT_LT((next.T_world_body.translation() - Eigen::Vector3d(0, 0.25, 0)).norm(), 1e-12);
  EXPECT_LT((next.T_world_body.linear() - exp_so3(Eigen::Vector3d(0.1, 0, 0))).norm(), 1e-12);
  EXPECT_EQ(next.a_world, state.a_world);
  EXPECT_EQ(next.alpha_body, state.alpha_body);
}

TEST(PredictMotion, HasTheTransitionJacobianAsItsDerivative) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    const MotionState state = test::random_state(random, 0.1);
    const auto next = [](const MotionState& from) { return predict(from, after(from, 0.3), {}); };
    const MatrixXd F = transition_jacobian(state, next(state));
    EXPECT_LT(largest_difference(F, derivative_of(next, state)), 1e-8) << "seed " << kSeed << ", trial " << trial;
  }
}

TEST(PredictMotion, CarriesTheCovariancesByItsDerivative) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    MotionState state = test::random_state(random, 0.1);
    for (double& value : state.map_offset.cross.reshaped()) value = random.normal(0.1);
    state.map_offset.covariance = 0.04 * Matrix6d::Identity();
    const auto next = [](const MotionState& from) { return predict(from, after(from, 0.3), {}); };
    const MatrixXd F = derivative_of(next, state), P = state.covariance, cross = state.map_offset.cross;
    const MotionState made = next(state);
    EXPECT_LT(largest_difference(made.covariance, F * P * F.transpose()), 1e-7)
        << "seed " << kSeed << ", trial " << trial;
    EXPECT_LT(largest_difference(made.map_offset.cross, F * cross), 1e-8);
    EXPECT_EQ(made.map_offset.covariance, state.map_offset.covariance);
  }
}

// The covariance that noise of a kind brings to a state without any, by central differences of what drives it.
MatrixXd brought(const MatrixXd& noise, const std::function<MotionState(const Vector6d&)>& driven_by) {
  const MotionState still = driven_by(Vector6d::Zero());
  const MatrixXd G = derivative([&](const VectorXd& x) { return error_between(still, driven_by(x)); }, 6, 1e-5);
  return G * noise * G.transpose();
}

TEST(PredictMotion, AddsTheAccelerationsByTheirDerivative) {
  test::RandomGeometry random(kSeed);
  MotionState state = test::random_state(random, 0.1);
  state.covariance.setZero();
  const Matrix6d noise = test::random_covariance(random, 6, 2.0);
  const auto driven_by = [&](const Vector6d& a) { return test::driven(state, 0.3, a, Vector6d::Zero()); };
  const MotionState next = predict(state, after(state, 0.3), {noise, Matrix6d::Zero()});
  EXPECT_LT(largest_difference(next.covariance, brought(noise, driven_by)), 1e-8) << "seed " << kSeed;
  EXPECT_GT(next.covariance.diagonal().head(6).minCoeff(), 1e-3);
}

TEST(PredictMotion, AddsTheJerksByTheirDerivative) {
  test::RandomGeometry random(kSeed);
  MotionState state = test::random_state(random, 0.1);
  state.covariance.setZero();
  const Matrix6d noise = test::random_covariance(random, 6, 20.0);
  const auto driven_by = [&](const Vector6d& j) { return test::driven(state, 0.3, Vector6d::Zero(), j); };
  const MotionState next = predict(state, after(state, 0.3), {Matrix6d::Zero(), noise});
  EXPECT_LT(largest_difference(next.covariance, brought(noise, driven_by)), 1e-6) << "seed " << kSeed;
  EXPECT_GT(next.covariance.diagonal().head(6).minCoeff(), 1e-3);
}

TEST(PredictMotion, AddsTheJumpsByTheirDerivative) {
  test::RandomGeometry random(kSeed);
  MotionState state = test::random_state(random, 0.1);
  state.covariance.setZero();
  const Matrix6d noise = test::random_covariance(random, 6, 2.0), none = Matrix6d::Zero();
  const auto driven_by = [&](const Vector6d& jump) {
    return test::driven(test::jumped(state, jump), 0.3, Vector6d::Zero(), Vector6d::Zero());
  };
  const MotionState next = predict(state, after(state, 0.3), {none, none, noise});
  EXPECT_LT(largest_difference(next.covariance, brought(noise, driven_by)), 1e-6) << "seed " << kSeed;
  EXPECT_GT(next.covariance.diagonal().head(6).minCoeff(), 1e-3);
}

TEST(PredictMotion, IsTheSumOfItsParts) {
  test::RandomGeometry random(kSeed);
  const MotionState state = test::random_state(random, 0.1);
  const Timestamp time = after(state, 0.3);
  MotionNoise noise;
  noise.acceleration = test::random_covariance(random, 6, 2.0);
  noise.jerk = test::random_covariance(random, 6, 20.0);
  noise.jump = test::random_covariance(random, 6, 2.0);
  const MotionState whole = predict(state, time, noise), part = predict_without_noise(state, time);
  EXPECT_LT(error_between(whole, part).norm(), 1e-12);
  EXPECT_EQ(part.time, whole.time);
  const MatrixXd moved = part.covariance, added = noise_covariance(state, part, noise);
  EXPECT_LT(largest_difference(moved + added, whole.covariance), 1e-12);
}

TEST(PredictMotion, StaysForAnEarlierTime) {
  test::RandomGeometry random(kSeed);
  const MotionState state = test::random_state(random, 0.1);
  const MotionNoise noise{isotropic_noise(1, 1), isotropic_noise(1, 1)};
  const MotionState same = predict(state, after(state, -1.0), noise);
  EXPECT_LT((same.T_world_body.matrix() - state.T_world_body.matrix()).norm(), 1e-12);
  EXPECT_LT((same.covariance - state.covariance).norm(), 1e-12);
  EXPECT_EQ(same.time, state.time);
}

// The covariance of the error of a state that was corrected by `error`, as counted from where it is now.
MatrixXd recounted(const MotionState& predicted, const VectorXd& error, const MatrixXd& covariance) {
  const MotionState now = moved_by(predicted, error);
  const auto counted = [&](const VectorXd& x) { return error_between(now, moved_by(predicted, error + x)); };
  const MatrixXd J = derivative(counted, 18, 1e-6);
  return J * covariance * J.transpose();
}

// The sightings say that the pose is off by y, with H of the pose's perturbation and covariance R. K = P Hᵀ (H P Hᵀ +
// R)⁻¹, x = K y, (I - K H) P. The likelihood of H ξ = y + noise: information Hᵀ R⁻¹ H, gradient Hᵀ R⁻¹ y.
void expect_the_kalman_update(const MotionState& predicted, const MatrixXd& H_pose, const MatrixXd& R,
                              const VectorXd& y) {
  const MatrixXd WH = R.inverse() * H_pose;
  const MotionState state =
      absorb(predicted, PoseLikelihood{predicted.T_world_body, H_pose.transpose() * WH, WH.transpose() * y});

  MatrixXd H = MatrixXd::Zero(y.size(), 18);
  H.leftCols(6) = H_pose;
  const MatrixXd P = predicted.covariance, S = H * P * H.transpose() + R, K = P * H.transpose() * S.inverse();
  const VectorXd x = K * y;
  const MatrixXd P_after = recounted(predicted, x, P - K * H * P);
  EXPECT_GT(x.norm(), 1e-2);
  EXPECT_LT((error_between(predicted, state) - x).norm(), 1e-9);
  EXPECT_LT(largest_difference(state.covariance, P_after), 1e-8);
  EXPECT_EQ(state.covariance, Matrix18d(state.covariance.transpose()));
  EXPECT_EQ(state.time, predicted.time);
}

TEST(AbsorbSightings, IsTheKalmanUpdate) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", trial " << trial);
    const MotionState predicted = test::random_state(random, 0.1);
    const MatrixXd R = test::random_covariance(random, 6, 0.1);
    expect_the_kalman_update(predicted, MatrixXd::Identity(6, 6), R, draw(random, 0.1, 0.1));
  }
}

TEST(AbsorbSightings, IsTheKalmanUpdateWhereTheyDetermineThePoseInPart) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", trial " << trial);
    const MotionState predicted = test::random_state(random, 0.1);
    MatrixXd H(2, 6);
    for (double& value : H.reshaped()) value = random.normal();
    const MatrixXd R = test::random_covariance(random, 2, 0.1);
    expect_the_kalman_update(predicted, H, R, Eigen::Vector2d(random.normal(0.2), random.normal(0.2)));
  }
}

TEST(AbsorbSightings, LeavesTheStateWhereTheySayNothing) {
  test::RandomGeometry random(kSeed);
  const MotionState predicted = test::random_state(random, 0.1);
  const MotionState state = absorb(predicted, PoseLikelihood{random.pose(), Matrix6d::Zero(), Vector6d::Zero()});
  EXPECT_LT(error_between(predicted, state).norm(), 1e-12);
  EXPECT_LT(largest_difference(state.covariance, predicted.covariance), 1e-12);
}

// Half a radian from the prediction: what counts is where the likelihood has its greatest value and how wide it is
// there.
TEST(AbsorbSightings, TakesOverThePoseOfSightingsThatAreFarSurer) {
  test::RandomGeometry random(kSeed);
  MotionState predicted = test::random_state(random, 1e3);
  PoseLikelihood sightings;
  sightings.T_world_body = predicted.T_world_body * perturbation(draw(random, 0.5, 0.3));
  const MatrixXd R = test::random_covariance(random, 6, 0.1);
  sightings.information = R.inverse();
  const MotionState state = absorb(predicted, sightings);
  EXPECT_LT(difference(sightings.T_world_body, state.T_world_body).norm(), 1e-5);
  EXPECT_LT(largest_difference(state.covariance.topLeftCorner<6, 6>(), R), 1e-5);
}

// The same sightings, written about two poses: g' = g - W ξ where the perturbation is small.
TEST(AbsorbSightings, DoesNotDependOnThePoseThatTheyAreWrittenAbout) {
  test::RandomGeometry random(kSeed);
  const MotionState predicted = test::random_state(random, 0.1);
  const Matrix6d W = test::random_covariance(random, 6, 0.1).inverse();
  const Vector6d g = W * draw(random, 1e-4, 1e-4), xi = draw(random, 1e-4, 1e-4);
  const MotionState here = absorb(predicted, PoseLikelihood{predicted.T_world_body, W, g});
  const MotionState there = absorb(predicted, PoseLikelihood{predicted.T_world_body * perturbation(xi), W, g - W * xi});
  EXPECT_GT(error_between(predicted, here).norm(), 1e-4);
  EXPECT_LT(error_between(here, there).norm(), 1e-6);
}

// A map that lies displaced by an offset (translation, rotation vector about the centre) shows a camera at this pose.
Eigen::Isometry3d shown_by(const MapOffset& offset, const Vector6d& by, const Eigen::Isometry3d& T_world_camera) {
  Eigen::Isometry3d T_true_map = Eigen::Isometry3d::Identity();  // p_true = T_true_map * p_map
  T_true_map.linear() = exp_so3(by.tail<3>());
  T_true_map.translation() = offset.centre_world + by.head<3>() - T_true_map.linear() * offset.centre_world;
  return T_true_map.inverse() * T_world_camera;
}

// How the pose in the map moves with the errors of state and offset, stacked: 6×24.
MatrixXd jacobian_in_map(const MotionState& state) {
  const auto shown = [&](const VectorXd& x) {
    return difference(state.T_world_body, shown_by(state.map_offset, x, state.T_world_body));
  };
  MatrixXd H = MatrixXd::Zero(6, 24);
  H.leftCols(6).setIdentity();
  H.rightCols(6) = derivative(shown, 6, 1e-6);
  return H;
}

// P: the covariance of the stack, 24×24.
MotionState random_state_with_offset(test::RandomGeometry& random, MatrixXd& P) {
  MotionState state = test::random_state(random, 0.1);
  P = test::random_covariance(random, 24, 0.1);
  state.covariance = P.topLeftCorner(18, 18);
  state.map_offset = {random.vector(), P.bottomRightCorner(6, 6), P.topRightCorner(18, 6)};
  return state;
}

TEST(MapOffset, AddsToTheCovarianceOfThePoseInTheMap) {
  test::RandomGeometry random(kSeed);
  MatrixXd P;
  const MotionState state = random_state_with_offset(random, P);
  const MatrixXd H = jacobian_in_map(state);
  EXPECT_LT(largest_difference(covariance_in_map(state), H * P * H.transpose()), 1e-8) << "seed " << kSeed;
  MotionState alone = state;
  alone.map_offset = {};
  EXPECT_EQ(covariance_in_map(alone), Matrix6d(state.covariance.topLeftCorner<6, 6>()));
}

// Schmidt's filter over the stack of state and offset: K = P Hᵀ (H P Hᵀ + R)⁻¹ with the offset's rows zeroed, then
// Joseph's form. The innovation is small, so that what is counted from the new pose is the same.
TEST(AbsorbSightings, ConsidersTheMapOffset) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    MatrixXd P;
    const MotionState predicted = random_state_with_offset(random, P);
    const MatrixXd R = test::random_covariance(random, 6, 0.1), W = R.inverse();
    const VectorXd y = draw(random, 1e-4, 1e-4);
    const PoseLikelihood sightings{predicted.T_world_body, W, W * y};
    const MotionState state = absorb(predicted, sightings);

    const MatrixXd H = jacobian_in_map(predicted), S = H * P * H.transpose() + R;
    MatrixXd K = P * H.transpose() * S.inverse();
    K.bottomRows(6).setZero();
    const MatrixXd rest = MatrixXd::Identity(24, 24) - K * H;
    const MatrixXd P_after = rest * P * rest.transpose() + K * R * K.transpose();
    const VectorXd x = (K * y).head(18);
    EXPECT_LT((error_between(predicted, state) - x).norm(), 1e-4 * x.norm()) << "seed " << kSeed << ", trial " << trial;
    EXPECT_LT(largest_difference(state.covariance, P_after.topLeftCorner(18, 18)), 1e-4);
    EXPECT_LT(largest_difference(state.map_offset.cross, P_after.topRightCorner(18, 6)), 1e-4);
    EXPECT_EQ(state.map_offset.covariance, predicted.map_offset.covariance);
    EXPECT_EQ(state.map_offset.centre_world, predicted.map_offset.centre_world);
  }
}

// log N(y; 0, P + R) of the innovation y, less its constant.
double log_density(const VectorXd& y, const MatrixXd& S) {
  return -0.5 * (y.dot(S.inverse() * y) + std::log(S.determinant()));
}

TEST(LogEvidence, IsTheDensityOfTheInnovation) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    MatrixXd P;
    const MotionState one = random_state_with_offset(random, P);
    MotionState other = one;
    other.covariance = test::random_covariance(random, 18, 0.1);
    other.map_offset = {};
    other.T_world_body = one.T_world_body * perturbation(draw(random, 0.3, 0.0));
    const MatrixXd R = test::random_covariance(random, 6, 0.1), W = R.inverse();
    const VectorXd y = draw(random, 0.3, 0.3), between = difference(other.T_world_body, one.T_world_body);
    const PoseLikelihood sightings{one.T_world_body, W, W * y};
    const double evidence = log_evidence(one, sightings) - log_evidence(other, sightings);
    const MatrixXd P_one = covariance_in_map(one), P_other = covariance_in_map(other);
    const double expected = log_density(y, P_one + R) - log_density(y + between, P_other + R);
    EXPECT_NEAR(evidence, expected, 1e-7 * std::abs(expected)) << "seed " << kSeed << ", trial " << trial;
  }
}

// Two of six directions measured: the density is that of the two.
TEST(LogEvidence, CountsOnlyWhatTheSightingsMeasure) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    MotionState predicted = test::random_state(random, 0.1);
    MatrixXd H(2, 6);
    for (double& value : H.reshaped()) value = random.normal();
    const MatrixXd R = test::random_covariance(random, 2, 0.1), WH = R.inverse() * H;
    const VectorXd y = Eigen::Vector2d(random.normal(0.3), random.normal(0.3));
    const PoseLikelihood sightings{predicted.T_world_body, H.transpose() * WH, WH.transpose() * y};
    double evidence[2], expected[2];
    for (int k = 0; k < 2; ++k) {
      const MatrixXd P = predicted.covariance.topLeftCorner<6, 6>();
      evidence[k] = log_evidence(predicted, sightings);
      expected[k] = log_density(y, H * P * H.transpose() + R);
      predicted.covariance *= 4;
    }
    EXPECT_NEAR(evidence[1] - evidence[0], expected[1] - expected[0], 1e-7) << "seed " << kSeed << ", trial " << trial;
  }
}

// z = pose + noise with H = [I 0]: K = P Hᵀ (H P Hᵀ + R)⁻¹, x + K y, (I - K H) P.
TEST(AbsorbPose, IsTheKalmanUpdate) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 5; ++trial) {
    const MotionState predicted = test::random_state(random, 0.1);
    const MatrixXd R = test::random_covariance(random, 6, 0.1);
    const VectorXd y = draw(random, 0.1, 0.1);
    const MatrixXd P = predicted.covariance, S = P.topLeftCorner(6, 6) + R, K = P.leftCols(6) * S.inverse();
    const MatrixXd P_after = P - K * P.topRows(6);
    const VectorXd x = K * y;
    const MotionState state =
        absorb(predicted, predicted.T_world_body * perturbation(x.head(6)), P_after.topLeftCorner(6, 6));
    EXPECT_LT((error_between(predicted, state) - x).norm(), 1e-8) << "seed " << kSeed << ", trial " << trial;
    EXPECT_LT(largest_difference(state.covariance, P_after), 1e-9);
    EXPECT_EQ(state.covariance, Matrix18d(state.covariance.transpose()));
  }
}

// From 1 to 2 m/s and 0 to 0.3 rad/s within 0.1 s: mean squares of 2/3 (10 m/s²)² and 2/3 (3 rad/s²)².
TEST(AdaptMotionNoise, BlendsInTheChangeOfVelocity) {
  MotionState before, now;
  before.v_world = {1, 0, 0};
  now.v_world = {2, 0, 0};
  now.omega_body = {0, 0.3, 0};
  now.time = after(before, 0.1);
  const MotionNoise noise = adapt({isotropic_noise(4, 2), isotropic_noise(5, 6)}, before, now, 0.25);
  const Matrix6d expected = isotropic_noise(std::sqrt(0.75 * 16 + 0.25 * 100 * 2 / 3),  //
                                            std::sqrt(0.75 * 4 + 0.25 * 9 * 2 / 3));
  EXPECT_LT(largest_difference(noise.acceleration, expected), 1e-9);
  EXPECT_EQ(noise.jerk, isotropic_noise(5, 6));
}

TEST(AdaptMotionNoise, CalmsDownButNotToZero) {
  const MotionNoise noise{isotropic_noise(4, 2), Matrix6d::Zero()};
  MotionState before, now;
  now.time = after(before, 0.1);
  EXPECT_LT((adapt(noise, before, now, 0.25).acceleration - 0.75 * noise.acceleration).norm(), 1e-9);
  EXPECT_LT((adapt(noise, before, now, 1.0).acceleration - 1e-4 * noise.acceleration).norm(), 1e-9);
  now.time = before.time;
  now.v_world = {5, 0, 0};
  EXPECT_EQ(adapt(noise, before, now, 0.25).acceleration, noise.acceleration);
}

TEST(RestingState, KnowsNothingOfTheVelocities) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d T = random.pose();
  const Matrix6d P = 0.5 * Matrix6d::Identity();
  const MotionState state = resting_state(Timestamp(from_seconds(3)), T, P, 2.0, 0.3);
  EXPECT_EQ(state.T_world_body.matrix(), T.matrix());
  EXPECT_EQ(to_seconds(state.time.time_since_epoch()), 3.0);
  EXPECT_TRUE(state.v_world.isZero() && state.omega_body.isZero());
  EXPECT_TRUE(state.a_world.isZero() && state.alpha_body.isZero());
  Vector18d variances;
  variances << Vector6d::Constant(0.5), Eigen::Vector3d::Constant(4), Eigen::Vector3d::Constant(0.09), Vector6d::Zero();
  EXPECT_LT((state.covariance - Matrix18d(variances.asDiagonal())).norm(), 1e-12);
}

}  // namespace
}  // namespace alidade
