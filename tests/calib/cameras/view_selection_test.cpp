// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/view_selection.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace alidade {
namespace {

constexpr ImageExtent kImage{640, 480};

// A board of three corners at x, y in frame `frame`.
BoardView view_at(int frame, double x, double y = 100) {
  BoardView view;
  view.frame = frame;
  for (int i = 0; i < 3; ++i) view.corners.push_back({i, {x + 20 * i, y}, 0.1});
  return view;
}

TEST(ViewMotion, IsTheDistanceOfCommonCorners) {
  BoardView from = view_at(0, 100), to = view_at(1, 103, 104);
  EXPECT_DOUBLE_EQ(view_motion_px(from, to).value(), 5);
  from.corners.erase(from.corners.begin());
  EXPECT_DOUBLE_EQ(view_motion_px(from, to).value(), 5);
  to.corners.resize(1);
  EXPECT_FALSE(view_motion_px(from, to));
}

// Rests at 100, moves on to 300 and rests there; comes back to 101.
TEST(SelectViews, TakesEachRestingPlaceOnce) {
  const std::vector<BoardView> film{view_at(0, 100), view_at(1, 100), view_at(2, 150),
                                    view_at(3, 230), view_at(4, 300), view_at(5, 300.2),
                                    view_at(6, 200), view_at(7, 101), view_at(8, 101)};
  const auto chosen = select_views(film, kImage);
  ASSERT_GE(chosen.size(), 2U);
  EXPECT_EQ(chosen.front(), 0);
  EXPECT_TRUE(std::find(chosen.begin(), chosen.end(), 4) != chosen.end());
  EXPECT_TRUE(std::find(chosen.begin(), chosen.end(), 7) == chosen.end());
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
}

TEST(SelectViews, LeavesMovingBoardsWhereEnoughRest) {
  std::vector<BoardView> film;
  for (int place = 0; place < 12; ++place) {
    for (int i = 0; i < 3; ++i) film.push_back(view_at(4 * place + i, 40.0 * place));
    film.push_back(view_at(4 * place + 3, 40.0 * place + 20, 300));
  }
  for (const int i : select_views(film, kImage)) EXPECT_EQ(film[static_cast<std::size_t>(i)].corners[0].pixel.y(), 100);
}

TEST(SelectViews, TakesNoMoreThanAsked) {
  std::vector<BoardView> film;
  for (int i = 0; i < 50; ++i) {
    film.push_back(view_at(2 * i, 25.0 * (i % 10), 60.0 * (i / 10)));
    film.push_back(view_at(2 * i + 1, 25.0 * (i % 10), 60.0 * (i / 10)));
  }
  EXPECT_EQ(select_views(film, kImage, {.most = 7}).size(), 7U);
  EXPECT_TRUE(select_views({}, kImage).empty());
}

}  // namespace
}  // namespace alidade
