// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_association.h"

#include <algorithm>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "tests/uav/flown_scene.h"

namespace alidade {
namespace {

TargetSceneOptions crowd(int targets, unsigned seed) {
  TargetSceneOptions options;
  options.targets = targets;
  options.detection_probability = 0.9;
  options.false_bearings = 1.0;
  options.seed = seed;
  return options;
}

double error_m(const TargetHypothesis& hypothesis, const TargetPath& path) {
  return (hypothesis.fit.state.p_world - position_at(path, hypothesis.fit.state.time)).norm();
}

bool finds_all(const TargetScene& scene, const std::vector<TargetHypothesis>& found) {
  return found.size() == scene.paths.size() && std::ranges::all_of(scene.paths, [&](const TargetPath& path) {
           return std::ranges::any_of(found, [&](const TargetHypothesis& h) { return error_m(h, path) < 4.2; });
         });
}

int scenes_solved(const TargetSceneOptions& scene_options, const WindowOptions& options, int runs) {
  int solved = 0;
  TargetSceneOptions with_seed = scene_options;
  for (int run = 0; run < runs; ++run) {
    with_seed.seed = scene_options.seed + static_cast<unsigned>(run);
    const TargetScene scene = make_target_scene(with_seed);
    solved += finds_all(scene, associate_window(bearings_of(scene), options));
  }
  return solved;
}

TEST(WindowAssociation, FindsEachOfManyAmongMissesAndFalseBearings) {
  EXPECT_GE(scenes_solved(crowd(1, 100), {}, 50), 50);
  EXPECT_GE(scenes_solved(crowd(5, 200), {}, 100), 99);
  EXPECT_GE(scenes_solved(crowd(10, 300), {}, 50), 49);
}

TEST(WindowAssociation, FindsThemWithTwoReceiversThatMissNothing) {
  TargetSceneOptions scene = crowd(5, 400);
  scene.receivers = 2;
  scene.detection_probability = 0.999;
  WindowOptions options;
  options.detection_probability = 0.99;
  EXPECT_GE(scenes_solved(scene, options, 40), 39);
}

TEST(WindowAssociation, FindsThemWithFourReceiversAndLongDelays) {
  TargetSceneOptions scene = crowd(5, 500);
  scene.receivers = 4;
  scene.delays_s = {0.0, 0.3, 0.4, 0.15};
  EXPECT_GE(scenes_solved(scene, {}, 40), 39);
}

TEST(WindowAssociation, FindsThemWhereReceiversTurnOrAreCued) {
  for (const ScanLaw law : {ScanLaw::Rotating, ScanLaw::Cued}) {
    TargetSceneOptions scene = crowd(4, 600);
    scene.scan_law = law;
    EXPECT_GE(scenes_solved(scene, {}, 30), 28) << static_cast<int>(law);
  }
}

TEST(WindowAssociation, SeesNothingInFalseBearings) {
  TargetSceneOptions scene = crowd(1, 0);
  scene.detection_probability = 0.0;
  scene.false_bearings = 5.0;
  WindowOptions options;
  options.false_bearings_per_sr = 50.0;
  for (scene.seed = 1; scene.seed <= 40; ++scene.seed) {
    EXPECT_TRUE(associate_window(bearings_of(make_target_scene(scene)), options).empty()) << scene.seed;
  }
}

TEST(WindowAssociation, GivesNoBearingToTwoAndNoneTwiceOfAScan) {
  const TargetScene scene = make_target_scene(crowd(10, 7));
  const auto bearings = bearings_of(scene);
  std::set<std::size_t> given;
  for (const TargetHypothesis& hypothesis : associate_window(bearings)) {
    std::set<std::pair<int, Timestamp>> looks;
    for (const std::size_t i : hypothesis.bearings) {
      EXPECT_TRUE(given.insert(i).second);
      EXPECT_TRUE(looks.insert({bearings[i].receiver, bearings[i].time}).second);
    }
    EXPECT_TRUE(std::ranges::is_sorted(hypothesis.bearings));
    EXPECT_EQ(hypothesis.fit.degrees, 2 * static_cast<int>(hypothesis.bearings.size()) - 6);
  }
}

TEST(WindowAssociation, NamesTheBearingsOfEachTarget) {
  const TargetScene scene = make_target_scene(crowd(3, 11));
  const auto bearings = bearings_of(scene);
  const auto found = associate_window(bearings);
  ASSERT_TRUE(finds_all(scene, found));
  for (const TargetHypothesis& hypothesis : found) {
    for (const std::size_t i : hypothesis.bearings)
      EXPECT_EQ(bearings[i].target, bearings[hypothesis.bearings[0]].target);
  }
}

TEST(WindowAssociation, GoesByNothingButWhatWasSeen) {
  const TargetScene scene = make_target_scene(crowd(4, 12));
  auto bearings = bearings_of(scene);
  const auto before = associate_window(bearings);
  for (Bearing& bearing : bearings) bearing.target = -1;
  std::mt19937 random(5);
  std::shuffle(bearings.begin(), bearings.end(), random);
  const auto after = associate_window(bearings);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_TRUE(after[i].fit.state.p_world.isApprox(before[i].fit.state.p_world, 1e-7));
  }
}

TEST(WindowAssociation, FindsATargetThatComesLate) {
  TargetSceneOptions options = crowd(2, 0);
  options.periods = 8;
  int found_both = 0;
  for (options.seed = 1; options.seed <= 20; ++options.seed) {
    const TargetScene scene = make_target_scene(options);
    auto bearings = bearings_of(scene);
    std::erase_if(bearings,
                  [](const Bearing& b) { return b.target == 1 && to_seconds(b.time.time_since_epoch()) < 3; });
    found_both += finds_all(scene, associate_window(bearings));
  }
  EXPECT_GE(found_both, 19);
}

TEST(WindowAssociation, IsEmptyWithoutASecondReceiver) {
  TargetSceneOptions options = crowd(3, 3);
  options.receivers = 1;
  EXPECT_TRUE(associate_window(bearings_of(make_target_scene(options))).empty());
  EXPECT_TRUE(associate_window({}).empty());
}

TEST(WindowAssociation, NamesABadOption) {
  WindowOptions options;
  options.detection_probability = 1.0;
  try {
    validate(options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "detection_probability must be in (0, 1), got 1");
  }
  options = {};
  options.top_speed_m_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validate(options), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
