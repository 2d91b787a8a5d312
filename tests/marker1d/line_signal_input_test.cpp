// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "datasets/line_image_scene.h"
#include "marker1d/blink_code.h"
#include "marker1d/line_signal.h"

namespace alidade {
namespace {

TEST(LineSignal, OfDarkOrSaturatedOrTooFewRowsHasNoReadings) {
  LineSignalOptions options;
  options.signs = line_image_scene(blink_codes(4)).signs;
  EXPECT_TRUE(read_rows(cv::Mat::zeros(50, 2048, CV_8U), options).readings.empty());
  EXPECT_TRUE(read_rows(cv::Mat(50, 2048, CV_16U, cv::Scalar(65535)), options).readings.empty());
  EXPECT_TRUE(read_rows(cv::Mat(), options).readings.empty());
  const LineImageScene scene = line_image_scene(blink_codes(4));
  const cv::Mat row = render_line_image(scene, scene.detectors[0], 1);
  const auto single = read_rows(row, options);
  EXPECT_TRUE(single.readings.empty());
  EXPECT_EQ(single.counts.rows, 1);
  EXPECT_GT(single.counts.peaks, 0);
}

TEST(LineSignal, OfNoiseAloneIsFiniteAndNamesNothing) {
  cv::Mat noise(300, 512, CV_16U);
  cv::theRNG().state = 5;
  cv::randu(noise, 0, 65535);
  LineSignalOptions options;
  options.signs = line_image_scene(blink_codes(4)).signs;
  options.peaks.threshold = 3.0;
  const auto read = read_rows(noise, options);
  for (const LineReading& reading : read.readings) {
    EXPECT_TRUE(std::isfinite(reading.value) && reading.sigma > 0 && std::isfinite(reading.sigma));
  }
  EXPECT_LE(read.readings.size(), 5u);
}

TEST(LineSignal, RefusesWhatItCannotRead) {
  LineSignalOptions options;
  EXPECT_THROW(LineSignal{options}, std::invalid_argument);
  options.signs = line_image_scene(blink_codes(4)).signs;
  EXPECT_THROW(read_rows(cv::Mat::zeros(5, 100, CV_32F), options), std::invalid_argument);
  options.rate_hz = 0.0;
  EXPECT_THROW(LineSignal{options}, std::invalid_argument);
  options.rate_hz = 250.0;
  options.signs[1].code = options.signs[0].code;
  EXPECT_THROW(LineSignal{options}, std::invalid_argument);
}

}  // namespace
}  // namespace alidade
