// SPDX-License-Identifier: Apache-2.0
#include "uav/video/short_tracks.h"

#include <algorithm>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

Timestamp frame(int index) {
  return Timestamp(from_seconds(index / 30.0));
}

TEST(ShortTracks, ConfirmWhatMovesOnAtItsThirdSighting) {
  ShortTracks tracks;
  for (int i = 0; i < 6; ++i) {
    const std::vector<SeenDot> dots{{{100.0 + 4.0 * i, 50.0 - 2.0 * i}, 6.0}};
    EXPECT_EQ(tracks.confirm(dots, frame(i)).front(), i >= 2) << i;
  }
}

TEST(ShortTracks, WantMoreSightingsOfFainterDots) {
  ShortTracks tracks;
  for (int i = 0; i < 7; ++i) {
    const std::vector<SeenDot> dots{{{100.0 + 4.0 * i, 50.0}, -4.0}};
    EXPECT_EQ(tracks.confirm(dots, frame(i)).front(), i >= 5) << i;  // 6 · 4² = 96 > 9²: the sixth
  }
}

TEST(ShortTracks, DoNotConfirmWhatFlickersInItsPlace) {
  ShortTracks tracks;
  for (int i = 0; i < 50; ++i) {
    const std::vector<SeenDot> dots{{{100.0 + 0.3 * (i % 2), 50.0}, 8.0}};
    EXPECT_FALSE(tracks.confirm(dots, frame(i)).front());
  }
}

TEST(ShortTracks, CarryOverMissedFramesButNotManyOfThem) {
  ShortTracks tracks;
  const auto seen = [&](int i) -> bool {
    const std::vector<SeenDot> dots{{{100.0 + 4.0 * i, 50.0}, 6.0}};
    return tracks.confirm(dots, frame(i)).front();
  };
  for (int i = 0; i < 4; ++i) seen(i);
  for (int i = 4; i < 7; ++i) tracks.confirm({}, frame(i));
  EXPECT_TRUE(seen(7));
  for (int i = 8; i < 12; ++i) tracks.confirm({}, frame(i));
  EXPECT_FALSE(seen(12));
}

TEST(ShortTracks, FollowFaintDotsOnlyOnceTheyCount) {
  ShortTracks tracks;
  for (int i = 0; i < 4; ++i) tracks.confirm(std::vector<SeenDot>{{{100.0 + 4.0 * i, 50.0}, 6.0}}, frame(i));
  const std::vector<SeenDot> dots{{{116.0, 50.0}, 3.1}, {{300.0, 50.0}, 3.1}, {{116.5, 50.0}, -6.0}};
  const std::vector<bool> confirmed = tracks.confirm(dots, frame(4));
  EXPECT_TRUE(confirmed[0]);
  EXPECT_FALSE(confirmed[1]);
  EXPECT_FALSE(confirmed[2]);  // dark now: another one
}

TEST(ShortTracks, AreSeldomFooledByNoise) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> x(0.0, 1280.0), y(0.0, 720.0), z(3.5, 4.0);
  ShortTracks tracks;
  int confirmed = 0;
  for (int i = 0; i < 100; ++i) {
    std::vector<SeenDot> dots;
    for (int k = 0; k < 150; ++k) dots.push_back({{x(random), y(random)}, k % 2 == 0 ? z(random) : -z(random)});
    const std::vector<bool> is_confirmed = tracks.confirm(dots, frame(i));
    confirmed += static_cast<int>(std::count(is_confirmed.begin(), is_confirmed.end(), true));
  }
  EXPECT_LE(confirmed, 10);  // 0.1 per frame
}

TEST(ShortTracks, NeedTimesThatIncrease) {
  ShortTracks tracks;
  tracks.confirm(std::vector<SeenDot>{{{1.0, 1.0}, 9.0}}, frame(3));
  EXPECT_THROW(tracks.confirm(std::vector<SeenDot>{{{1.0, 1.0}, 9.0}}, frame(3)), std::invalid_argument);
  ShortTrackOptions options;
  options.gate_px = 0.0;
  EXPECT_THROW(ShortTracks{options}, std::invalid_argument);
}

}  // namespace
}  // namespace alidade
