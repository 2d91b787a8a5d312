// SPDX-License-Identifier: Apache-2.0
#include "datasets/target_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Eigen::Vector3d;

Timestamp at(double t_s) {
  return Timestamp(from_seconds(t_s));
}

Vector3d middle_of(const TargetScene& scene, Timestamp time) {
  Vector3d sum = Vector3d::Zero();
  for (const TargetPath& path : scene.paths) sum += position_at(path, time);
  return sum / static_cast<double>(scene.paths.size());
}

TEST(TargetScene, ThreeLinesOfSightAreOrthogonalInTheMiddleOfTheTime) {
  const TargetScene scene = make_target_scene(paper_table_scene(2, {0.0, 0.1, 0.2}, 3));
  const Vector3d middle = middle_of(scene, at(2.0));
  std::vector<Vector3d> lines;
  for (const Receiver& receiver : scene.receivers) {
    const Vector3d line = middle - receiver.T_world_receiver.translation();
    EXPECT_NEAR(line.norm(), scene.range_m, 1e-9);
    EXPECT_GT(line.z(), 0.0);
    EXPECT_NEAR(receiver.T_world_receiver.linear().determinant(), 1.0, 1e-12);
    EXPECT_LT((receiver.T_world_receiver.linear().col(2) - line.normalized()).norm(), 1e-12);
    lines.push_back(line.normalized());
  }
  EXPECT_NEAR(lines[0].dot(lines[1]), 0.0, 1e-4);
  EXPECT_NEAR(lines[0].dot(lines[2]), 0.0, 1e-4);
  EXPECT_NEAR(lines[1].dot(lines[2]), 0.0, 1e-4);
  EXPECT_GE(scene.range_m, 100.0);
  EXPECT_LE(scene.range_m, 200.0);
}

TEST(TargetScene, TwoReceiversStandAtRightAngles) {
  TargetSceneOptions options;
  options.receivers = 2;
  const TargetScene scene = make_target_scene(options);
  EXPECT_NEAR(
      scene.receivers[0].T_world_receiver.linear().col(2).dot(scene.receivers[1].T_world_receiver.linear().col(2)), 0.0,
      1e-4);
}

TEST(TargetScene, TableSceneHasParallelPathsThreeMetresApartAndNothingMissed) {
  const TargetScene scene = make_target_scene(paper_table_scene(2, {0.0, 0.3, 0.4}, 8));
  EXPECT_EQ(scene.readings.size(), 30u);
  for (const double t_s : {0.0, 4.0}) {
    EXPECT_NEAR((position_at(scene.paths[0], at(t_s)) - position_at(scene.paths[1], at(t_s))).norm(), 3.0, 1e-9);
  }
  std::map<int, double> delay_of;
  for (const ReceiverReading& reading : scene.readings) {
    const double t_s = to_seconds(reading.time.time_since_epoch());
    delay_of[reading.receiver] = t_s - std::floor(t_s + 1e-9);
  }
  EXPECT_NEAR(delay_of[0], 0.0, 1e-9);
  EXPECT_NEAR(delay_of[1], 0.3, 1e-9);
  EXPECT_NEAR(delay_of[2], 0.4, 1e-9);
}

TEST(TargetScene, ReadingsErrAcrossTheLineByTheNoiseAskedFor) {
  double squares = 0.0;
  int count = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const TargetScene scene = make_target_scene(paper_table_scene(2, {0.0, 0.1, 0.2}, seed));
    for (const Bearing& bearing : bearings_of(scene.receivers, scene.readings)) {
      const TargetPath& path = scene.paths[static_cast<std::size_t>(bearing.target)];
      const Vector3d sight = (position_at(path, bearing.time) - bearing.origin_world).normalized();
      squares += std::pow((bearing.direction_world - sight).norm() * scene.range_m / 0.1, 2);
      EXPECT_NEAR(std::sqrt(bearing.covariance(0, 0)), 0.1 / scene.range_m, 1e-12);
      count += 2;
    }
  }
  EXPECT_NEAR(squares / count, 1.0, 5 * std::sqrt(2.0 / count));
}

TEST(TargetScene, PathsStartApartWithinTheirCube) {
  TargetSceneOptions options;
  options.targets = 10;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    options.seed = seed;
    const auto paths = make_target_scene(options).paths;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      EXPECT_LE(paths[i].p0_world.cwiseAbs().maxCoeff(), 7.5);
      EXPECT_LE(paths[i].v_world.norm(), 70.0);
      for (std::size_t k = 0; k < i; ++k) EXPECT_GE((paths[i].p0_world - paths[k].p0_world).norm(), 3.0);
    }
  }
}

TEST(TargetScene, VelocitiesAreThoseOfThePath) {
  TargetSceneOptions options;
  options.acceleration_m_s2 = 3.0;
  const TargetPath path = make_target_scene(options).paths[0];
  const Vector3d difference = (position_at(path, at(1.5001)) - position_at(path, at(1.4999))) / 2e-4;
  EXPECT_LT((velocity_at(path, at(1.5)) - difference).norm(), 1e-6);
  EXPECT_GT(path.a_world.norm(), 0.0);
}

