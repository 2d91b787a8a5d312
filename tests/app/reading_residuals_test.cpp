// SPDX-License-Identifier: Apache-2.0
#include "app/reading_residuals.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alidade {
namespace {

using ::testing::ElementsAre;
using Residual = std::optional<ReadingResidual>;

std::vector<LineDetector> an_angle_and_a_pixel_detector() {
  return {{4, "north", FocalLine{}}, {5, "south", LineCamera{1024, 800, 511.5}}};
}

const std::vector<RigidBody> kBodies{{"probe", {{1, {0, 0, 0}}, {2, {0, 0, 0}}}}};

LineReading reading(int detector, int marker) {
  return {Timestamp(), detector, marker, 0.0, 0.0};
}

TEST(ReadingResiduals, AreSummedByDetectorAndByMarkerInTheirUnits) {
  ReadingResiduals residuals(an_angle_and_a_pixel_detector(), kBodies);
  residuals.add(std::vector{reading(4, 1), reading(4, 2), reading(5, 1), reading(4, 1)},
                std::vector<Residual>{{{3e-4, 1e-4}}, {{-4e-4, 1e-4}}, {{0.5, 0.25}}, {{9.0, 1e-4}}},
                {true, true, true, false});
  const auto rows = residuals.rows();
  ASSERT_EQ(rows.size(), 5u);  // two detectors; marker 1 in both units, marker 2 in one
  EXPECT_EQ(rows[0].of + rows[0].name + rows[0].unit, "detectornorthrad");
  EXPECT_EQ(rows[0].readings, 3);
  EXPECT_EQ(rows[0].inliers, 2);
  EXPECT_NEAR(rows[0].rms_sigma, std::sqrt(12.5), 1e-12);
  EXPECT_NEAR(rows[0].mean_sigma, -0.5, 1e-12);
  EXPECT_NEAR(rows[0].rms, 1e-4 * std::sqrt(12.5), 1e-15);
  EXPECT_EQ(rows[1].unit, "px");
  EXPECT_NEAR(rows[1].rms_sigma, 2.0, 1e-12);
  EXPECT_NEAR(rows[1].median_magnitude, 0.5, 0.005);
  EXPECT_EQ(rows[2].of + rows[2].name + rows[2].unit, "markerproberad");
  EXPECT_EQ(rows[2].readings, 2);
  EXPECT_EQ(rows[3].unit, "px");
  EXPECT_EQ(rows[4].id, 2);
}

TEST(ReadingResiduals, RefuseListsThatDoNotFit) {
  ReadingResiduals residuals(an_angle_and_a_pixel_detector(), kBodies);
  EXPECT_THROW(residuals.add(std::vector{reading(4, 1)}, {}, {true}), std::invalid_argument);
  EXPECT_THROW(residuals.add(std::vector{reading(4, 1)}, std::vector<Residual>(1), {}), std::invalid_argument);
}

TEST(DoubtsAbout, NameADetectorThatIsSilentMisplacedOrNoisy) {
  const ResidualRow good{"detector", 1, "a", "rad", 1000, 990, 1.0, 0.1, 1e-4, 7e-5};
  ResidualRow silent = good, misplaced = good, noisy = good, marker = good;
  silent.readings = silent.inliers = 0;
  misplaced.inliers = 120;
  noisy.rms_sigma = 4.2;
  marker.of = "marker";
  marker.inliers = 300;
  EXPECT_THAT(doubts_about({good, silent, misplaced, noisy, marker}),
              ElementsAre("detector 1 (a) has no reading while the body is tracked",
                          "detector 1 (a): only 12 % of its readings are explained: check its pose and model",
                          "detector 1 (a): residuals are 4.2 times its sigma: calibrate it, or state a larger sigma",
                          "marker 1 (a): only 30 % of its readings are explained: check its place on the body and its "
                          "identity"));
}

}  // namespace
}  // namespace alidade
