// SPDX-License-Identifier: Apache-2.0
#include "app/detector_calibration_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

DetectorCalibrationRun run_of_two_stations() {
  DetectorCalibrationRun run;
  run.source = "observations.csv";
  run.given.rig.detectors = {{0, "north", FocalLine{}}, {1, "south", FocalLine{}}, {2, "south", FocalLine{}}};
  run.refined = run.given;
  for (std::size_t i = 1; i < 3; ++i) run.refined.rig.detectors[i].T_world_station.translation().x() = 0.003;
  run.refined.rig.station_covariance["south"] = 1e-6 * Matrix6d::Identity();
  run.refined.by_detector = {{0, {100, 99, 0.7, 1.0}}, {1, {100, 98, 0.8, 1.0}}, {2, {50, 50, 0.6, 0.9}}};
  run.refined.by_marker = {{0, {250, 247, 0.7, 1.0}}};
  run.refined.iterations = 12;
  return run;
}

TEST(StationMoves, TellEachStationOnce) {
  const auto moves = station_moves(run_of_two_stations());
  ASSERT_EQ(moves.size(), 2u);
  EXPECT_FALSE(moves[0].sigma);
  EXPECT_NEAR(moves[1].change[0], 0.003, 1e-15);
  EXPECT_NEAR((*moves[1].sigma)[5], 1e-3, 1e-15);
}

TEST(DetectorCalibrationReport, TellsWhetherItWasVerified) {
  DetectorCalibrationRun run = run_of_two_stations();
  EXPECT_FALSE(summary_of(run).contains("verification"));
  EXPECT_TRUE(table_lines(run).back().starts_with("verification: none"));
  run.verification.emplace();
  run.verification->windows = {200, 198, 18, 0.5, 5e-5};
  const auto windows = summary_of(run)["verification"]["windows"];
  EXPECT_NEAR(windows["explained_share"].get<double>(), 0.99, 1e-12);
  EXPECT_EQ(windows["median_rad"], 5e-5);
  EXPECT_EQ(plots_of(run).front().series.size(), 3u);
}

TEST(DetectorCalibrationReport, WarnsOfWhatIsNotSettledOrNotVerified) {
  DetectorCalibrationRun run = run_of_two_stations();
  add_warnings(run);
  EXPECT_TRUE(run.warnings.empty());
  run.refined.is_converged = false;
  run.verification.emplace();
  run.verification->after.outcome = CalibrationOutcome::NoStart;
  add_warnings(run);
  ASSERT_EQ(run.warnings.size(), 2u);
  EXPECT_NE(run.warnings[0].find("not settled after 12 iterations; raise --max-iterations"), std::string::npos);
  EXPECT_TRUE(run.warnings[1].starts_with("not verified: no pose of the body"));
}

TEST(DetectorCalibrationReport, DrawsStationsThatMovedTwice) {
  const Scene scene = scene_of(run_of_two_stations());
  EXPECT_EQ(scene.cameras.size(), 3u + 2u);
  EXPECT_EQ(scene.translucent.size(), 1u);
}

}  // namespace
}  // namespace alidade