TEST(TargetScene, MissesAndInventsAsOftenAsAsked) {
  TargetSceneOptions options;
  options.targets = 5;
  options.periods = 400;
  options.velocity_sigma_m_s = 0.01;
  options.detection_probability = 0.8;
  options.false_bearings = 2.0;
  const TargetScene scene = make_target_scene(options);
  const auto right =
      std::count_if(scene.readings.begin(), scene.readings.end(), [](const auto& r) { return r.target >= 0; });
  const auto wrong = static_cast<long>(scene.readings.size()) - right;
  EXPECT_NEAR(static_cast<double>(right) / (5 * 3 * 400), 0.8, 5 * std::sqrt(0.16 / 6000));
  EXPECT_NEAR(static_cast<double>(wrong) / (3 * 400), 2.0, 5 * std::sqrt(2.0 / 1200));
  for (const Bearing& bearing : bearings_of(scene.receivers, scene.readings)) {
    if (bearing.target >= 0) continue;
    const Vector3d axis = (middle_of(scene, bearing.time) - bearing.origin_world).normalized();
    EXPECT_LE(std::acos(std::min(1.0, axis.dot(bearing.direction_world))), 0.5 * options.cone_rad + 1e-9);
  }
}

TEST(TargetScene, EverySecondTargetComesLateOrLeavesEarly) {
  TargetSceneOptions options;
  options.targets = 3;
  options.periods = 20;
  options.comes_and_goes = true;
  std::map<int, std::pair<double, double>> seen;
  for (const ReceiverReading& r : make_target_scene(options).readings) {
    const double t_s = to_seconds(r.time.time_since_epoch());
    if (!seen.contains(r.target)) seen[r.target].first = t_s;
    seen[r.target].second = t_s;
  }
  EXPECT_LT(seen[0].first, 1.0);
  EXPECT_GE(seen[0].second, 19.0);
  EXPECT_GE(seen[1].first, 4.0);
  EXPECT_LT(seen[2].second, 16.0);
}

TEST(TargetScene, IsTheSameForTheSameSeedAloneAndInOrderOfTime) {
  TargetSceneOptions options;
  options.false_bearings = 1.0;
  options.scan_law = ScanLaw::Rotating;
  const auto values = [&options] {
    std::vector<double> all;
    for (const ReceiverReading& r : make_target_scene(options).readings) all.push_back(r.value.sum());
    return all;
  };
  const auto first = values();
  EXPECT_EQ(first, values());
  const TargetScene scene = make_target_scene(options);
  EXPECT_TRUE(std::is_sorted(scene.readings.begin(), scene.readings.end(),
                             [](const auto& a, const auto& b) { return a.time < b.time; }));
  options.seed = 2;
  EXPECT_NE(first, values());
}

TEST(TargetSceneOptions, AreRefusedByName) {
  TargetSceneOptions options;
  options.detection_probability = 1.5;
  try {
    validate(options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "detection_probability must be in [0, 1], got 1.5");
  }
  options = {};
  options.spread_m = 0.0;  // no cube of this side would ever hold two targets
  EXPECT_THROW(validate(options), std::invalid_argument);
  options = {};
  options.sigma_m = std::nan("");
  EXPECT_THROW(make_target_scene(options), std::invalid_argument);
}

TEST(TargetScene, ReadsTemperaturesWithoutChangingTheBearings) {
  TargetSceneOptions options;
  options.false_bearings = 1.0;
  const TargetScene without = make_target_scene(options);
  options.temperature_sigma_k = 2.0;
  const TargetScene with = make_target_scene(options);
  ASSERT_EQ(with.readings.size(), without.readings.size());
  double squares = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < with.readings.size(); ++i) {
    const ReceiverReading& reading = with.readings[i];
    EXPECT_EQ(reading.value, without.readings[i].value);
    EXPECT_EQ(reading.temperature_k.has_value(), reading.receiver > 0);
    if (!reading.temperature_k || reading.target < 0) continue;
    const double error = *reading.temperature_k - with.paths[static_cast<std::size_t>(reading.target)].temperature_k;
    squares += error * error;
    ++count;
  }
  ASSERT_GE(count, 20);
  EXPECT_NEAR(std::sqrt(squares / count), 2.0, 1.0);
}

// After 4 s the variance of each coordinate is q t of the velocity and q t³ / 3 of the place: of 3,000 draws, within 4
// standard deviations of sqrt(2 / 3000).
TEST(TargetScene, GustsAreWhiteAcceleration) {
  TargetSceneOptions options;
  options.targets = 1000;
  options.least_distance_m = 0.0;
  options.velocity_sigma_m_s = options.scatter_m_s = 0.0;
  options.agility_m2_s3 = 0.7;
  options.receivers = 1;
  double place = 0.0, pace = 0.0;
  for (const TargetPath& path : make_target_scene(options).paths) {
    place += (position_at(path, at(4.0)) - path.p0_world).squaredNorm();
    pace += velocity_at(path, at(4.0)).squaredNorm();
    const Vector3d step = position_at(path, at(2.005)) - position_at(path, at(2.001));
    EXPECT_LT((step - 0.004 * velocity_at(path, at(2.003))).norm(), 1e-9);
  }
  const double far = 4.0 * std::sqrt(2.0 / 3000);
  EXPECT_NEAR(pace / (3000 * 0.7 * 4.0), 1.0, far);
  EXPECT_NEAR(place / (3000 * 0.7 * 64.0 / 3.0), 1.0, far + 0.005);  // steps of 10 ms instead of none
}

}  // namespace
}  // namespace alidade
