// SPDX-License-Identifier: Apache-2.0
#include "evaluation/detection_tally.h"

#include <array>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(DetectionTally, CountsFoundMissedAndFalseOnesByKind) {
  DetectionTally tally(2, 3.0, 12.0);
  const std::array<TrueDot, 3> truth{TrueDot{{10.0, 10.0}, 0}, TrueDot{{50.0, 10.0}, 1}, TrueDot{{90.0, 10.0}, 1}};
  const Eigen::Matrix2d covariance = 0.25 * Eigen::Matrix2d::Identity();
  const std::array<DetectedDot, 3> detections{DetectedDot{{10.5, 10.0}, covariance},
                                              DetectedDot{{50.0, 11.0}, covariance}, DetectedDot{{70.0, 70.0}}};
  tally.add(truth, detections);
  tally.add(truth, {});
  EXPECT_DOUBLE_EQ(tally.kinds()[0].probability(), 0.5);
  EXPECT_DOUBLE_EQ(tally.kinds()[1].probability(), 0.25);
  EXPECT_DOUBLE_EQ(tally.false_per_image(), 0.5);
  EXPECT_DOUBLE_EQ(tally.kinds()[0].nees_per_degree(), 0.5);  // 0.5² / 0.25 over two degrees of freedom
  const std::array<int, 2> both{0, 1};
  EXPECT_DOUBLE_EQ(tally.together(both).probability(), 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(tally.together(both).rms_px(), std::sqrt((0.25 + 1.0) / 4.0));
}

TEST(DetectionTally, DoesNotScoreThePlacesOfObjectsThatMeet) {
  DetectionTally tally(1, 3.0, 12.0);
  const std::array<TrueDot, 2> truth{TrueDot{{10.0, 10.0}, 0}, TrueDot{{15.0, 10.0}, 0}};
  const std::array<DetectedDot, 1> detections{DetectedDot{{11.0, 10.0}}};
  tally.add(truth, detections);
  EXPECT_DOUBLE_EQ(tally.kinds()[0].probability(), 0.5);
  EXPECT_EQ(tally.kinds()[0].measured, 0U);
  EXPECT_DOUBLE_EQ(tally.kinds()[0].rms_px(), 0.0);
}

TEST(DetectionTally, RefusesAKindThatIsNotThere) {
  DetectionTally tally(1, 3.0, 12.0);
  const std::array<TrueDot, 1> truth{TrueDot{{10.0, 10.0}, 1}};
  EXPECT_THROW(tally.add(truth, {}), std::out_of_range);
}

}  // namespace
}  // namespace alidade
