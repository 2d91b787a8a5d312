// SPDX-License-Identifier: Apache-2.0
#include "marker1d/line_peaks.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace alidade {
namespace {

constexpr double kSpotSigma_px = 1.2;

struct TestSpot {
  double position_px = 0.0, height = 0.0;
};

// A row of pixels as a line camera records it: spots integrated over their pixels on light that rises along the row.
struct TestRow {
  int width = 256;
  std::vector<TestSpot> spots;
  double ambient = 20.0, slope = 0.05;
  double read = 1.0, shot = 0.0;
};

double spot_light(double u) {  // its peak is 1 and its variance kSpotSigma_px², the pixel's 1/12 included
  const double optics = std::sqrt(kSpotSigma_px * kSpotSigma_px - 1.0 / 12.0), scale = std::numbers::sqrt2 * optics;
  const double integral = 0.5 * (std::erf((u + 0.5) / scale) - std::erf((u - 0.5) / scale));
  return integral * std::sqrt(2.0 * std::numbers::pi) * kSpotSigma_px;
}

double mean_light(const TestRow& row, int i) {
  double light = row.ambient + row.slope * i;
  for (const TestSpot& spot : row.spots) light += spot.height * spot_light(i - spot.position_px);
  return light;
}

cv::Mat draw(const TestRow& row, int type, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  cv::Mat image(1, row.width, type);
  for (int i = 0; i < row.width; ++i) {
    const double mean = mean_light(row, i);
    const double value = mean + std::sqrt(row.read * row.read + row.shot * mean) * normal(random);
    if (type == CV_8UC1) {
      image.at<std::uint8_t>(0, i) = cv::saturate_cast<std::uint8_t>(value);
    } else {
      image.at<std::uint16_t>(0, i) = cv::saturate_cast<std::uint16_t>(value);
    }
  }
  return image;
}

// The Cramér–Rao bound of the first spot's position (standard deviation, px), where the positions and heights of all
// spots and the light beneath them are unknown and the noise is the row's.
double position_bound(const TestRow& row) {
  const auto spots = static_cast<Eigen::Index>(row.spots.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(2 * spots + 1, 2 * spots + 1);
  for (int i = 0; i < row.width; ++i) {
    if (std::abs(i - row.spots.front().position_px) > 20.0) continue;
    Eigen::VectorXd J = Eigen::VectorXd::Ones(2 * spots + 1);
    for (Eigen::Index j = 0; j < spots; ++j) {
      const TestSpot& spot = row.spots[static_cast<std::size_t>(j)];
      constexpr double kStep = 1e-4;
      const double u = i - spot.position_px;
      J(2 * j) = spot.height * (spot_light(u - kStep) - spot_light(u + kStep)) / (2.0 * kStep);
      J(2 * j + 1) = spot_light(u);
    }
    information += J * J.transpose() / (row.read * row.read + row.shot * mean_light(row, i));
  }
  return std::sqrt(information.inverse()(0, 0));
}

// A spot whose highest pixel has this ratio of height to noise; half of its variance is shot noise.
TestRow row_of_snr(double snr, double height) {
  TestRow row;
  const double variance = std::pow(height / snr, 2);
  row.spots = {{0.0, height}};
  row.ambient = 0.15 * height;
  row.slope = 0.0005 * height;
  row.shot = 0.5 * variance / height;
  row.read = std::sqrt(0.5 * variance - row.shot * row.ambient);
  return row;
}

struct Trials {
  double error_to_bound = 0.0;  // RMS over RMS, of the spots found
  double error_to_sigma = 0.0;  // RMS of the errors in their own sigma_px
  double found_share = 0.0;
  double strays_per_row = 0.0;
};

Trials run_trials(TestRow row, int type, const LinePeakOptions& options, int count) {
  std::mt19937_64 random(20260101);
  std::uniform_real_distribution<double> position(60.0, 190.0);
  double error2 = 0.0, bound2 = 0.0, normalised2 = 0.0;
  int found = 0, strays = 0;
  for (int k = 0; k < count; ++k) {
    row.spots.front().position_px = position(random);
    for (const LinePeak& peak : find_peaks(draw(row, type, random), options)) {
      const double error = peak.position_px - row.spots.front().position_px;
      if (std::abs(error) > 3.0) {
        ++strays;
        continue;
      }
      ++found;
      error2 += error * error;
      normalised2 += std::pow(error / peak.sigma_px, 2);
      bound2 += std::pow(position_bound(row), 2);
    }
  }
  return {std::sqrt(error2 / bound2), std::sqrt(normalised2 / found), static_cast<double>(found) / count,
          static_cast<double>(strays) / count};
}

struct Light {
  double snr, height;
  int type;
};

class SpotOfSnr : public testing::TestWithParam<Light> {};

TEST_P(SpotOfSnr, IsFoundAsExactlyAsItsCramerRaoBoundAllows) {
  const TestRow row = row_of_snr(GetParam().snr, GetParam().height);
  LinePeakOptions options;
  options.noise = {row.read, row.shot};
  const Trials trials = run_trials(row, GetParam().type, options, 2000);
  RecordProperty("error_to_bound", std::to_string(trials.error_to_bound));
  EXPECT_LE(trials.error_to_bound, 1.1) << "wanted: 1.3";
  EXPECT_GE(trials.error_to_bound, 0.9) << "the bound of this test is wrong";
  EXPECT_NEAR(trials.error_to_sigma, 1.0, 0.1);
  EXPECT_GE(trials.found_share, 0.97);
  EXPECT_LE(trials.found_share, 1.0);
  EXPECT_LE(trials.strays_per_row, 0.01);
}

TEST_P(SpotOfSnr, IsFoundAlmostAsExactlyWhereTheNoiseIsTakenFromTheRow) {
  const TestRow row = row_of_snr(GetParam().snr, GetParam().height);
  const Trials trials = run_trials(row, GetParam().type, {}, 1000);
  RecordProperty("error_to_bound", std::to_string(trials.error_to_bound));
  EXPECT_LE(trials.error_to_bound, 1.3);
  EXPECT_GE(trials.found_share, 0.97);
  EXPECT_LE(trials.strays_per_row, 0.02);
}

INSTANTIATE_TEST_SUITE_P(EightBits, SpotOfSnr,
                         testing::Values(Light{5, 120, CV_8UC1}, Light{10, 120, CV_8UC1}, Light{30, 120, CV_8UC1},
                                         Light{100, 120, CV_8UC1}));
INSTANTIATE_TEST_SUITE_P(SixteenBits, SpotOfSnr,
                         testing::Values(Light{5, 12000, CV_16UC1}, Light{10, 12000, CV_16UC1},
                                         Light{30, 12000, CV_16UC1}, Light{100, 12000, CV_16UC1}));

TEST(FindPeaks, IsExactWithoutNoise) {
  TestRow row;
  row.spots = {{40.37, 20000.0}, {130.5, 30000.0}, {200.81, 8000.0}};
  row.ambient = 0.0;
  row.slope = 0.0;
  row.read = 0.0;
  std::mt19937_64 random(1);
  const auto peaks = find_peaks(draw(row, CV_16UC1, random));
  ASSERT_EQ(peaks.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(peaks[i].position_px, row.spots[i].position_px, 1e-3);
    EXPECT_NEAR(peaks[i].amplitude(0), row.spots[i].height, 0.01 * row.spots[i].height);
    EXPECT_FALSE(peaks[i].is_overlapped);
    EXPECT_FALSE(peaks[i].is_saturated);
  }
}

TEST(FindPeaks, MovesWithTheSpotsAndScalesWithTheirLight) {
  TestRow row;
  row.spots = {{100.25, 3000.0}};
  row.read = 0.0;
  std::mt19937_64 random(1);
  const auto here = find_peaks(draw(row, CV_16UC1, random));
  row.spots = {{107.25, 6000.0}};
  const auto there = find_peaks(draw(row, CV_16UC1, random));
  ASSERT_EQ(here.size(), 1u);
  ASSERT_EQ(there.size(), 1u);
  EXPECT_NEAR(there[0].position_px - here[0].position_px, 7.0, 2e-3);
  EXPECT_NEAR(there[0].amplitude(0) / here[0].amplitude(0), 2.0, 1e-2);
}

// Two spots `distance` apart at SNR 10 each.
struct PairTrials {
  double found_share = 0.0;     // rows in which there are two
  double error_to_bound = 0.0;  // of the left one in them
  double error_to_sigma = 0.0;
  double unflagged_lone_share = 0.0;  // rows with one peak, and no word of a neighbour
};

PairTrials run_pairs(double distance_px, int count) {
  TestRow row = row_of_snr(10, 12000);
  row.spots.push_back(row.spots.front());
  LinePeakOptions options;
  options.noise = {row.read, row.shot};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> position(100.0, 101.0);
  double error2 = 0.0, bound2 = 0.0, normalised2 = 0.0;
  int found = 0, unflagged = 0;
  for (int k = 0; k < count; ++k) {
    row.spots[0].position_px = position(random);
    row.spots[1].position_px = row.spots[0].position_px + distance_px;
    const auto peaks = find_peaks(draw(row, CV_16UC1, random), options);
    unflagged += peaks.size() == 1 && !peaks[0].is_overlapped;
    if (peaks.size() != 2) continue;
    ++found;
    const double error = peaks[0].position_px - row.spots[0].position_px;
    error2 += error * error;
    normalised2 += std::pow(error / peaks[0].sigma_px, 2);
    bound2 += std::pow(position_bound(row), 2);
  }
  return {static_cast<double>(found) / count, std::sqrt(error2 / bound2), std::sqrt(normalised2 / found),
          static_cast<double>(unflagged) / count};
}

TEST(OverlappingSpots, AreFittedTogetherAsExactlyAsTheirBoundAllows) {
  for (const double distance_px : {3.0, 4.0, 6.0, 9.0}) {
    const PairTrials trials = run_pairs(distance_px, 1000);
    EXPECT_GE(trials.found_share, 0.97) << distance_px;
    EXPECT_LE(trials.error_to_bound, 1.3) << distance_px;
    EXPECT_NEAR(trials.error_to_sigma, 1.0, 0.15) << distance_px;
  }
}

TEST(OverlappingSpots, AreRarelyTakenForOneWithoutAWord) {
  EXPECT_LE(run_pairs(2.5, 1000).unflagged_lone_share, 0.01);
  EXPECT_LE(run_pairs(2.0, 1000).unflagged_lone_share, 0.15);
}

TEST(SaturatedSpot, IsReadFromItsFlanks) {
  std::mt19937_64 random(3);
  for (const double height : {400.0, 1000.0, 4000.0}) {
    TestRow row;
    row.spots = {{120.3, height}};
    const auto peaks = find_peaks(draw(row, CV_8UC1, random));
    ASSERT_EQ(peaks.size(), 1u) << height;
    EXPECT_TRUE(peaks[0].is_saturated);
    EXPECT_NEAR(peaks[0].position_px, 120.3, std::max(0.02, 5.0 * peaks[0].sigma_px)) << height;
    EXPECT_LT(peaks[0].sigma_px, 0.5) << height;
  }
}

TEST(SaturatedSpot, WithoutFlanksIsAnywhereInItsRun) {
  cv::Mat row = cv::Mat::zeros(1, 200, CV_8U);
  row.colRange(90, 101).setTo(255);
  const auto peaks = find_peaks(row);
  ASSERT_EQ(peaks.size(), 1u);
  EXPECT_TRUE(peaks[0].is_saturated);
  EXPECT_NEAR(peaks[0].position_px, 95.0, 0.5);
  EXPECT_TRUE(std::isfinite(peaks[0].sigma_px));
}

TEST(FindPeaks, PassesNoiseAloneAboutOnceInTwoThousandRows) {
  TestRow row;
  row.width = 2048;
  row.read = 10.0;
  row.ambient = 2000.0;
  std::mt19937_64 random(11);
  int strays = 0;
  for (int k = 0; k < 400; ++k) strays += static_cast<int>(find_peaks(draw(row, CV_16UC1, random)).size());
  EXPECT_LE(strays, 3);
}

TEST(FindPeaks, ReadsTheSharesOfColours) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  cv::Mat row(1, 256, CV_8UC3);
  for (int i = 0; i < row.cols; ++i) {
    for (int c = 0; c < 3; ++c) {
      const double height = std::array{100.0, 50.0, 10.0}[static_cast<std::size_t>(c)];
      row.at<cv::Vec3b>(0, i)[c] =
          cv::saturate_cast<std::uint8_t>(30.0 + height * spot_light(i - 77.7) + 2.0 * normal(random));
    }
  }
  const auto peaks = find_peaks(row);
  ASSERT_EQ(peaks.size(), 1u);
  EXPECT_NEAR(peaks[0].position_px, 77.7, 4.0 * peaks[0].sigma_px);
  EXPECT_NEAR(peaks[0].amplitude(0), 100.0, 4.0 * peaks[0].channel_sigma(0));
  EXPECT_NEAR(peaks[0].amplitude(1), 50.0, 4.0 * peaks[0].channel_sigma(1));
  EXPECT_NEAR(peaks[0].amplitude(2), 10.0, 4.0 * peaks[0].channel_sigma(2));
}

TEST(FindPeaks, AtTheEndsOfTheRowIsFinite) {
  for (const double position : {-0.4, 0.2, 1.0, 254.1, 255.3}) {
    TestRow row;
    row.spots = {{position, 3000.0}};
    std::mt19937_64 random(2);
    const auto peaks = find_peaks(draw(row, CV_16UC1, random));
    ASSERT_EQ(peaks.size(), 1u) << position;
    EXPECT_NEAR(peaks[0].position_px, position, std::max(0.3, 5.0 * peaks[0].sigma_px));
    EXPECT_TRUE(std::isfinite(peaks[0].sigma_px));
  }
}

TEST(FindPeaks, OverlooksValuesThatAreNotFinite) {
  std::vector<float> row(256);
  std::mt19937_64 random(9);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 256; ++i)
    row[static_cast<std::size_t>(i)] = static_cast<float>(spot_light(i - 99.6)) + 0.01f * normal(random);
  row[97] = std::numeric_limits<float>::quiet_NaN();
  row[20] = std::numeric_limits<float>::infinity();
  const auto peaks = find_peaks(row);
  ASSERT_EQ(peaks.size(), 1u);
  EXPECT_NEAR(peaks[0].position_px, 99.6, 0.05);
  EXPECT_TRUE(std::isfinite(peaks[0].sigma_px) && std::isfinite(peaks[0].snr));
}

TEST(EstimateSpotSigma, FindsTheWidthOfTheSpotsItSees) {
  TestRow row = row_of_snr(20, 12000);
  row.spots = {{50.3, 12000.0}, {120.8, 12000.0}, {201.1, 12000.0}};
  std::mt19937_64 random(4);
  cv::Mat rows;
  for (int k = 0; k < 20; ++k) rows.push_back(draw(row, CV_16UC1, random));
  LinePeakOptions options;
  options.noise = {row.read, row.shot};
  for (const double assumed : {0.8, 1.2, 2.0}) {
    options.spot_sigma_px = assumed;
    const auto width = estimate_spot_sigma(rows, options);
    ASSERT_TRUE(width) << assumed;
    EXPECT_NEAR(*width, kSpotSigma_px, 0.03) << assumed;
  }
}

TEST(EstimateSpotSigma, OfDarkRowsIsEmpty) {
  EXPECT_FALSE(estimate_spot_sigma(cv::Mat::zeros(10, 256, CV_8U)));
  EXPECT_FALSE(estimate_spot_sigma(cv::Mat()));
}

}  // namespace
}  // namespace alidade
