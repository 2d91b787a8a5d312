// SPDX-License-Identifier: Apache-2.0
#include "app/targets/cue_file.h"

#include <gtest/gtest.h>

#include "tests/app/targets/flown_record.h"

namespace alidade {
namespace {

using test::at;

// 200 m in front of `hill`, which looks along z; `roof` looks the other way.
TargetEstimate ahead(TargetStatus status) {
  TargetEstimate target;
  target.id = 5;
  target.status = status;
  target.state.time = at(1);
  target.state.p_world = Eigen::Vector3d(0, 0, 200);
  target.state.v_world = Eigen::Vector3d(10, 0, 0);
  target.state.covariance.topLeftCorner<3, 3>() = 0.25 * Eigen::Matrix3d::Identity();
  return target;
}

std::vector<Receiver> receivers() {
  std::vector<Receiver> list = test::hill_and_roof();
  list[0].clock.offset_s = 0.5;
  list[1].T_world_receiver.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return list;
}

TEST(Cues, AreForEveryReceiverThatCanTurnThereInTime) {
  const std::vector<TargetEstimate> targets{ahead(TargetStatus::Confirmed), ahead(TargetStatus::Tentative)};
  const auto cues = cues_for(receivers(), targets, at(1), {1.0, 0.25}, {});
  ASSERT_EQ(cues.size(), 2u);
  EXPECT_EQ(cues[0].receiver, 0);
  EXPECT_EQ(cues[0].target, 5);
  EXPECT_EQ(cues[0].told, at(1));
  EXPECT_GE(cues[0].cue.time, at(1.25));
  EXPECT_LT(cues[0].cue.time, at(1.3));
  EXPECT_NEAR(cues[0].cue.azimuth_elevation[0], 10.0 * 0.26 / 200.0, 1e-3);
  EXPECT_GT(cues[1].cue.time, at(3.0));                                         // more than 2 rad to turn
  EXPECT_EQ(cues_for(receivers(), targets, at(1), {0.1, 0.0}, {}).size(), 1u);  // too slow for it
}

TEST(CueFile, HasARowForEachCue) {
  const test::TemporaryDirectory folder;
  CueFileWriter writer(folder / "cues.csv");
  AddressedCue cue = cues_for(receivers(), std::vector{ahead(TargetStatus::Coasting)}, at(1), {}, {})[0];
  cue.cue.covariance << 1e-6, 2e-7, 2e-7, 4e-6;
  writer.write(cue);
  writer.commit();
  const Table table = read_table(folder / "cues.csv");
  ASSERT_EQ(table.row_count(), 1u);
  const auto cell = [&](const char* name) { return table.number(0, table.column(name)); };
  EXPECT_EQ(cell("told_ns"), 1e9);
  EXPECT_EQ(cell("target"), 5);
  EXPECT_EQ(cell("receiver"), 0);
  EXPECT_NEAR(cell("t_ns") - cell("own_t_ns"), 0.5e9, 1.0);
  EXPECT_EQ(cell("azimuth_rad"), cue.cue.azimuth_elevation[0]);
  EXPECT_EQ(cell("elevation_rad"), cue.cue.azimuth_elevation[1]);
  EXPECT_EQ(cell("c_az_el"), 2e-7);
  EXPECT_EQ(cell("c_el_el"), 4e-6);
  EXPECT_NEAR(cell("range_m"), 200.0, 1e-2);
}

}  // namespace
}  // namespace alidade
