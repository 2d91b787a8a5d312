// SPDX-License-Identifier: Apache-2.0
#include "app/capture_record.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

constexpr ImageExtent kImage{640, 480};

CaptureWish wish_at(double x, double y) {
  CaptureWish wish;
  wish.column = 1;
  wish.stance = {Eigen::Vector2d(x, y), BoardTilt::LeftNearer, 0.5236, 0.6};
  wish.outline_px.fill(Eigen::Vector2d(1, 2));
  return wish;
}

TEST(CaptureWishInWords, SaysWhereAndHow) {
  EXPECT_EQ(describe(wish_at(200, 150), kImage),
            "hold the board at the top left, its left side 30 deg nearer, filling 60 % of the image");
  EXPECT_TRUE(describe(wish_at(320, 240), kImage).starts_with("hold the board in the middle,"));
  EXPECT_TRUE(describe(wish_at(320, 340), kImage).starts_with("hold the board at the bottom,"));
  EXPECT_TRUE(describe(wish_at(500, 240), kImage).starts_with("hold the board at the right,"));
}

TEST(GuideEvent, HoldsWhatIsKnownAndNoMore) {
  GuideStep step;
  const nlohmann::json empty = guide_event(3, 0.1, step);
  EXPECT_EQ(empty["state"], "no board");
  EXPECT_EQ(empty["frame"], 3);
  for (const char* name : {"board", "wish", "estimate"}) EXPECT_FALSE(empty.contains(name)) << name;
  step.state = CaptureState::Accepted;
  step.wish = wish_at(200, 150);
  step.stance = step.wish->stance;
  step.estimate.emplace();
  step.estimate->corner_px = 0.3;
  const nlohmann::json full = guide_event(4, 0.2, step);
  EXPECT_EQ(full["state"], "accepted");
  EXPECT_EQ(full["wish"]["tilt"], "left nearer");
  EXPECT_EQ(full["wish"]["outline_px"].size(), 4U);
  EXPECT_EQ(full["wish"]["column"], 1);
  EXPECT_EQ(full["board"]["centre_px"], (nlohmann::json{200.0, 150.0}));
  EXPECT_EQ(full["estimate"]["corner_px"], 0.3);
}

TEST(MissingWords, NameAllThatIsMissing) {
  CaptureRecord record;
  record.enough_px = 0.2;
  record.last.coverage = {0.75, 0.5, 1};
  EXPECT_EQ(missing_words(record),
            (std::vector<std::string>{"25 % of the image are empty", "the board was not tilted in all four directions",
                                      "the views do not tell the focal length"}));
  record.last.coverage = {1, 1, 1};
  record.last.estimate.emplace();
  record.last.estimate->worst_px = 0.5;
  EXPECT_EQ(missing_words(record), std::vector<std::string>{"pixels are certain to 0.50 px only (0.20 are wanted)"});
  EXPECT_EQ(summary_of(record)["missing"].size(), 1U);
  record.last.is_enough = true;
  EXPECT_TRUE(missing_words(record).empty());
}

}  // namespace
}  // namespace alidade
