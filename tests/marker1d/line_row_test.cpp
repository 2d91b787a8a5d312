// SPDX-License-Identifier: Apache-2.0
#include "marker1d/line_row.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "marker1d/line_peaks.h"

namespace alidade {
namespace {

TEST(PrepareRow, TakesAwayLightThatRisesAlongTheRow) {
  cv::Mat row(1, 1024, CV_16U);
  for (int i = 0; i < row.cols; ++i) row.at<std::uint16_t>(0, i) = static_cast<std::uint16_t>(500 + 3 * i);
  const LineRow prepared = prepare_row(row);
  EXPECT_LT(prepared.signal.abs().maxCoeff(), 2.0);
  EXPECT_TRUE(prepared.is_usable.all());
}

TEST(PrepareRow, TakesTheNoiseFromTheRowWhateverItsSpots) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(1000.0, 25.0);
  cv::Mat row(1, 2048, CV_16U);
  for (int i = 0; i < row.cols; ++i) row.at<std::uint16_t>(0, i) = cv::saturate_cast<std::uint16_t>(normal(random));
  row.colRange(100, 110).setTo(30000);
  row.colRange(900, 910).setTo(65535);
  const LineRow prepared = prepare_row(row);
  EXPECT_NEAR(std::sqrt(prepared.variance(0, 0)), 25.0, 2.5);
  EXPECT_EQ(prepared.is_saturated.count(), 10);
  EXPECT_FALSE(prepared.is_usable(905));
}

TEST(PrepareRow, AddsTheShotNoiseOfTheBackgroundToAKnownReadNoise) {
  const LineRow prepared = prepare_row(cv::Mat(1, 100, CV_8U, cv::Scalar(50)), {3.0, 0.5});
  EXPECT_NEAR(prepared.variance(40, 0), 9.0 + 0.5 * 50.0, 1e-12);
}

TEST(FindPeaks, OfARowWithoutContrastIsEmpty) {
  EXPECT_TRUE(find_peaks(cv::Mat(1, 2048, CV_8U, cv::Scalar(0))).empty());
  EXPECT_TRUE(find_peaks(cv::Mat(1, 2048, CV_8U, cv::Scalar(255))).empty());
  EXPECT_TRUE(find_peaks(cv::Mat(1, 2048, CV_16UC3, cv::Scalar(7, 8, 9))).empty());
  EXPECT_TRUE(find_peaks(cv::Mat(1, 1, CV_8U, cv::Scalar(9))).empty());
  EXPECT_TRUE(find_peaks(std::vector<float>(100, std::numeric_limits<float>::quiet_NaN())).empty());
}

TEST(FindPeaks, OfAnythingElseThanARowThrows) {
  EXPECT_THROW(find_peaks(cv::Mat()), std::invalid_argument);
  EXPECT_THROW(find_peaks(cv::Mat::zeros(2, 100, CV_8U)), std::invalid_argument);
  EXPECT_THROW(find_peaks(cv::Mat::zeros(1, 100, CV_32F)), std::invalid_argument);
  EXPECT_THROW(find_peaks(cv::Mat::zeros(1, 100, CV_8UC4)), std::invalid_argument);
  EXPECT_THROW(find_peaks(std::vector<float>{}), std::invalid_argument);
}

TEST(FindPeaks, WithImpossibleOptionsThrows) {
  const cv::Mat row = cv::Mat::zeros(1, 100, CV_8U);
  LinePeakOptions options;
  options.spot_sigma_px = std::nan("");
  EXPECT_THROW(find_peaks(row, options), std::invalid_argument);
  options = {};
  options.threshold = 0.0;
  EXPECT_THROW(find_peaks(row, options), std::invalid_argument);
  options = {};
  options.noise.read = -1.0;
  EXPECT_THROW(find_peaks(row, options), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
