// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_groups.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Eigen::Vector3d;

constexpr PaperOptions kAlternative{.method = PaperMethod::Alternative};

PaperCandidate candidate(double t_s, const Vector3d& p, const Vector3d& v, std::vector<std::size_t> bearings) {
  PaperCandidate made;
  made.state.time = Timestamp(from_seconds(t_s));
  made.state.p_world = p;
  made.state.v_world = v;
  made.state.covariance.topLeftCorner<3, 3>() = 0.01 * Eigen::Matrix3d::Identity();
  made.bearings = std::move(bearings);
  return made;
}

// One object along x at 10 m/s, 1 m off the line in period `off`; its bearings are 2 i and 2 i + 1.
std::vector<PaperPeriod> one_object(int periods, int off = -1, const Vector3d& from = Vector3d::Zero(),
                                    std::size_t first_bearing = 0) {
  std::vector<PaperPeriod> made;
  for (int i = 0; i < periods; ++i) {
    const Vector3d p = from + Vector3d(10.0 * i, i == off ? 1.0 : 0.0, 0.0);
    const std::size_t b = first_bearing + 2 * static_cast<std::size_t>(i);
    made.push_back({i, {candidate(i, p, Vector3d(10, 0, 0), {b, b + 1})}});
  }
  return made;
}

std::vector<PaperPeriod> joined(std::vector<PaperPeriod> a, const std::vector<PaperPeriod>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i].candidates.insert(a[i].candidates.end(), b[i].candidates.begin(), b[i].candidates.end());
  }
  return a;
}

// A straight line through 0, 0, 0, 0, 1 at 0 to 4: at 4 it is 0.6, and rises by 0.2.
TEST(PaperGroups, AlternativeEstimatesAnewFromAllCandidates) {
  const auto groups = paper_groups(one_object(5, 4), kAlternative);
  ASSERT_EQ(groups.size(), 1u);
  const TargetState& state = groups[0].estimate;
  EXPECT_EQ(state.time, Timestamp(std::chrono::seconds(4)));
  EXPECT_LT((state.p_world - Vector3d(40, 0.6, 0)).norm(), 1e-12);
  EXPECT_LT((state.v_world - Vector3d(10, 0.2, 0)).norm(), 1e-12);
  // 3/5 of a candidate's variance at the end of five; 1/10 of its slope's.
  EXPECT_NEAR(state.covariance(0, 0), 0.006, 1e-12);
  EXPECT_NEAR(state.covariance(4, 4), 0.001, 1e-12);
  EXPECT_NEAR(state.covariance(0, 3), 0.002, 1e-12);
}

TEST(PaperGroups, ProposedTakesOverTheLatestCandidate) {
  const auto groups = paper_groups(one_object(5, 4), {});
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].estimate.p_world, Vector3d(40, 1, 0));
  EXPECT_NEAR(groups[0].score_m2, 1.0, 1e-12);
}

TEST(PaperGroups, ScoreCountsResidualsAndDistances) {
  auto periods = one_object(3, 2);
  periods[0].candidates[0].residual_m2 = 0.5;
  periods[2].candidates[0].residual_m2 = 0.25;
  EXPECT_NEAR(paper_groups(periods, kAlternative)[0].score_m2, 1.75, 1e-12);
  EXPECT_NEAR(paper_groups(periods, {})[0].score_m2, 1.75, 1e-12);
}

TEST(PaperGroups, EndWhereNothingContinuesThem) {
  auto periods = one_object(5);
  periods[3].candidates.clear();
  EXPECT_TRUE(paper_groups(periods, {}).empty());
  EXPECT_TRUE(paper_groups(periods, kAlternative).empty());
  periods = one_object(5);
  periods[3].candidates[0].state.p_world.y() = 3.1;
  EXPECT_TRUE(paper_groups(periods, kAlternative).empty());
  EXPECT_EQ(paper_groups(periods, {}).size(), 1u);
  periods[3].candidates[0].state.p_world.y() = 10.1;
  EXPECT_TRUE(paper_groups(periods, {}).empty());
  EXPECT_TRUE(paper_groups({}, {}).empty());
}

// Two objects far apart: the alternative algorithm starts groups across them, which nothing continues.
TEST(PaperGroups, StartFromEveryPairOfTheFirstTwoPeriods) {
  const auto periods = joined(one_object(2), one_object(2, -1, Vector3d(0, 500, 0), 100));
  EXPECT_EQ(paper_groups(periods, kAlternative).size(), 4u);
  EXPECT_EQ(paper_groups(periods, {}).size(), 2u);
  const auto longer = joined(one_object(3), one_object(3, -1, Vector3d(0, 500, 0), 100));
  EXPECT_EQ(paper_groups(longer, kAlternative).size(), 2u);
}

TEST(PaperGroups, BranchIntoEveryContinuation) {
  auto periods = one_object(4);
  periods[2].candidates.push_back(candidate(2, {20, 1, 0}, {10, 0, 0}, {50, 51}));
  const auto groups = paper_groups(periods, kAlternative);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].candidates, (std::vector<std::size_t>{0, 0, 0, 0}));
  EXPECT_EQ(groups[1].candidates, (std::vector<std::size_t>{0, 0, 1, 0}));
  PaperOptions one = kAlternative;
  one.most_groups = 1;
  EXPECT_EQ(paper_groups(periods, one).size(), 1u);
}

TEST(PaperGroups, OfOnePeriodAreItsCandidates) {
  const auto periods = joined(one_object(1), one_object(1, -1, Vector3d(0, 5, 0), 100));
  for (const PaperOptions& options : {kAlternative, PaperOptions{}}) {
    const auto groups = paper_groups(periods, options);
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_EQ(choose_objects(periods, groups, options).size(), 2u);
  }
  EXPECT_TRUE(paper_groups(periods, kAlternative)[0].estimate.v_world.isZero());
}

TEST(PaperObjects, ShareNoBearings) {
  auto periods = one_object(4);
  periods[2].candidates.push_back(candidate(2, {20, 1, 0}, {10, 0, 0}, {50, 51}));
  const auto groups = paper_groups(periods, kAlternative);
  const auto objects = choose_objects(periods, groups, kAlternative);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].candidates, groups[0].candidates);
  EXPECT_EQ(bearings_of_group(periods, objects[0]), (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(PaperObjects, ShareAsManyBearingsAsAllowed) {
  auto periods = one_object(4);
  periods[2].candidates.push_back(candidate(2, {20, 1, 0}, {10, 0, 0}, {50, 51}));
  const auto groups = paper_groups(periods, kAlternative);
  PaperOptions options = kAlternative;
  options.shared_bearings = 5;
  EXPECT_EQ(choose_objects(periods, groups, options).size(), 1u);
  options.shared_bearings = 6;  // those of the three other periods
  EXPECT_EQ(choose_objects(periods, groups, options).size(), 2u);
}

}  // namespace
}  // namespace alidade
