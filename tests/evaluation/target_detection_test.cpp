// SPDX-License-Identifier: Apache-2.0
#include "evaluation/target_detection.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

TEST(TargetDetection, PairsNearestFirstAndCountsWithinTheRadius) {
  const Positions truth{{0, 0, 0}, {10, 0, 0}, {20, 0, 0}};
  const Positions estimates{{11, 0, 0}, {0, 5, 0}, {12, 0, 0}};
  const DetectionOutcome outcome = detect_targets(estimates, truth, 4.2);
  EXPECT_EQ(outcome.found, 1u);
  EXPECT_EQ(outcome.false_ones, 2u);
  EXPECT_EQ(outcome.estimates, 3u);
  EXPECT_DOUBLE_EQ(outcome.distance_m[0].value(), 5.0);
  EXPECT_DOUBLE_EQ(outcome.distance_m[1].value(), 1.0);
  EXPECT_DOUBLE_EQ(outcome.distance_m[2].value(), 8.0);
}

TEST(TargetDetection, HasNoDistanceForWhatNoEstimateIsLeftFor) {
  const DetectionOutcome outcome = detect_targets(Positions{{1, 0, 0}}, Positions{{9, 0, 0}, {0, 0, 0}}, 2.0);
  EXPECT_FALSE(outcome.distance_m[0]);
  EXPECT_DOUBLE_EQ(outcome.distance_m[1].value(), 1.0);
  EXPECT_EQ(detect_targets({}, Positions{{0, 0, 0}}, 1.0).found, 0u);
  EXPECT_EQ(detect_targets(Positions{{0, 0, 0}}, {}, 1.0).false_ones, 1u);
}

TEST(TargetDetection, RefusesWhatIsNotFinite) {
  EXPECT_THROW(detect_targets(Positions{{std::nan(""), 0, 0}}, Positions{{0, 0, 0}}, 1.0), std::invalid_argument);
  EXPECT_THROW(detect_targets({}, {}, 0.0), std::invalid_argument);
}

DetectionOutcome run_with(std::vector<std::optional<double>> distances, std::size_t found, std::size_t estimates) {
  return {std::move(distances), found, estimates - found, estimates};
}

// Distances 1, 3, 5, 7: mean 4, standard deviation √5.
TEST(DetectionStatistics, AreThoseOfAllRuns) {
  const std::vector<DetectionOutcome> runs{run_with({1.0, 3.0}, 2, 2), run_with({5.0, std::nullopt}, 0, 1),
                                           run_with({7.0, std::nullopt}, 0, 1), run_with({{}, {}}, 0, 0)};
  const DetectionStatistics s = summarise(runs);
  EXPECT_EQ(s.runs, 4u);
  EXPECT_DOUBLE_EQ(s.distance_mean_m.value, 4.0);
  EXPECT_DOUBLE_EQ(s.distance_sd_m.value, std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(s.all_found.value, 0.25);
  EXPECT_DOUBLE_EQ(s.right_number.value, 0.25);
  EXPECT_DOUBLE_EQ(s.false_per_run, 0.5);
  EXPECT_THROW(summarise(std::span<const DetectionOutcome>{}), std::invalid_argument);
}

// 400 runs, every fourth finds all: √(¼ · ¾ / 400) = 0.0217; d is 1 or 3, mean 2.5, sd √0.75: error 0.0433.
TEST(DetectionStatistics, StandardErrorsAreThoseOfIndependentRuns) {
  std::vector<DetectionOutcome> runs;
  for (int i = 0; i < 400; ++i) {
    runs.push_back(i % 4 == 0 ? run_with({1.0, 1.0}, 2, 2) : run_with({3.0, 3.0}, 0, 2));
  }
  const DetectionStatistics s = summarise(runs);
  EXPECT_NEAR(s.all_found.standard_error, 0.0217, 0.002);
  EXPECT_NEAR(s.distance_mean_m.standard_error, 0.0433, 0.004);
  EXPECT_EQ(s.right_number.standard_error, 0.0);
}

}  // namespace
}  // namespace alidade
