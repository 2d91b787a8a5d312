// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_evaluation.h"

#include <gtest/gtest.h>

#include "tests/app/targets/flown_record.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using test::at;
using test::row_of;

std::vector<double> times_of(const std::vector<TargetMoment>& moments) {
  std::vector<double> times;
  for (const TargetMoment& moment : moments) times.push_back(to_seconds(moment.time.time_since_epoch()));
  return times;
}

// Rows of targets 1, 2, ... every 0.1 s.
std::vector<TargetRow> truth_of(int targets, double end_s) {
  std::vector<TargetRow> rows;
  for (int i = 0; 0.1 * i <= end_s + 1e-9; ++i) {
    for (int target = 1; target <= targets; ++target) rows.push_back(row_of(target, 0.1 * i));
  }
  return rows;
}

TEST(TargetMoments, AreTheEstimatesTimesWithTheTruthBetweenItsRows) {
  const std::vector<TargetRow> estimates{row_of(7, 0.25), row_of(8, 0.25), row_of(7, 0.75)};
  const auto moments = moments_of(estimates, truth_of(2, 1.0));
  ASSERT_EQ(times_of(moments), (std::vector<double>{0.25, 0.75}));
  ASSERT_EQ(moments[0].estimates.size(), 2u);
  EXPECT_EQ(moments[1].estimates.size(), 1u);
  ASSERT_EQ(moments[1].truth.size(), 2u);
  EXPECT_TRUE(moments[1].truth[1].p_world.isApprox(Eigen::Vector3d(7.5, 10, 50), 1e-12));
  EXPECT_EQ(moments[0].estimates[1].id, 8);
  EXPECT_EQ(*moments[0].estimates[1].covariance, 0.04 * Eigen::Matrix3d::Identity());
}

// What is not answered is an error as well: before the first, between, and after the last estimate.
TEST(TargetMoments, AreThereWhereEstimatesAreMissing) {
  std::vector<TargetRow> estimates;
  for (const double t : {2.0, 2.5, 3.0, 5.0, 5.5}) estimates.push_back(row_of(1, t));
  const auto moments = moments_of(estimates, truth_of(1, 7.0));
  std::vector<double> expected;
  for (int i = 0; i <= 14; ++i) expected.push_back(0.5 * i);
  ASSERT_EQ(times_of(moments), expected);
  for (const std::size_t i : {0u, 3u, 7u, 9u, 12u, 14u}) {
    EXPECT_TRUE(moments[i].estimates.empty()) << i;
    EXPECT_EQ(moments[i].truth.size(), 1u) << i;
  }
  for (const std::size_t i : {4u, 5u, 6u, 10u, 11u}) EXPECT_EQ(moments[i].estimates.size(), 1u) << i;
}

TEST(TargetMoments, AreJudgedOnlyWhileTheTruthIsKnown) {
  std::vector<TargetRow> estimates;
  for (int i = -3; i < 20; ++i) estimates.push_back(row_of(1, i));
  EXPECT_EQ(times_of(moments_of(estimates, truth_of(1, 2.0))), (std::vector<double>{0, 1, 2}));
}

// Targets that are each estimated at times of their own, as a beam passes over them.
TEST(TargetMoments, JoinEstimatesOfOnePeriod) {
  std::vector<TargetRow> estimates;
  for (int i = 1; i < 4; ++i) {
    for (int target = 1; target <= 2; ++target) estimates.push_back(row_of(target, i + 0.1 * target));
  }
  const auto moments = moments_of(estimates, truth_of(2, 3.9));
  ASSERT_EQ(times_of(moments), (std::vector<double>{0.1, 1.1, 2.1, 3.1}));
  ASSERT_EQ(moments[2].estimates.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {  // moved to that time
    EXPECT_TRUE(moments[2].estimates[i].p_world.isApprox(moments[2].truth[i].p_world, 1e-12));
  }
  // 0.1 s back, of 0.2 m/s: (0.02 m)² more.
  EXPECT_NEAR((*moments[2].estimates[1].covariance)(0, 0), 0.04 + 0.01 * 0.04, 1e-12);
}

TEST(TargetMoments, AreNotCountlessWhereClocksDiffer) {
  std::vector<TargetRow> estimates;
  for (int i = 0; i < 10; ++i) estimates.push_back(row_of(1, 1.7e9 + i));
  const auto moments = moments_of(estimates, truth_of(1, 3.0));
  EXPECT_EQ(moments.size(), 4u);
  estimates = {row_of(1, 0.0), row_of(1, 1e-9)};
  EXPECT_LE(moments_of(estimates, truth_of(1, 100.0)).size(), 200'000u);
}

TEST(TargetMoments, LeaveOutTargetsThatAreGone) {
  std::vector<TargetRow> truth = truth_of(1, 5.0);
  truth.push_back(row_of(2, 0.0));
  truth.push_back(row_of(2, 4.0));  // not seen in between
  const auto moments = moments_of({}, truth);
  ASSERT_EQ(moments.size(), 6u);
  EXPECT_EQ(moments[0].truth.size(), 2u);
  EXPECT_EQ(moments[2].truth.size(), 1u);
  EXPECT_EQ(moments[4].truth.size(), 2u);
}

TEST(TargetFile, IsKnownByItsColumnsAndInADirectory) {
  const test::TemporaryDirectory folder;
  const auto tracks = folder.write("tracks.csv", "t_ns,target,state,x_m,y_m,z_m\n0,1,true,0,0,0\n");
  EXPECT_TRUE(is_target_file(tracks));
  EXPECT_TRUE(is_target_file(folder.path()));
  EXPECT_EQ(target_file_of(folder.path()), tracks);
  EXPECT_FALSE(is_target_file(folder.write("path.tum", "# timestamp tx ty tz\n0 0 0 0 0 0 0 1\n")));
  EXPECT_FALSE(is_target_file(folder / "nowhere"));
  const test::TemporaryDirectory simulated;
  EXPECT_FALSE(is_target_file(simulated.path()));
  const auto truth = simulated.write("truth.csv", "t_ns,target,x_m,y_m,z_m\n");
  EXPECT_EQ(target_file_of(simulated.path()), truth);
}

TEST(TargetTable, HasTheScores) {
  std::vector<TargetRow> estimates = truth_of(1, 3.0);
  for (TargetRow& row : estimates) row.p_world.z() += 0.2;
  const TargetScores scores = score_targets(moments_of(estimates, truth_of(1, 3.0)), 4.2);
  const std::vector<std::string> lines = table_lines(scores);
  EXPECT_EQ(lines[0], "moments                      31");
  EXPECT_EQ(lines[3], "position error (m), RMS      0.200000");
  EXPECT_EQ(lines[5], "targets seen (share)         1.000000");
  EXPECT_NE(lines[9].find("0.333333"), std::string::npos);  // one of three coordinates is a sigma off
  EXPECT_NEAR(summary_of(scores)["rms_m"].get<double>(), 0.2, 1e-12);
}

}  // namespace
}  // namespace alidade
