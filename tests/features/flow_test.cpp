// SPDX-License-Identifier: Apache-2.0
#include "features/flow.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 23;
constexpr int kWidth = 240, kHeight = 180;

// A smooth random texture, moved by `shift`: a sum of plane waves with wavelengths from 8 to 60 px.
cv::Mat texture(const Eigen::Vector2d& shift) {
  test::RandomGeometry random(kSeed);
  struct Wave {
    Eigen::Vector2d k;
    double phase;
  };
  std::vector<Wave> waves;
  for (int i = 0; i < 24; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double length_px = random.uniform(8, 60);
    waves.push_back({2 * std::numbers::pi / length_px * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                     random.uniform(0, 2 * std::numbers::pi)});
  }
  cv::Mat image(kHeight, kWidth, CV_8UC1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      double sum = 0;
      for (const Wave& w : waves) sum += std::cos(w.k.dot(Eigen::Vector2d(x, y) - shift) + w.phase);
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(128 + 22 * sum);
    }
  }
  return image;
}

std::vector<Eigen::Vector2d> places() {
  std::vector<Eigen::Vector2d> points;
  for (double y = 40; y < kHeight - 39; y += 20) {
    for (double x = 40; x < kWidth - 39; x += 20) points.emplace_back(x + 0.3, y - 0.2);
  }
  return points;
}

TEST(FollowPoints, FollowsAShiftedTexture) {
  const Eigen::Vector2d shift(3.37, -2.61);
  const auto points = places();
  const auto found = follow_points(make_flow_image(texture({0, 0})), make_flow_image(texture(shift)), points, points);
  ASSERT_EQ(found.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_TRUE(found[i]) << points[i].transpose();
    EXPECT_LT((*found[i] - points[i] - shift).norm(), 0.1) << points[i].transpose();
  }
}

// Without the guess the texture's own repetition would have to be bridged: 25 px are several of its wavelengths.
TEST(FollowPoints, StartsFromTheGuesses) {
  const Eigen::Vector2d shift(25.4, 12.8);
  std::vector<Eigen::Vector2d> points{{60, 60}, {100, 80}, {140, 100}};
  std::vector<Eigen::Vector2d> guesses;
  for (const auto& p : points) guesses.push_back(p + Eigen::Vector2d(24, 14));
  FlowOptions options;
  options.levels = 0;
  const auto found = follow_points(make_flow_image(texture({0, 0}), options), make_flow_image(texture(shift), options),
                                   points, guesses, options);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_TRUE(found[i]) << i;
    EXPECT_LT((*found[i] - points[i] - shift).norm(), 0.1) << i;
  }
}

TEST(FollowPoints, LosesWhatIsGone) {
  const auto points = places();
  const FlowImage from = make_flow_image(texture({0, 0}));
  const cv::Mat grey(kHeight, kWidth, CV_8UC1, cv::Scalar(128));
  for (const auto& found : follow_points(from, make_flow_image(grey), points, points)) EXPECT_FALSE(found);
}

// The left half is gone, the right half has moved.
TEST(FollowPoints, LosesOnlyWhatIsGone) {
  const Eigen::Vector2d shift(1.5, 0.5);
  cv::Mat half = texture(shift);
  half.colRange(0, kWidth / 2).setTo(cv::Scalar(128));
  const std::vector<Eigen::Vector2d> points{{60, 90}, {180, 90}};
  const auto found = follow_points(make_flow_image(texture({0, 0})), make_flow_image(half), points, points);
  EXPECT_FALSE(found[0]);
  ASSERT_TRUE(found[1]);
  EXPECT_LT((*found[1] - points[1] - shift).norm(), 0.1);
}

TEST(FollowPoints, LosesWhatLeavesTheImage) {
  const Eigen::Vector2d shift(-8, 0);
  const std::vector<Eigen::Vector2d> points{{3, 90}, {100, 90}};
  const auto found = follow_points(make_flow_image(texture({0, 0})), make_flow_image(texture(shift)), points, points);
  EXPECT_FALSE(found[0]);
  EXPECT_TRUE(found[1]);
}

TEST(FollowPoints, NeedsOneGuessPerPoint) {
  const FlowImage image = make_flow_image(texture({0, 0}));
  EXPECT_TRUE(follow_points(image, image, {}, {}).empty());
  EXPECT_THROW(follow_points(image, image, {{50, 50}}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
