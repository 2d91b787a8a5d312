// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/detector_calibration.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "datasets/body_scene.h"
#include "geometry/pose.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

constexpr double kSigma = 1e-4;  // rad

// The scene of the paper's page.
std::vector<LineDetector> three_blocks() {
  std::vector<LineDetector> detectors = BodyScene({}).detectors();
  for (LineDetector& d : detectors) d.sigma = kSigma;
  return detectors;
}

RigidBody tetrahedron() {
  return {"body", {{0, {0.15, 0.01, 0}}, {1, {-0.05, 0.14, 0.02}}, {2, {-0.06, -0.12, 0}}, {3, {0.01, 0, 0.16}}}};
}

Eigen::Isometry3d true_pose(double t) {
  return pose_in_scene(0, Timestamp(from_seconds(t)));
}

struct Recording {
  std::vector<LineDetector> truth, start;
  std::vector<LineReading> readings;
};

// All stations but the first stand 2 cm and 1° off; a share of the readings bears the id of another marker.
Recording record(unsigned seed, double wrong_ids, double duration_s = 1.0, double step_s = 0.016) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Recording r{three_blocks(), three_blocks(), {}};
  const RigidBody body = tetrahedron();
  for (int k = 1; k < 3; ++k) {
    Vector6d xi;
    for (int i = 0; i < 6; ++i) xi[i] = normal(random) * (i < 3 ? 0.02 : std::numbers::pi / 180) / std::sqrt(3.0);
    for (int i = 0; i < 4; ++i) {
      auto& T = r.start[static_cast<std::size_t>(4 * k + i)].T_world_station;
      T = T * perturbation(xi);
    }
  }
  for (double t = 0; t < duration_s; t += step_s) {
    for (std::size_t d = 0; d < r.truth.size(); ++d) {
      const double t_detector = t + 0.001 * static_cast<double>(d);
      for (const BodyMarker& marker : body.markers) {
        const auto projection = project(r.truth[d], Eigen::Vector3d(true_pose(t_detector) * marker.p_body));
        LineReading reading{Timestamp(from_seconds(t_detector)), r.truth[d].id, marker.id,
                            projection->value + kSigma * normal(random), 0.0};
        if (uniform(random) < wrong_ids) reading.marker = (marker.id + 1 + static_cast<int>(3 * uniform(random))) % 4;
        r.readings.push_back(reading);
      }
    }
  }
  return r;
}

// ξᵀ C⁻¹ ξ of the stations that moved, ξ from the estimate to the truth; its mean is 6 per station.
double nees(const DetectorCalibration& found, const Recording& recording) {
  double sum = 0;
  for (std::size_t i = 4; i < 12; i += 4) {
    const LineDetector& d = found.rig.detectors[i];
    const Vector6d xi = difference(d.T_world_station, recording.truth[i].T_world_station);
    sum += xi.dot(found.rig.station_covariance.at(d.station).inverse() * xi);
  }
  return sum;
}

// Five trials of two stations: χ² of 60 degrees of freedom, 35.5 to 91.9 with 98 %.
TEST(DetectorCalibration, FindsStationsWithinTheirCovariance) {
  double sum = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Recording recording = record(seed, 0.0);
    const auto found = calibrate_detectors(recording.start, tetrahedron(), recording.readings);
    ASSERT_EQ(found.outcome, CalibrationOutcome::Refined) << seed;
    sum += nees(found, recording);
    for (std::size_t i = 4; i < 12; i += 4) {
      const Vector6d xi = difference(found.rig.detectors[i].T_world_station, recording.truth[i].T_world_station);
      EXPECT_LT(xi.head<3>().norm(), 3e-3) << seed;  // three standard deviations
      EXPECT_LT(xi.tail<3>().norm(), 1e-3) << seed;
    }
  }
  EXPECT_GT(sum, 35.5);
  EXPECT_LT(sum, 91.9);
}

TEST(DetectorCalibration, BearsWrongIds) {
  const Recording recording = record(11, 0.2);
  const auto found = calibrate_detectors(recording.start, tetrahedron(), recording.readings);
  ASSERT_EQ(found.outcome, CalibrationOutcome::Refined);
  EXPECT_LT(nees(found, recording), 32.9);  // 12 degrees of freedom, 99.9 %
  for (const auto& [id, s] : found.by_detector) {
    EXPECT_NEAR(s.inlier_count, 0.8 * s.count, 0.08 * s.count) << id;
    EXPECT_NEAR(s.rms_sigmas, 0.85, 0.15) << id;  // the motion takes its share
  }
}

