// SPDX-License-Identifier: Apache-2.0
#include "tracking/slam_filter.h"

#include <array>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/tracking/simulated_motion.h"
#include "tracking/unscented_filter.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 73;
constexpr int kPoints = 20;

class SlamFilter : public testing::Test {
 protected:
  SlamFilter() {
    camera_ = test::belief_before_points(0.0);
    camera_.covariance *= 1e-4;  // so that pixels are linear over it
  }

  // The points as they are, each with the same covariance (m) and none in common.
  SlamState state(double sigma_m) const {
    std::vector<SlamPoint> points;
    for (const MapPoint& p : simulated_.points) {
      points.push_back({p.p_world, sigma_m * sigma_m * Eigen::Matrix3d::Identity(), {}});
    }
    return with_points(slam_state(camera_), points);
  }

  std::vector<SlamSighting> sightings() {
    std::vector<SlamSighting> sightings;
    const auto seen = test::sightings_from(simulated_.camera, simulated_.points, camera_.T_world_body, 0.1, random_);
    for (const Sighting& s : seen) sightings.push_back({s.point, s.pixel, s.sigma_px});
    return sightings;
  }

  test::RandomGeometry random_{kSeed};
  test::SimulatedCamera simulated_ = test::simulated_camera(random_, kPoints);
  MotionState camera_;
};

TEST_F(SlamFilter, MeasuresByTheDerivative) {
  const SlamState at = state(0.1);
  const auto pixel_of = [&](const Eigen::Matrix<double, 9, 1>& step) {
    SlamState moved = at;
    moved.camera.T_world_body = at.camera.T_world_body * perturbation(step.head<6>());
    moved.points[3] += step.tail<3>();
    return expected_measurement(simulated_.camera, moved, 3)->pixel;
  };
  const auto expected = expected_measurement(simulated_.camera, at, 3);
  ASSERT_TRUE(expected);
  for (int i = 0; i < 9; ++i) {
    const Eigen::Matrix<double, 9, 1> step = 1e-6 * Eigen::Matrix<double, 9, 1>::Unit(i);
    const Eigen::Vector2d difference = (pixel_of(step) - pixel_of(-step)) / 2e-6;
    EXPECT_LT((expected->H.col(i) - difference).norm(), 1e-4) << "column " << i << ", seed " << kSeed;
  }
}

TEST_F(SlamFilter, MovesTheCameraAsWithoutAMap) {
  const MotionNoise noise{isotropic_noise(0.5, 0.2)};
  const Timestamp time = camera_.time + from_seconds(0.1);
  const SlamState next = predict(state(0.1), time, noise);
  const MotionState expected = predict(camera_, time, noise);
  EXPECT_LT(error_between(expected, camera_of(next)).norm(), 1e-12);
  EXPECT_LT((camera_of(next).covariance - expected.covariance).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(next.points, state(0.1).points);
}

// A map without covariance leaves the camera's filter.
TEST_F(SlamFilter, IsTheCamerasFilterInAMapThatIsExact) {
  const auto seen = sightings();
  std::vector<PointObservation> observations;
  for (const SlamSighting& s : seen) {
    PointObservation& o = observations.emplace_back();
    o.pixel = s.pixel;
    o.sigma_px = s.sigma_px;
    o.p_world = simulated_.points[static_cast<std::size_t>(s.point)].p_world;
  }
  const PosePrior prior{camera_.T_world_body, camera_.covariance.topLeftCorner<6, 6>().inverse()};
  PoseUpdateOptions options;
  options.gate_chi2 = 100;
  const auto exact = update_pose(simulated_.camera, prior, observations, options);
  ASSERT_TRUE(exact);
  const MotionState expected = absorb(camera_, exact->sightings);
  const MotionState updated = camera_of(update_slam_filter(simulated_.camera, state(0), seen));
  const auto sigmas = expected.covariance.diagonal().head<12>().cwiseSqrt();
  EXPECT_LT(error_between(expected, updated).head<12>().cwiseQuotient(sigmas).norm(), 1e-2) << "seed " << kSeed;
  EXPECT_LT((updated.covariance - expected.covariance).cwiseAbs().maxCoeff(),
            1e-3 * sigmas.maxCoeff() * sigmas.maxCoeff());
}

// Least squares over all that is known at once: information adds up, and its gradient moves the state.
TEST_F(SlamFilter, IsTheLeastSquaresSolutionOfCameraAndPoints) {
  SlamState before = state(0.002);
  const auto n = before.covariance.rows();
  before.covariance.block(0, 12, 6, 3).setConstant(1e-8);  // what they have in common counts too
  before.covariance.block(12, 0, 3, 6).setConstant(1e-8);
  Eigen::MatrixXd information = before.covariance.inverse();
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  const auto seen = sightings();
  for (const SlamSighting& s : seen) {
    const auto expected = expected_measurement(simulated_.camera, before, s.point).value();
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, n);
    H.leftCols<6>() = expected.H.leftCols<6>() / s.sigma_px;
    H.middleCols<3>(12 + 3 * s.point) = expected.H.rightCols<3>() / s.sigma_px;
    information += H.transpose() * H;
    gradient += H.transpose() * (s.pixel - expected.pixel) / s.sigma_px;
  }
  const Eigen::MatrixXd covariance = information.inverse();
  const Eigen::VectorXd error = covariance * gradient;
  const SlamState after = update_slam_filter(simulated_.camera, before, seen);
  EXPECT_LT((after.covariance - covariance).norm(), 1e-3 * covariance.norm());
  EXPECT_TRUE(after.covariance == after.covariance.transpose());
  EXPECT_LT((error_between(before.camera, after.camera).head<12>() - error.head<12>()).norm(), 1e-9);
  for (std::size_t j = 0; j < kPoints; ++j) {
    const auto row = 12 + 3 * static_cast<Eigen::Index>(j);
    EXPECT_LT((after.points[j] - before.points[j] - error.segment<3>(row)).norm(), 1e-9) << j;
  }
}

