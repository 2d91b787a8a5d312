// SPDX-License-Identifier: Apache-2.0
#include "features/matching.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 17;

// Rows whose only entry, at their own place, is 100: any two differ by 141.
cv::Mat unit_rows(const std::vector<int>& places) {
  cv::Mat rows = cv::Mat::zeros(static_cast<int>(places.size()), 128, CV_32F);
  for (std::size_t i = 0; i < places.size(); ++i) rows.at<float>(static_cast<int>(i), places[i]) = 100;
  return rows;
}

bool contains(const std::vector<Match>& matches, int a, int b) {
  return std::any_of(matches.begin(), matches.end(), [=](const Match& m) { return m.a == a && m.b == b; });
}

TEST(MatchDescriptors, FindsThePermutation) {
  const auto matches = match_descriptors(unit_rows({3, 1, 4, 15, 9}), unit_rows({9, 4, 77, 3}), 0.8);
  EXPECT_EQ(matches.size(), 3u);
  EXPECT_TRUE(contains(matches, 0, 3));
  EXPECT_TRUE(contains(matches, 2, 1));
  EXPECT_TRUE(contains(matches, 4, 0));
}

// b's rows 0 and 1 lie 3 and 4 from a's row 0: a ratio of 0.75.
TEST(MatchDescriptors, NeedsADistinctNearestOne) {
  const cv::Mat a = unit_rows({10, 20});
  cv::Mat b = unit_rows({10, 10, 20});
  b.at<float>(0, 50) = 3;
  b.at<float>(1, 60) = 4;
  EXPECT_TRUE(contains(match_descriptors(a, b, 0.76), 0, 0));
  const auto strict = match_descriptors(a, b, 0.74);
  ASSERT_EQ(strict.size(), 1u);
  EXPECT_TRUE(contains(strict, 1, 2));
}

// Two rows of a have the same nearest row of b; only the nearer of them is chosen back.
TEST(MatchDescriptors, AreMutual) {
  cv::Mat a = unit_rows({10, 10, 30});
  a.at<float>(0, 50) = 5;
  a.at<float>(1, 50) = 1;
  const auto matches = match_descriptors(a, unit_rows({10, 20, 30}), 0.8);
  EXPECT_EQ(matches.size(), 2u);
  EXPECT_TRUE(contains(matches, 1, 0));
  EXPECT_TRUE(contains(matches, 2, 2));
}

TEST(MatchDescriptors, AreNoneWithoutASecondNearest) {
  EXPECT_TRUE(match_descriptors(unit_rows({1, 2}), unit_rows({1}), 0.8).empty());
  EXPECT_TRUE(match_descriptors(unit_rows({1, 2}), cv::Mat(), 0.8).empty());
  EXPECT_TRUE(match_descriptors(cv::Mat(), unit_rows({1, 2}), 0.8).empty());
}

TEST(FeatureGrid, FindsWhatLiesWithinTheRadius) {
  test::RandomGeometry random(kSeed);
  Features features;
  for (int i = 0; i < 500; ++i) features.pixels.emplace_back(random.uniform(-0.3, 320), random.uniform(-0.3, 240));
  const FeatureGrid grid(features, 16.0);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector2d place(random.uniform(-60, 380), random.uniform(-60, 300));
    const double radius = random.uniform(0.5, 70);
    std::vector<int> expected;
    for (int i = 0; i < features.size(); ++i) {
      if ((features.pixels[static_cast<std::size_t>(i)] - place).norm() <= radius) expected.push_back(i);
    }
    std::vector<int> found = grid.within(place, radius);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected) << "trial " << trial << ", seed " << kSeed;
  }
}

TEST(FeatureGrid, OfNoFeaturesFindsNone) {
  const Features none;
  EXPECT_TRUE(FeatureGrid(none, 16.0).within({10, 10}, 1000).empty());
}

class BestCandidate : public testing::Test {
 protected:
  BestCandidate() {
    features_.pixels.resize(4);
    features_.descriptors = unit_rows({10, 10, 30, 40});
    features_.descriptors.at<float>(0, 50) = 30;  // 30 from the descriptor asked for
    features_.descriptors.at<float>(1, 60) = 40;  // 40 from it
  }

  Features features_;
  cv::Mat asked_ = unit_rows({10});
};

TEST_F(BestCandidate, IsTheNearestOfTheCandidates) {
  EXPECT_EQ(best_candidate(features_, {3, 1, 0, 2}, asked_.ptr<float>()), 0);
  EXPECT_EQ(best_candidate(features_, {3, 1, 2}, asked_.ptr<float>()), 1);
}

TEST_F(BestCandidate, IsEmptyWhereTheSecondIsAboutAsNear) {
  GuidedOptions options;
  options.ratio = 0.74;
  EXPECT_FALSE(best_candidate(features_, {0, 1}, asked_.ptr<float>(), options));
  EXPECT_FALSE(best_candidate(features_, {1, 0}, asked_.ptr<float>(), options));
  options.ratio = 0.76;
  EXPECT_EQ(best_candidate(features_, {1, 0}, asked_.ptr<float>(), options), 0);
}

TEST_F(BestCandidate, IsEmptyWhereNoneIsNear) {
  GuidedOptions options;
  options.most_distance = 29;
  EXPECT_FALSE(best_candidate(features_, {0, 3}, asked_.ptr<float>(), options));
  options.most_distance = 31;
  EXPECT_EQ(best_candidate(features_, {0, 3}, asked_.ptr<float>(), options), 0);
  EXPECT_FALSE(best_candidate(features_, {}, asked_.ptr<float>()));
}

TEST_F(BestCandidate, MayStandAlone) {
  EXPECT_EQ(best_candidate(features_, {1}, asked_.ptr<float>()), 1);
}

}  // namespace
}  // namespace alidade