TEST(DetectorCalibration, FollowsTheBodyAtEveryMoment) {
  const Recording recording = record(3, 0.0);
  const auto found = calibrate_detectors(recording.start, tetrahedron(), recording.readings);
  ASSERT_GT(found.motion.size(), 45u);
  for (const StampedPose& pose : found.motion) {
    const Vector6d xi = difference(pose.T_world_camera, true_pose(to_seconds(pose.time.time_since_epoch())));
    EXPECT_LT(xi.head<3>().norm(), pose.time < Timestamp(from_seconds(0.98)) ? 2e-3 : 0.1);
  }
}

TEST(DetectorCalibration, HoldsDetectorsThatAreToStay) {
  const Recording recording = record(4, 0.0, 0.5);
  DetectorCalibrationOptions options;
  options.hold_detectors = true;
  const auto found = calibrate_detectors(recording.truth, tetrahedron(), recording.readings, options);
  ASSERT_EQ(found.outcome, CalibrationOutcome::Refined);
  EXPECT_TRUE(found.rig.station_covariance.empty());
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(found.rig.detectors[i].T_world_station.matrix(), recording.truth[i].T_world_station.matrix());
  }
  EXPECT_GT(found.motion.size(), 20u);
}

// The body file is off by a millimetre in shape; its size (its markers' distance from their mean) is known.
TEST(DetectorCalibration, FindsMarkersToATenthOfAMillimetre) {
  const Recording recording = record(5, 0.0);
  RigidBody wrong = tetrahedron();
  const RigidBody body = tetrahedron();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& m : body.markers) mean += m.p_body / 4;
  std::vector<Eigen::Vector3d> error{{1e-3, 0, 0}, {0, 0, -1e-3}, {0, 1e-3, 0}, {-0.5e-3, 0.5e-3, 0}};
  double growth = 0, size2 = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    growth += error[i].dot(body.markers[i].p_body - mean);
    size2 += (body.markers[i].p_body - mean).squaredNorm();
  }
  for (std::size_t i = 0; i < 4; ++i) {
    wrong.markers[i].p_body += error[i] - growth / size2 * (body.markers[i].p_body - mean);
  }
  DetectorCalibrationOptions options;
  options.marker_sigma_m = 2e-3;
  const auto found = calibrate_detectors(recording.start, wrong, recording.readings, options);
  ASSERT_EQ(found.outcome, CalibrationOutcome::Refined);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {  // distances do not depend on the body's frame
      const double truth = (body.markers[i].p_body - body.markers[j].p_body).norm();
      EXPECT_NEAR((found.body.markers[i].p_body - found.body.markers[j].p_body).norm(), truth, 1e-4) << i << j;
    }
  }
}

TEST(DetectorCalibration, TakesItsScaleFromAReferenceThatKnowsBetter) {
  const Recording recording = record(6, 0.0);
  RigidBody large = tetrahedron();
  for (BodyMarker& m : large.markers) m.p_body *= 1.01;
  Eigen::Isometry3d T_reference_world = Eigen::Isometry3d::Identity();
  T_reference_world.linear() = exp_so3({0.1, 0.2, 2.0});
  T_reference_world.translation() = Eigen::Vector3d(5, -3, 0.2);
  const Eigen::Vector3d point(0.02, -0.01, 0.05);
  MotionReference reference;
  reference.sigma_m = 1e-4;
  for (double t = 0.1; t < 2.9; t += 0.005) {
    reference.positions.push_back({Timestamp(from_seconds(t)), T_reference_world * true_pose(t) * point});
  }
  DetectorCalibrationOptions options;
  options.marker_sigma_m = 5e-3;
  options.body_size_sigma = 0.05;
  const auto found = calibrate_detectors(recording.start, large, recording.readings, options, {&reference, {}, {}});
  ASSERT_EQ(found.outcome, CalibrationOutcome::Refined);
  const double distance = (centre_world(found.rig.detectors[5]) - centre_world(found.rig.detectors[1])).norm();
  const double truth = (centre_world(recording.truth[5]) - centre_world(recording.truth[1])).norm();
  EXPECT_NEAR(distance, truth, 2e-3);
  const double size = (found.body.markers[0].p_body - found.body.markers[1].p_body).norm();
  EXPECT_NEAR(size, (tetrahedron().markers[0].p_body - tetrahedron().markers[1].p_body).norm(), 2e-4);
}