TEST_F(SlamFilter, LeavesOutWhatIsBehindTheCamera) {
  SlamState before = state(0.01);
  before.points[0] = camera_.T_world_body * Eigen::Vector3d(0, 0, -1);
  const std::array<SlamSighting, 1> seen{{{0, {300, 200}, 1.0}}};
  EXPECT_TRUE(update_slam_filter(simulated_.camera, before, seen).covariance == before.covariance);
}

TEST_F(SlamFilter, TakesPointsInAndDropsThem) {
  const SlamState before = state(0.1);
  SlamPoint point{{1, 2, 3}, Eigen::Matrix3d::Identity(), Eigen::MatrixX3d::Constant(before.covariance.rows(), 3, 0.5)};
  const SlamState more = with_points(before, {&point, 1});
  ASSERT_EQ(more.points.size(), kPoints + 1u);
  EXPECT_EQ(more.covariance.bottomLeftCorner(3, before.covariance.rows()), point.cross.transpose());
  EXPECT_TRUE(more.covariance == more.covariance.transpose());
  const std::array<int, 2> kept{kPoints, 0};
  const SlamState fewer = with_only_points(more, kept);
  EXPECT_EQ(fewer.points[0], point.p_world);
  EXPECT_EQ((fewer.covariance.block<3, 3>(12, 12)), point.covariance_world);
  EXPECT_EQ((fewer.covariance.block<3, 3>(12, 15)), Eigen::Matrix3d::Constant(0.5));
  point.cross = Eigen::MatrixX3d::Zero(5, 3);
  EXPECT_THROW(with_points(before, {&point, 1}), std::invalid_argument);
}

// A map that is off by what its covariance says, under a motion that is as the filter takes it to be. Over 60 trials
// the mean has mean 12 and variance 24/60: 99.9 % of means lie within 2.1 of 12.
TEST(SlamFilterConsistency, HoldsAndBeatsTheFilterThatTakesTheMapAsExact) {
  constexpr int kTrials = 60;
  constexpr double kMapSigmaM = 0.02;
  double nees = 0.0, square_in_state = 0.0, square_outside = 0.0;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    test::RandomGeometry random(kSeed + trial);
    test::SimulatedCamera simulated = test::simulated_camera(random, 40);
    simulated.noise = {isotropic_noise(0.5, 0.2)};
    MotionState outside = test::belief_before_points(0.0);
    std::vector<SlamPoint> points;
    for (const MapPoint& p : simulated.points) {
      points.push_back(
          {p.p_world + random.vector(kMapSigmaM), kMapSigmaM * kMapSigmaM * Eigen::Matrix3d::Identity(), {}});
    }
    SlamState in_state = with_points(slam_state(outside), points);
    const MotionState start = moved_by(outside, test::drawn(random, outside.covariance));
    const auto frames = simulated.recording(start, 20, random);
    for (const test::SimulatedFrame& frame : frames) {
      std::vector<SlamSighting> seen;
      std::vector<PointObservation> observations;
      for (const auto& s :
           test::sightings_from(simulated.camera, simulated.points, frame.truth.T_world_body, 0.5, random)) {
        seen.push_back({s.point, s.pixel, s.sigma_px});
        PointObservation& o = observations.emplace_back();
        o.pixel = s.pixel;
        o.sigma_px = s.sigma_px;
        o.p_world = points[static_cast<std::size_t>(s.point)].p_world;
      }
      in_state = update_slam_filter(simulated.camera, predict(in_state, frame.truth.time, simulated.noise), seen);
      outside =
          update_unscented_filter(simulated.camera, predict(outside, frame.truth.time, simulated.noise), observations);
      const Eigen::Vector3d& eye = frame.truth.T_world_body.translation();
      square_in_state += (in_state.camera.T_world_body.translation() - eye).squaredNorm();
      square_outside += (outside.T_world_body.translation() - eye).squaredNorm();
    }
    const Eigen::Matrix<double, 12, 1> off = error_between(in_state.camera, frames.back().truth).head<12>();
    nees += off.dot(in_state.covariance.topLeftCorner<12, 12>().ldlt().solve(off)) / kTrials;
  }
  EXPECT_NEAR(nees, 12.0, 2.1) << "seed " << kSeed;
  EXPECT_LT(square_in_state, 0.8 * square_outside);
}

}  // namespace
}  // namespace alidade
