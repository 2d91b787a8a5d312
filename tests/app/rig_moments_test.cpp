// SPDX-License-Identifier: Apache-2.0
#include "app/rig_moments.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

BoardImages images_of(const std::vector<std::string>& names) {
  BoardImages images;
  for (std::size_t i = 0; i < names.size(); ++i) {
    BoardView view;
    view.name = names[i];
    view.frame = static_cast<int>(i);
    images.views.push_back(view);
  }
  return images;
}

TEST(MatchMoments, GoesByTheLastNumberOfTheNames) {
  const std::vector<BoardImages> cameras{images_of({"left01.jpg", "left02.jpg", "left09.jpg"}),
                                         images_of({"right02.jpg", "right09.jpg", "right10.jpg"})};
  const Moments moments = match_moments(cameras);
  EXPECT_EQ(moments.by, MomentsBy::Number);
  EXPECT_EQ(moments.count, 4);
  EXPECT_EQ(moments.of_view, (std::vector<std::vector<int>>{{0, 1, 2}, {1, 2, 3}}));
}

TEST(MatchMoments, GoesByOrderWhereNamesSayNothing) {
  const std::vector<BoardImages> cameras{images_of({"a.png", "b.png"}), images_of({"c.png", "d.png"})};
  const Moments moments = match_moments(cameras);
  EXPECT_EQ(moments.by, MomentsBy::Order);
  EXPECT_EQ(moments.of_view, (std::vector<std::vector<int>>{{0, 1}, {0, 1}}));
}

TEST(MatchMoments, GoesByTimeWhereAllHaveTimes) {
  std::vector<BoardImages> cameras{images_of({"a", "b", "c"}), images_of({"a", "b"})};
  const std::vector<std::vector<double>> times{{0.0, 0.1, 0.2}, {0.101, 0.31}};
  for (std::size_t c = 0; c < 2; ++c) {
    cameras[c].has_times = true;
    for (std::size_t i = 0; i < times[c].size(); ++i) cameras[c].views[i].time_s = times[c][i];
  }
  const Moments moments = match_moments(cameras);
  EXPECT_EQ(moments.by, MomentsBy::Time);
  EXPECT_EQ(moments.count, 4);
  EXPECT_EQ(moments.of_view, (std::vector<std::vector<int>>{{0, 1, 2}, {1, 3}}));
}

TEST(CameraName, ComesFromItsSource) {
  EXPECT_EQ(camera_name("shots/left??.jpg", 0), "left");
  EXPECT_EQ(camera_name("rig/front/", 1), "front");
  EXPECT_EQ(camera_name("walk_02.mp4", 2), "walk");
  EXPECT_EQ(camera_name("shots/*.png", 3), "camera3");
}

}  // namespace
}  // namespace alidade