TEST(DetectorCalibration, TellsWhatItCannotDetermine) {
  const Recording recording = record(7, 0.0, 0.6);
  std::vector<LineReading> few(recording.readings.begin(), recording.readings.begin() + 40);
  EXPECT_EQ(calibrate_detectors(recording.start, tetrahedron(), few).outcome, CalibrationOutcome::TooFewReadings);
  std::vector<LineReading> of_two_blocks;
  for (const LineReading& r : recording.readings) {
    if (r.detector < 8) of_two_blocks.push_back(r);
  }
  EXPECT_EQ(calibrate_detectors(recording.start, tetrahedron(), of_two_blocks).outcome,
            CalibrationOutcome::TooFewReadings);
}

// A single marker gives no scale, and detectors that share their station's centre give none either.
TEST(DetectorCalibration, TellsThatAPointHasNoScale) {
  Recording recording = record(9, 0.0, 0.6);
  const RigidBody point{"point", {{0, Eigen::Vector3d::Zero()}}};
  for (LineReading& reading : recording.readings) {
    LineDetector& d = recording.start[static_cast<std::size_t>(reading.detector)];
    d.T_station_detector.translation().setZero();
    LineDetector truth = recording.truth[static_cast<std::size_t>(reading.detector)];
    truth.T_station_detector.translation().setZero();
    reading.marker = 0;
    reading.value = project(truth, true_pose(to_seconds(reading.time.time_since_epoch())).translation())->value;
  }
  const auto found = calibrate_detectors(recording.start, point, recording.readings);
  EXPECT_EQ(found.outcome, CalibrationOutcome::Undetermined);
  EXPECT_EQ(found.rig.detectors[5].T_world_station.matrix(), recording.start[5].T_world_station.matrix());
}

TEST(DetectorCalibration, TellsWhenIterationsRunOut) {
  const Recording recording = record(10, 0.0, 0.5);
  DetectorCalibrationOptions options;
  options.max_iterations = 2;
  std::vector<Progress> told;
  const CalibrationContext watched{nullptr, [&](const Progress& p) { told.push_back(p); }, {}};
  const auto hasty = calibrate_detectors(recording.start, tetrahedron(), recording.readings, options, watched);
  ASSERT_EQ(hasty.outcome, CalibrationOutcome::Refined);
  EXPECT_FALSE(hasty.is_converged);
  EXPECT_EQ(hasty.iterations, 2);
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back().done, told.back().total);
  EXPECT_TRUE(calibrate_detectors(recording.start, tetrahedron(), recording.readings).is_converged);
}

TEST(DetectorCalibration, StopsWithWhatItHas) {
  const Recording recording = record(10, 0.0, 0.5);
  std::stop_source source;
  const auto stop_at = [&](const std::string& stage, int done) {
    return [&source, stage, done](const Progress& p) {
      if (p.stage == stage && p.done == done) source.request_stop();
    };
  };
  const auto half_way = calibrate_detectors(recording.start, tetrahedron(), recording.readings, {},
                                            {nullptr, stop_at("moving the stations", 3), source.get_token()});
  EXPECT_EQ(half_way.outcome, CalibrationOutcome::Refined);
  EXPECT_FALSE(half_way.is_converged);
  EXPECT_EQ(half_way.iterations, 4);
  EXPECT_EQ(half_way.rig.station_covariance.size(), 2u);
  const auto at_once =
      calibrate_detectors(recording.start, tetrahedron(), recording.readings, {}, {nullptr, {}, source.get_token()});
  EXPECT_EQ(at_once.outcome, CalibrationOutcome::Stopped);
  EXPECT_EQ(at_once.rig.detectors[5].T_world_station.matrix(), recording.start[5].T_world_station.matrix());
}

TEST(DetectorCalibration, RefusesOptionsOutOfBounds) {
  const Recording recording = record(8, 0.0, 0.1);
  DetectorCalibrationOptions options;
  options.knot_interval_s = 0;
  EXPECT_THROW(calibrate_detectors(recording.start, tetrahedron(), recording.readings, options), std::invalid_argument);
  EXPECT_THROW(calibrate_detectors({}, tetrahedron(), recording.readings), std::invalid_argument);
  options = {};
  options.held_station = "nowhere";
  EXPECT_THROW(calibrate_detectors(recording.start, tetrahedron(), recording.readings, options), std::invalid_argument);
  EXPECT_THROW(calibrate_detectors(recording.start, {}, recording.readings), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
