// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/text_lines.h"
#include "tests/app/targets/flown_record.h"

namespace alidade {
namespace {

TEST(TargetSummary, TellsOfEveryTargetAndOfWhatWentWrong) {
  const test::TemporaryDirectory folder;
  TargetRun run = test::flown_record(folder, 2, 5);
  run.source = "sim";
  run.without_direction = 3;
  nlohmann::json summary = summary_of(run);
  ASSERT_EQ(summary["targets"].size(), 2u);
  EXPECT_EQ(summary["targets"][1]["target"], 2);
  EXPECT_EQ(summary["targets"][1]["rows"], 5);
  EXPECT_EQ(summary["targets"][1]["sightings"], 5);
  EXPECT_NEAR(summary["targets"][1]["mean_position_sigma_m"], std::sqrt(3 * 0.04), 1e-12);
  EXPECT_NEAR(summary["targets"][1]["mean_speed_m_s"], 10.0, 1e-12);
  EXPECT_EQ(summary["bearings"], 5);
  EXPECT_EQ(summary["receivers"], 2);
  EXPECT_EQ(summary["without_direction"], 3);
  EXPECT_EQ(summary["duration_s"], 4.0);
  EXPECT_EQ(summary["interrupted"], false);
  EXPECT_FALSE(summary.contains("fault"));
  run.fault = "sim:7: is cut off";
  EXPECT_EQ(summary_of(run)["fault"], "sim:7: is cut off");
}

TEST(TargetTableLines, AreOnePerTargetUpToTwenty) {
  const test::TemporaryDirectory folder, other;
  const std::vector<std::string> one = table_lines(test::flown_record(folder, 1, 5));
  ASSERT_EQ(one.size(), 2u);
  EXPECT_EQ(one[0], "5 bearings of 1 receiver in 4.0 s: 1 target");
  EXPECT_EQ(one[1], "target 1: -2.00 to 2.00 s, 5 sightings, sigma 0.346 m");
  const std::vector<std::string> many = table_lines(test::flown_record(other, 30, 2));
  ASSERT_EQ(many.size(), 1u + 20u + 1u);
  EXPECT_EQ(many.back(), "... and 10 more");
}

TEST(TargetReport, IsWrittenWithPicturesTablesAndWarnings) {
  const test::TemporaryDirectory folder;
  TargetRun run = test::flown_record(folder, 2, 5);
  run.source = "sim/observations.csv";
  run.method = "filters";
  run.fault = "sim/observations.csv:7: is cut off; complete it";
  run.interrupted = true;
  ResultDirectory directory(folder / "report", "track targets");
  write_target_report(run, {}, directory, {"alidade", "track", "targets"}, "lag_s: 1\n");
  directory.commit(summary_of(run));
  const std::string html = read_bytes(folder / "report/report.html");
  for (const char* text : {"sim/observations.csv:7", "interrupted", "direction finder", "hill", "roof", "filters",
                           "track targets", "tracks.csv"}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "report/plots.png"));
  EXPECT_EQ(read_bytes(folder / "report/options.yaml"), "lag_s: 1\n");
  EXPECT_EQ(std::filesystem::exists(folder / "report/scene.png"), run.warnings.empty());
}

}  // namespace
}  // namespace alidade
