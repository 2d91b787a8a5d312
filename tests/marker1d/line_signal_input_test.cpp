// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "datasets/line_image_scene.h"
#include "marker1d/blink_code.h"
#include "marker1d/line_signal.h"

namespace alidade {
namespace {

LineImageScene scene() {
  return line_image_scene({}, blink_codes(4));
}

std::vector<LineReading> read_all(const cv::Mat& image, const LineSignalOptions& options) {
  LineSignals signals({options});
  auto readings = signals.read({{image}});
  const auto last = signals.finish();
  readings.insert(readings.end(), last.begin(), last.end());
  return readings;
}

TEST(LineSignal, OfDarkOrSaturatedOrTooFewRowsHasNoReadings) {
  LineSignalOptions options;
  options.signs = scene().signs;
  EXPECT_TRUE(read_all(cv::Mat::zeros(50, 2048, CV_8U), options).empty());
  EXPECT_TRUE(read_all(cv::Mat(50, 2048, CV_16U, cv::Scalar(65535)), options).empty());
  EXPECT_TRUE(read_all(cv::Mat(), options).empty());
  LineSignal signal(options);
  EXPECT_TRUE(signal.read_row(LineImageRecording(scene()).next(1)->images[0], 0).empty());
  EXPECT_EQ(signal.counts().rows, 1);
  EXPECT_GT(signal.counts().peaks, 0);
}

TEST(LineSignal, OfNoiseAloneIsFiniteAndNamesNothing) {
  cv::Mat noise(300, 512, CV_16U);
  cv::theRNG().state = 5;
  cv::randu(noise, 0, 65535);
  LineSignalOptions options;
  options.signs = scene().signs;
  options.peaks.threshold = 3.0;
  const auto readings = read_all(noise, options);
  for (const LineReading& reading : readings) {
    EXPECT_TRUE(std::isfinite(reading.value) && reading.sigma > 0 && std::isfinite(reading.sigma));
  }
  EXPECT_LE(readings.size(), 5u);
}

TEST(LineSignal, RefusesWhatItCannotRead) {
  LineSignalOptions options;
  EXPECT_THROW(LineSignal{options}, std::invalid_argument);
  options.signs = scene().signs;
  EXPECT_THROW(read_all(cv::Mat::zeros(5, 100, CV_32F), options), std::invalid_argument);
  options.rate_hz = 0.0;
  EXPECT_THROW(LineSignal{options}, std::invalid_argument);
  options.rate_hz = 250.0;
  options.signs[1].code = options.signs[0].code;
  EXPECT_THROW(LineSignal{options}, std::invalid_argument);
}

}  // namespace
}  // namespace alidade
