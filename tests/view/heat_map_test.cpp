// SPDX-License-Identifier: Apache-2.0
#include "view/heat_map.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

HeatMap two_by_one(double left, double right) {
  HeatMap map{"bound", "x (m)", "y (m)", 2, 1, 0.0, 0.0, 1.0, {left, right}, {}};
  return map;
}

// The colour in the middle of a cell's upper half, where no number stands.
Rgb colour_of(const cv::Mat& picture, double column) {
  const auto bgr = picture.at<cv::Vec3b>(80, static_cast<int>(70 + (column + 0.5) * (400 - 70 - 16) / 2.0));
  return {bgr[2], bgr[1], bgr[0]};
}

TEST(HeatColour, GoesFromBlueOverYellowToRed) {
  EXPECT_GT(heat_colour(0)[2], heat_colour(0)[0]);
  EXPECT_GT(heat_colour(1)[0], heat_colour(1)[2]);
  EXPECT_EQ(heat_colour(-3), heat_colour(0));
  EXPECT_EQ(heat_colour(7), heat_colour(1));
}

TEST(HeatMap, ShowsEachValueInItsCell) {
  const std::vector<HeatMap> maps{two_by_one(1.0, 10.0)};
  const cv::Mat picture = draw_heat_maps(maps, {400, 300});
  EXPECT_EQ(picture.size(), cv::Size(400, 300));
  EXPECT_EQ(colour_of(picture, 0), heat_colour(0.0));
  EXPECT_NE(colour_of(picture, 1), heat_colour(0.0));
}

TEST(HeatMap, LeavesWhatIsUnknownBlank) {
  const std::vector<HeatMap> maps{two_by_one(1.0, std::numeric_limits<double>::quiet_NaN())};
  EXPECT_EQ(colour_of(draw_heat_maps(maps, {400, 300}), 1), palette::kPaper);
}

TEST(HeatMap, RefusesValuesThatDoNotFillTheCells) {
  HeatMap map = two_by_one(1.0, 2.0);
  map.values.pop_back();
  EXPECT_THROW(draw_heat_maps(std::vector{map}), std::invalid_argument);
  EXPECT_TRUE(draw_heat_maps({}).empty());
}

}  // namespace
}  // namespace alidade
