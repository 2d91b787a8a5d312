// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_record.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/trajectory_file.h"
#include "tests/app/targets/flown_record.h"

namespace alidade {
namespace {

TEST(TargetRecord, WritesAllRowsAndAPathOfEachTarget) {
  const test::TemporaryDirectory folder;
  test::flown_record(folder, 2, 3);
  const std::vector<TargetRow> rows = read_target_rows(folder / "out/tracks.csv");
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[3].target, 2);
  EXPECT_EQ(rows[3].time, test::at(1));
  EXPECT_EQ(rows[3].p_world, Eigen::Vector3d(10, 10, 50));
  EXPECT_EQ(*rows[3].covariance, 0.04 * Matrix6d::Identity());
  for (const char* name : {"out/tracks/target_1.tum", "out/tracks/target_2.tum"}) {
    const Trajectory path = read_trajectory(folder / name).poses;
    ASSERT_EQ(path.size(), 3u) << name;
    EXPECT_EQ(path[2].T_world_camera.translation().x(), 20.0);
    EXPECT_TRUE(path[2].T_world_camera.linear().isIdentity());
  }
}

TEST(TargetRecord, TellsWhatBecameOfEachTarget) {
  const test::TemporaryDirectory folder;
  const ResultDirectory directory(folder / "out", "track targets");
  TargetRecord record(directory, test::hill_and_roof());
  for (const double t : {5.0, 3.0, 4.0}) {  // late ones come later
    Bearing bearing;
    bearing.time = test::at(t);
    bearing.receiver = t == 4.0 ? 1 : 0;
    record.observe(bearing);
  }
  TargetRow warm = test::row_of(7, 2.0);
  warm.temperature_k = 300.0;
  warm.temperature_sigma_k = 2.0;
  record.add(test::row_of(7, 1.0));
  record.add(warm);
  const TargetRun run = record.commit();
  EXPECT_EQ(run.bearings, 3);
  EXPECT_EQ(run.first, test::at(3));
  EXPECT_EQ(run.last, test::at(5));
  EXPECT_EQ(run.bearings_of_receiver.at(0), 2);
  const TargetTally& tally = run.targets.at(7);
  EXPECT_EQ(tally.rows, 2);
  EXPECT_EQ(tally.first, test::at(1));
  EXPECT_EQ(tally.last, test::at(2));
  EXPECT_EQ(tally.sightings, 3);
  EXPECT_NEAR(tally.position_sigma_sum_m, 2 * std::sqrt(3 * 0.04), 1e-12);
  EXPECT_NEAR(tally.speed_sum_m_s, 20.0, 1e-12);
  EXPECT_EQ(tally.temperature_k, 300.0);
}

TEST(TargetRecord, KeepsFewSamplesOfALongFlight) {
  const test::TemporaryDirectory folder;
  const TargetRun run = test::flown_record(folder, 1, 5000);
  EXPECT_EQ(run.targets.at(1).rows, 5000);
  EXPECT_LE(run.targets.at(1).samples.values().size(), TargetTally::kMostSamples);
  EXPECT_LE(run.sights.values().size(), TargetRun::kMostSights);
}

TEST(TargetRecord, LeavesAFileWithoutRowsWhereNoTargetIs) {
  const test::TemporaryDirectory folder;
  EXPECT_TRUE(test::flown_record(folder, 0, 3).targets.empty());
  EXPECT_TRUE(std::filesystem::exists(folder / "out/tracks.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/tracks"));
}

}  // namespace
}  // namespace alidade
