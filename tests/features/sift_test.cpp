// SPDX-License-Identifier: Apache-2.0
#include "features/sift.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 5;

struct Blob {
  Eigen::Vector2d centre;
  double sigma_px;
  double depth;  // grey levels
};

cv::Mat render(const std::vector<Blob>& blobs, int width, int height) {
  cv::Mat image(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double grey = 200;
      for (const Blob& b : blobs) {
        const double r2 = (Eigen::Vector2d(x, y) - b.centre).squaredNorm() / (b.sigma_px * b.sigma_px);
        if (r2 < 40) grey -= b.depth * std::exp(-0.5 * r2);
      }
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(grey);
    }
  }
  return image;
}

// Blobs on a lattice, each at a random fraction of a pixel, `depth` grey levels deep.
std::vector<Blob> lattice(int columns, int rows, double depth) {
  test::RandomGeometry random(kSeed);
  std::vector<Blob> blobs;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      blobs.push_back({{40 + 48 * column + random.uniform(-0.5, 0.5), 40 + 48 * row + random.uniform(-0.5, 0.5)},
                       2.0 + 0.5 * ((row + column) % 5),
                       depth});
    }
  }
  return blobs;
}

std::optional<Eigen::Vector2d> feature_at(const Features& features, const Eigen::Vector2d& place) {
  std::optional<Eigen::Vector2d> nearest;
  for (const Eigen::Vector2d& pixel : features.pixels) {
    if ((pixel - place).norm() < 1.0 && (!nearest || (pixel - place).norm() < (*nearest - place).norm()))
      nearest = pixel;
  }
  return nearest;
}

// OpenCV's own positions are off by a quarter pixel in each direction.
TEST(DetectSift, FindsBlobsWithoutBias) {
  const std::vector<Blob> blobs = lattice(10, 8, 120);
  const Features features = detect_sift(render(blobs, 520, 424));
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int found = 0;
  for (const Blob& blob : blobs) {
    const auto pixel = feature_at(features, blob.centre);
    if (!pixel) continue;
    EXPECT_LT((*pixel - blob.centre).norm(), 0.15);
    sum += *pixel - blob.centre;
    ++found;
  }
  ASSERT_GE(found, 76) << "of " << blobs.size() << ", seed " << kSeed;
  EXPECT_LT(std::abs(sum.x() / found), 0.02) << "seed " << kSeed;
  EXPECT_LT(std::abs(sum.y() / found), 0.02) << "seed " << kSeed;
}

// A Gaussian of sigma s answers most strongly at a difference of Gaussians of scale about s: OpenCV's size is twice it.
TEST(DetectSift, ReportsLargerSizesForLargerBlobs) {
  const std::vector<Blob> blobs{{{60, 60}, 3, 120}, {{180, 60}, 9, 120}};
  const Features features = detect_sift(render(blobs, 240, 120));
  double small = 0, large = 0;
  for (int i = 0; i < features.size(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    if ((features.pixels[index] - blobs[0].centre).norm() < 1) small = features.sizes[index];
    if ((features.pixels[index] - blobs[1].centre).norm() < 1) large = features.sizes[index];
  }
  ASSERT_GT(small, 0);
  EXPECT_NEAR(large / small, 3.0, 0.6);
}

// Blobs three grey levels deep are below the default threshold and above the lowest.
TEST(DetectSift, LowersTheContrastWhereThereAreTooFew) {
  const cv::Mat faint = render(lattice(6, 5, 3), 330, 280);
  SiftOptions options;
  options.fewest = 0;
  options.contrast = 0.02;
  const int few = detect_sift(faint, options).size();
  options.fewest = 400;
  const int more = detect_sift(faint, options).size();
  EXPECT_GT(more, few + 15) << few << " -> " << more;
  options.lowest_contrast = 0.02;
  EXPECT_EQ(detect_sift(faint, options).size(), few);
}

TEST(DetectSift, KeepsTheStrongestWhereThereAreTooMany) {
  std::vector<Blob> blobs = lattice(6, 5, 40);
  for (std::size_t i = 0; i < blobs.size(); i += 3) blobs[i].depth = 150;
  SiftOptions options;
  options.most = 10;
  options.fewest = 0;
  const Features features = detect_sift(render(blobs, 330, 280), options);
  ASSERT_GE(features.size(), 8);
  EXPECT_LE(features.size(), 16);  // ten and their equals: the orientations of one place are equally strong
  for (const Eigen::Vector2d& pixel : features.pixels) {
    bool is_strong = false;
    for (std::size_t i = 0; i < blobs.size(); i += 3) is_strong |= (pixel - blobs[i].centre).norm() < 1;
    EXPECT_TRUE(is_strong) << pixel.transpose();
  }
}

// The root of a histogram of sum 1 has length 1; as bytes it is 512 long but for rounding.
TEST(DetectSift, DescribesByRootSift) {
  const Features features = detect_sift(render(lattice(6, 5, 120), 330, 280));
  ASSERT_GT(features.size(), 20);
  ASSERT_EQ(features.descriptors.rows, features.size());
  ASSERT_EQ(features.descriptors.cols, 128);
  ASSERT_EQ(features.descriptors.type(), CV_32F);
  ASSERT_EQ(features.sizes.size(), features.pixels.size());
  for (int i = 0; i < features.size(); ++i) EXPECT_NEAR(cv::norm(features.descriptors.row(i)), 512, 12);
}

TEST(DescriptorBytes, AreTheRowsWithoutLoss) {
  const Features features = detect_sift(render(lattice(4, 4, 120), 230, 230));
  ASSERT_GT(features.size(), 5);
  const Descriptor first = descriptor_bytes(features, 0);
  const Descriptor last = descriptor_bytes(features, features.size() - 1);
  const cv::Mat rows = descriptor_rows({&last, &first});
  EXPECT_EQ(cv::norm(rows.row(0), features.descriptors.row(features.size() - 1)), 0.0);
  EXPECT_EQ(cv::norm(rows.row(1), features.descriptors.row(0)), 0.0);
  EXPECT_EQ(descriptor_rows({}).rows, 0);
}

TEST(DetectSift, FindsNothingInAnEmptyScene) {
  const Features features = detect_sift(cv::Mat(100, 120, CV_8UC1, cv::Scalar(90)));
  EXPECT_EQ(features.size(), 0);
  EXPECT_EQ(features.descriptors.rows, 0);
}

TEST(DetectSift, RefusesWhatIsNoGreyImage) {
  EXPECT_THROW(detect_sift(cv::Mat()), std::invalid_argument);
  EXPECT_THROW(detect_sift(cv::Mat(50, 50, CV_8UC3, cv::Scalar::all(9))), std::invalid_argument);
  EXPECT_THROW(detect_sift(cv::Mat(50, 50, CV_16UC1, cv::Scalar(9))), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
