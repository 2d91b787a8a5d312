// SPDX-License-Identifier: Apache-2.0
#include "io/target_file.h"

#include <chrono>

#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

TEST(TargetFile, GivesBackWhatWasWritten) {
  const test::TemporaryDirectory folder;
  const Matrix6d A = Matrix6d::Random();
  const TargetRow full{Timestamp(1500ms),           7,  "confirmed", {1.1, -2, 3}, {0.1, 0.2, -30},
                       Matrix6d(A + A.transpose()), 12, 291.25,      0.5};
  const TargetRow bare{Timestamp(1600ms), 8, "true", {4, 5, 6}, {0, 0, 0}};
  TargetFileWriter writer(folder / "tracks.csv");
  writer.write(full);
  writer.write(bare);
  writer.commit();
  const auto rows = read_target_rows(folder / "tracks.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].time, full.time);
  EXPECT_EQ(rows[0].target, 7);
  EXPECT_EQ(rows[0].state, "confirmed");
  EXPECT_EQ(rows[0].p_world, full.p_world);
  EXPECT_EQ(rows[0].v_world, full.v_world);
  EXPECT_EQ(rows[0].covariance, full.covariance);
  EXPECT_EQ(rows[0].sightings, 12);
  EXPECT_EQ(rows[0].temperature_k, 291.25);
  EXPECT_EQ(rows[0].temperature_sigma_k, 0.5);
  EXPECT_FALSE(rows[1].covariance);
  EXPECT_FALSE(rows[1].temperature_k);
}

TEST(TargetFile, WantsTimeTargetAndPlaceAlone) {
  const test::TemporaryDirectory folder;
  const auto rows = read_target_rows(folder.write("t.csv", "t_s,target,x_m,y_m,z_m\n2.5,1,1,2,3\n"));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].p_world, Eigen::Vector3d(1, 2, 3));
}

TEST(TargetFile, NamesWhatIsWrong) {
  const test::TemporaryDirectory folder;
  const auto refusal = [&](const char* text) {
    const auto path = folder.write("t.csv", text);
    return test::message_of(folder.path(), [&] { read_target_rows(path); });
  };
  EXPECT_EQ(refusal("t_s,x_m,y_m,z_m\n1,1,2,3\n"), "t.csv:1: has no column 'target'; known are: t_s, x_m, y_m, z_m");
  EXPECT_EQ(refusal("t_s,target,x_m,y_m,z_m\n1,1,2,3,inf\n"),
            "t.csv:2: column 'z_m': 'inf' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(refusal("t_s,target,x_m,y_m,z_m\n"), "t.csv: holds no target; is it the right file?");
}

}  // namespace
}  // namespace alidade
