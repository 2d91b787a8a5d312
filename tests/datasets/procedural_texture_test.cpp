// SPDX-License-Identifier: Apache-2.0
#include "datasets/procedural_texture.h"

#include <vector>

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

LeafTextureOptions square_metre(std::uint64_t seed, double texel_m) {
  LeafTextureOptions options;
  options.texel_m = texel_m;
  options.seed = seed;
  return options;
}

TEST(LeafTexture, HasTheSizeAskedFor) {
  LeafTextureOptions options = square_metre(1, 0.004);
  options.size_m = {2.0, 0.5};
  EXPECT_EQ(leaf_texture(options).size(), cv::Size(500, 125));
  options.size_m = {1e-3, 1e-3};
  EXPECT_EQ(leaf_texture(options).size(), cv::Size(8, 8));
}

TEST(LeafTexture, IsTheSameForASeedAndAnotherForAnother) {
  const cv::Mat a = leaf_texture(square_metre(3, 0.004)), b = leaf_texture(square_metre(3, 0.004));
  const cv::Mat c = leaf_texture(square_metre(4, 0.004));
  EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(a, c, cv::NORM_L1) / static_cast<double>(a.total() * 3), 15);
}

TEST(LeafTexture, ShowsTheSameFiguresAtAnotherResolution) {
  cv::Mat fine = leaf_texture(square_metre(3, 0.002)), coarse = leaf_texture(square_metre(3, 0.004));
  cv::resize(fine, fine, coarse.size(), 0, 0, cv::INTER_AREA);
  EXPECT_LT(cv::norm(fine, coarse, cv::NORM_L1) / static_cast<double>(coarse.total() * 3), 8);
}

TEST(LeafTexture, HasFeaturesAtEveryScale) {
  std::vector<cv::KeyPoint> features;
  cv::SIFT::create()->detect(leaf_texture(square_metre(5, 0.002)), features);
  int small = 0, middle = 0, large = 0;
  for (const auto& f : features) (f.size < 8 ? small : f.size < 24 ? middle : large)++;
  EXPECT_GT(small, 100);
  EXPECT_GT(middle, 100);
  EXPECT_GT(large, 10);
}

}  // namespace
}  // namespace alidade
