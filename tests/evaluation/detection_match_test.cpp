// SPDX-License-Identifier: Apache-2.0
#include "evaluation/detection_match.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Pixels = std::vector<Eigen::Vector2d>;

TEST(DetectionMatch, GivesTheNearestPairsFirstOneToOne) {
  const Pixels truth{{0.0, 0.0}, {3.0, 0.0}}, detections{{1.8, 0.0}, {9.0, 9.0}, {2.5, 0.0}};
  const auto match = match_detections(truth, detections, 2.0);
  ASSERT_EQ(match.size(), 2U);
  EXPECT_EQ(match[1], 2U);
  EXPECT_EQ(match[0], 0U);
}

TEST(DetectionMatch, LeavesOutWhatIsTooFarOrTaken) {
  const auto match = match_detections(Pixels{{0.0, 0.0}, {1.0, 0.0}, {50.0, 0.0}}, Pixels{{0.9, 0.0}}, 2.0);
  EXPECT_FALSE(match[0]);
  EXPECT_EQ(match[1], 0U);
  EXPECT_FALSE(match[2]);
  EXPECT_TRUE(match_detections({}, Pixels{{0.0, 0.0}}, 2.0).empty());
}

}  // namespace
}  // namespace alidade
