// SPDX-License-Identifier: Apache-2.0
#include "app/targets/placement_plan.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "datasets/target_scene.h"
#include "io/table.h"
#include "io/text_lines.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

std::vector<Receiver> three_receivers() {
  return make_target_scene({}).receivers;
}

PlanOptions small_volume() {
  PlanOptions options;
  options.least_m = "-50,-50,0";
  options.greatest_m = "50,50,50";
  options.placement.step_m = 50.0;
  return options;
}

std::string fault_of(const PlanOptions& options) {
  try {
    validate(placement_of(options));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "fine";
}

TEST(PlacementPlan, TakesVectorsAsText) {
  PlanOptions options = small_volume();
  options.v_m_s = "1, 2,3";
  options.delays_s = "0,0.1";
  const PlacementOptions placement = placement_of(options);
  EXPECT_EQ(placement.least_world, Eigen::Vector3d(-50, -50, 0));
  EXPECT_EQ(placement.greatest_world, Eigen::Vector3d(50, 50, 50));
  EXPECT_EQ(placement.v_world, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(placement.delays_s, (std::vector<double>{0.0, 0.1}));
  EXPECT_EQ(placement.step_m, 50.0);
}

TEST(PlacementPlan, RefusesWhatIsNoVolume) {
  PlanOptions options = small_volume();
  EXPECT_EQ(fault_of(options), "fine");
  options.least_m = "0,0";
  EXPECT_EQ(fault_of(options), "plan.least_m must be three numbers x,y,z");
  options.least_m = "0,0,x";
  EXPECT_EQ(fault_of(options), "plan.least_m must be numbers with commas between, got 'x'");
  options.least_m = "0,0,70";
  EXPECT_EQ(fault_of(options), "plan.greatest_m must be >= plan.least_m in each coordinate, got 50,50,50 and 0,0,70");
  options = small_volume();
  options.greatest_m = "50,50,0";  // a level
  options.placement.step_m = 1e-3;
  EXPECT_NE(fault_of(options).find("at most 1e7 points"), std::string::npos);
}

TEST(PlacementPlan, SumsUpWhereATargetIsLocatedAndWhereNot) {
  PlacementMap map;
  map.points.resize(4);
  EXPECT_EQ(summary_of(map), (nlohmann::json{{"places", 4}, {"located", 0}}));
  map.points[0].rms_m = 3.0;
  map.points[2].rms_m = 1.0;
  map.points[3].rms_m = 2.0;
  const nlohmann::json summary = summary_of(map);
  EXPECT_EQ(summary["located"], 3);
  EXPECT_EQ(summary["best_rms_m"], 1.0);
  EXPECT_EQ(summary["median_rms_m"], 2.0);
  EXPECT_EQ(summary["worst_rms_m"], 3.0);
}

TEST(PlacementPlan, IsWrittenAsTablePictureAndPage) {
  const test::TemporaryDirectory folder;
  ResultDirectory directory(folder / "out", "track targets");
  const std::vector<Receiver> receivers = three_receivers();
  PlacementMap map = map_placement(receivers, placement_of(small_volume()));
  map.points[1].rms_m.reset();
  write_plan(map, receivers, directory, {"alidade", "track", "targets"}, "plan:\n");
  directory.commit(summary_of(map));
  const Table table = read_table(folder / "out/placement.csv");
  ASSERT_EQ(table.row_count(), 3u * 3u * 2u);
  EXPECT_EQ(table.number(1, table.column("x_m")), 0.0);
  EXPECT_EQ(table.text(1, table.column("rms_m")), "");
  EXPECT_EQ(table.number(17, table.column("rms_m")), *map.points[17].rms_m);
  EXPECT_EQ(table.number(17, table.column("receivers")), 3);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/placement.png"));
  const std::string html = read_bytes(folder / "out/report.html");
  for (const char* text : {"Placement of receivers", "median bound", "placement.csv", "plan:"}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace alidade
