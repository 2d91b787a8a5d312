// SPDX-License-Identifier: Apache-2.0
#include "features/patch_alignment.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace alidade {
namespace {

constexpr int kSize = 120;
const Eigen::Vector2d kReference(60.3, 57.8);
const Eigen::Vector2d kLikeness(58.6, 61.2);

// A smooth texture without symmetry, grey levels about 128.
double texture(const Eigen::Vector2d& p) {
  return 128 + 30 * std::sin(0.55 * p.x() + 0.21 * p.y()) + 25 * std::sin(0.13 * p.x() - 0.47 * p.y() + 1.0) +
         20 * std::cos(0.31 * p.x() + 0.62 * p.y() + 0.5);
}

Eigen::Matrix2d tilt() {
  Eigen::Matrix2d A;
  A << 1.12, 0.10, -0.06, 0.93;
  return A;
}

// The texture as seen with kReference moved to kLikeness and A about it, brighter and with less contrast.
cv::Mat image_of(const Eigen::Matrix2d& A, double gain, double offset) {
  cv::Mat image(kSize, kSize, CV_8U);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const Eigen::Vector2d p = kReference + A.inverse() * (Eigen::Vector2d(x, y) - kLikeness);
      image.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(gain * texture(p) + offset);
    }
  }
  return image;
}

cv::Mat reference_image() {
  cv::Mat image(kSize, kSize, CV_8U);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) image.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(texture({x, y}));
  }
  return image;
}

TEST(AlignPatch, FindsTheLikenessToAFewHundredthsOfAPixel) {
  const cv::Mat reference = reference_image();
  const cv::Mat image = image_of(tilt(), 0.7, 40);
  for (const Eigen::Vector2d& off : {Eigen::Vector2d(0.8, -0.6), Eigen::Vector2d(-1.0, 0.4), Eigen::Vector2d(0, 0)}) {
    const auto aligned = align_patch(reference, kReference, image, kLikeness + off, Eigen::Matrix2d::Identity());
    ASSERT_TRUE(aligned);
    EXPECT_LT((aligned->pixel - kLikeness).norm(), 0.05);
    EXPECT_GT(aligned->correlation, 0.98);
  }
}

TEST(AlignPatch, StartsFromTheGivenMapWhereTheTiltIsStrong) {
  Eigen::Matrix2d A;
  A << 0.1, -1.3, 1.2, 0.2;  // turned by about a right angle
  const auto aligned =
      align_patch(reference_image(), kReference, image_of(A, 1, 0), kLikeness + Eigen::Vector2d(0.5, 0.5), 1.05 * A);
  ASSERT_TRUE(aligned);
  EXPECT_LT((aligned->pixel - kLikeness).norm(), 0.1);
}

TEST(AlignPatch, RefusesAnotherTexture) {
  const cv::Mat other = reference_image().t();
  EXPECT_FALSE(align_patch(reference_image(), kReference, other, {80, 30}, Eigen::Matrix2d::Identity()));
  const cv::Mat flat(kSize, kSize, CV_8U, cv::Scalar(90));
  EXPECT_FALSE(align_patch(reference_image(), kReference, flat, kLikeness, Eigen::Matrix2d::Identity()));
}

TEST(AlignPatch, RefusesWhatLeavesTheImage) {
  const cv::Mat image = image_of(tilt(), 1, 0);
  EXPECT_FALSE(align_patch(reference_image(), {3, 60}, image, kLikeness, tilt()));
  EXPECT_FALSE(align_patch(reference_image(), kReference, image, {117, 60}, tilt()));
  EXPECT_FALSE(align_patch(reference_image(), kReference, image, kLikeness, 20 * tilt()));
}

}  // namespace
}  // namespace alidade
