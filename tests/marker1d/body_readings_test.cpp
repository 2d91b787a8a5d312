// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_readings.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "datasets/body_scene.h"
#include "tests/support/motion_states.h"

namespace alidade {
namespace {

// A body in the middle of the scene that moves and turns in every way, and readings of it over 4 ms.
class BodyReadingsTest : public testing::Test {
 protected:
  BodyReadingsTest() : scene_(BodySceneOptions{}), detectors_(scene_.detectors()) {
    state_.time = Timestamp(std::chrono::milliseconds(2));
    state_.T_world_body = pose_in_scene(0, state_.time);
    state_.v_world = {0.7, -0.4, 0.3};
    state_.omega_body = {1.0, 2.0, -1.5};
    state_.a_world = {5, -3, 2};
    state_.alpha_body = {10, 20, -5};
    int k = 0;
    for (const LineDetector& d : scene_.detectors()) {
      for (const BodyMarker& m : scene_.bodies().front().markers) {
        readings_.push_back({Timestamp(std::chrono::microseconds(100 * (k++ % 40))), d.id, m.id, 0.01 * k, 1e-4});
      }
    }
  }

  BodyReadings readings(double variance_factor = 1.0) const {
    return BodyReadings(detectors_, scene_.bodies().front(), readings_, variance_factor);
  }

  BodyScene scene_;
  DetectorArray detectors_;
  MotionState state_;
  std::vector<LineReading> readings_;
};

// gradient = Jᵀ r: its derivative along an error, with J held, is -information; checked through the residuals.
TEST_F(BodyReadingsTest, HasTheDerivativesOfItsResiduals) {
  BodyReadings z = readings();
  z.linearise(state_);
  const MotionLikelihood sum = z.weighted_sum(Eigen::ArrayXd::Ones(z.size()));
  const Eigen::VectorXd r = z.residuals();
  for (int k = 0; k < 18; ++k) {
    const double step = k < 6 ? 1e-6 : k < 12 ? 1e-4 : 1e-1;
    BodyReadings plus = readings(), minus = readings();
    plus.linearise(moved_by(state_, step * Vector18d::Unit(k)));
    minus.linearise(moved_by(state_, -step * Vector18d::Unit(k)));
    const Eigen::VectorXd slope = (minus.residuals() - plus.residuals()) / (2 * step);
    EXPECT_NEAR(slope.squaredNorm() / sum.information(k, k), 1.0, 1e-6) << "component " << k;
    EXPECT_NEAR(slope.dot(r), sum.gradient(k), 1e-5 * slope.norm() * r.norm()) << "component " << k;
  }
}

TEST_F(BodyReadingsTest, OfOneMomentSpeakOfThePoseAlone) {
  for (LineReading& r : readings_) r.time = state_.time;
  BodyReadings z = readings();
  z.linearise(state_);
  EXPECT_TRUE(z.is_of_pose_at(state_.time));
  EXPECT_FALSE(z.is_of_pose_at(state_.time + std::chrono::milliseconds(1)));
  const MotionLikelihood sum = z.weighted_sum(Eigen::ArrayXd::Ones(z.size()));
  EXPECT_EQ(sum.information.bottomRows<12>().norm(), 0.0);
}

TEST_F(BodyReadingsTest, CountLessTheLessTheyAreTrusted) {
  BodyReadings one = readings(1.0), four = readings(4.0);
  one.linearise(state_);
  four.linearise(state_);
  EXPECT_NEAR((one.chi2() / four.chi2() - 4.0).abs().maxCoeff(), 0.0, 1e-9);
}

// (I + ½ b bᵀ)⁻¹ by a direct inverse.
TEST_F(BodyReadingsTest, ShareTheNoiseOfTheirBend) {
  BodyReadings z = readings();
  z.linearise(state_);
  const auto n = z.size();
  const Eigen::MatrixXd bends = Eigen::MatrixXd::Random(n, 2);
  const Eigen::ArrayXd all = Eigen::ArrayXd::Ones(n);
  const MotionLikelihood sum = z.weighted_sum(all, bends), none = z.weighted_sum(all, Eigen::MatrixXd::Zero(n, 1));
  EXPECT_LT((none.information - z.weighted_sum(all).information).norm(), 1e-12 * none.information.norm());
  const Eigen::MatrixXd lost = none.information - sum.information;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> less(lost);
  EXPECT_GT(less.eigenvalues().minCoeff(), -1e-9 * none.information.norm());
  EXPECT_GT(less.eigenvalues().maxCoeff(), 0.0);
}

TEST_F(BodyReadingsTest, RefusesWhatIsNotThere) {
  const std::vector<LineReading> unknown_marker{{state_.time, 0, 99, 0.0, 0.0}}, unknown_detector{{state_.time, 99, 0}};
  EXPECT_THROW(BodyReadings(detectors_, scene_.bodies().front(), unknown_marker, 1.0), std::invalid_argument);
  EXPECT_THROW(BodyReadings(detectors_, scene_.bodies().front(), unknown_detector, 1.0), std::invalid_argument);
  std::vector<LineDetector> twice = scene_.detectors();
  twice.push_back(twice.front());
  EXPECT_THROW(DetectorArray{twice}, std::invalid_argument);
}

}  // namespace
}  // namespace alidade
