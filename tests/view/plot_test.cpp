// SPDX-License-Identifier: Apache-2.0
#include "view/plot.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace alidade {
namespace {

constexpr Rgb kRed{255, 0, 0};

// Bounding box of what is drawn in a colour close to pure red.
cv::Rect red_area(const cv::Mat& picture) {
  cv::Mat mask;
  cv::inRange(picture, cv::Scalar(0, 0, 200), cv::Scalar(60, 60, 255), mask);
  std::vector<cv::Point> at;
  cv::findNonZero(mask, at);
  if (at.empty()) return {};
  cv::Rect area(at.front(), cv::Size(1, 1));
  for (const auto& p : at) area |= cv::Rect(p, cv::Size(1, 1));
  return area;
}

Plot with(std::vector<double> x, std::vector<double> y, SeriesStyle style = SeriesStyle::Line) {
  Plot plot;
  plot.series = {{"", std::move(x), std::move(y), style, kRed}};
  return plot;
}

TEST(DrawPlot, FillsItsAreaWithTheData) {
  const cv::Rect area = red_area(draw_plot(with({0, 1, 2}, {-5, 7, 3}), {600, 300}));
  EXPECT_GT(area.width, 500);
  EXPECT_GT(area.height, 180);
}

TEST(DrawPlot, RisingDataRiseOnPaper) {
  const cv::Mat picture = draw_plot(with({0, 1}, {1, 2}), {600, 300});
  const cv::Rect area = red_area(picture);
  const cv::Rect left(area.tl(), cv::Size(area.width / 4, area.height));
  EXPECT_GT(red_area(picture(left)).y + left.y, area.y + area.height / 2);
}

TEST(DrawPlot, IsNotBentByValuesThatAreNotFinite) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const cv::Rect plain = red_area(draw_plot(with({0, 1, 3, 4}, {1, 2, 2, 1}), {600, 300}));
  const cv::Rect gaps = red_area(draw_plot(with({0, 1, 2, nan, 3, 4}, {1, 2, infinity, 1, 2, 1}), {600, 300}));
  EXPECT_NEAR(plain.x, gaps.x, 1);
  EXPECT_NEAR(plain.y, gaps.y, 1);
  EXPECT_NEAR(plain.br().x, gaps.br().x, 1);
  EXPECT_NEAR(plain.br().y, gaps.br().y, 1);
}

TEST(DrawPlot, LeavesAGapWhereAValueIsMissing) {
  const cv::Mat whole = draw_plot(with({0, 1, 2, 3}, {1, 1, 1, 1}), {600, 300});
  const cv::Mat gap = draw_plot(with({0, 1, 2, 3}, {1, std::nan(""), 1, 1}), {600, 300});
  const auto count = [](const cv::Mat& picture) {
    cv::Mat mask;
    cv::inRange(picture, cv::Scalar(0, 0, 200), cv::Scalar(60, 60, 255), mask);
    return cv::countNonZero(mask);
  };
  EXPECT_NEAR(count(gap), count(whole) / 3.0, count(whole) * 0.05);
}

TEST(DrawPlot, ACircleIsRoundOnEqualAxes) {
  std::vector<double> x, y;
  for (int i = 0; i <= 90; ++i) {
    x.push_back(1000 + 3 * std::cos(i * std::numbers::pi / 45));
    y.push_back(3 * std::sin(i * std::numbers::pi / 45));
  }
  Plot plot = with(x, y);
  plot.equal_axes = true;
  for (const cv::Size size : {cv::Size(900, 300), cv::Size(300, 700)}) {
    const cv::Rect area = red_area(draw_plot(plot, size));
    EXPECT_NEAR(area.width, area.height, 2);
    EXPECT_GT(area.width, 100);
  }
}

TEST(DrawPlot, LogarithmicAxisMakesAnExponentialStraight) {
  std::vector<double> x, y;
  for (int i = 0; i <= 100; ++i) {
    x.push_back(i);
    y.push_back(std::pow(10.0, i * 0.05 - 3));
  }
  y[50] = 0;  // cannot be shown, must not matter
  Plot plot = with(x, y);
  plot.log_y = true;
  const cv::Mat picture = draw_plot(plot, {600, 400});
  const cv::Rect area = red_area(picture);
  const cv::Rect quarter(area.x + area.width / 4 - 1, area.y, 3, area.height);
  EXPECT_NEAR(red_area(picture(quarter)).y, area.height * 0.75, 5);
}

TEST(DrawPlot, DrawsConstantAndSinglePointSeries) {
  EXPECT_FALSE(red_area(draw_plot(with({0, 1}, {0, 0}))).empty());
  EXPECT_FALSE(red_area(draw_plot(with({5}, {1e9}))).empty());
  EXPECT_FALSE(red_area(draw_plot(with({5}, {-1e-9}, SeriesStyle::Dots))).empty());
  EXPECT_FALSE(red_area(draw_plot(with({0, 9}, {1, 2}, SeriesStyle::Dashed))).empty());
}

TEST(DrawPlot, IsEmptyAxesWithoutData) {
  Plot log;
  log.log_y = true;
  EXPECT_EQ(draw_plot(Plot{}, {300, 200}).size(), cv::Size(300, 200));
  EXPECT_EQ(draw_plot(log, {300, 200}).type(), CV_8UC3);
}

TEST(DrawPlot, RefusesUnevenSeriesAndTinyPictures) {
  EXPECT_THROW(draw_plot(with({0, 1}, {0})), std::invalid_argument);
  EXPECT_THROW(draw_plot(Plot{}, {100, 200}), std::invalid_argument);
}

TEST(DrawPlots, StacksThemInAColumn) {
  const std::vector<Plot> plots(3);
  EXPECT_EQ(draw_plots(plots, {400, 200}).size(), cv::Size(400, 600));
  EXPECT_TRUE(draw_plots({}, {400, 200}).empty());
}

}  // namespace
}  // namespace alidade
