// SPDX-License-Identifier: Apache-2.0
#include "app/rig_synchronisation.h"

#include <gtest/gtest.h>

#include "app/rig_moments.h"
#include "core/errors.h"
#include "tests/calib/simulated_films.h"

namespace alidade {
namespace {

using namespace test;

constexpr double kOffset = 2.345;  // s

BoardImages images_of(const std::string& source, const CameraFilm& film) {
  BoardImages images;
  images.source = source;
  images.image = {film.camera.width, film.camera.height};
  images.has_times = true;
  images.views = film.film.views();
  for (int i = 0; i <= images.views.back().frame; ++i)
    images.images.push_back({"frame" + std::to_string(i), false, {}});
  return images;
}

RigCalibrationRun filmed_run(double second_start_s) {
  const auto cameras = filming_cameras();
  const HandMotion motion(31);
  RigCalibrationRun run;
  run.board.board = filmed_chessboard();
  run.names = {"left", "right"};
  run.images = {images_of("left.mkv", simulate_film(cameras[0], motion, {0, 9, 20, 0}, 1)),
                images_of("right.mkv", simulate_film(cameras[1], motion, {second_start_s, 9, 15, kOffset}, 2))};
  return run;
}

CameraCalibrationOptions radial() {
  CameraCalibrationOptions options;
  options.lens = LensModel::Radial;
  options.free_corners = false;
  options.folds = 2;  // for speed: nothing here asks for the held-out error
  return options;
}

RunContext silent() {
  RunContext context;
  context.progress = [](const Progress&) {};
  return context;
}

std::string refusal(RigCalibrationRun run) {
  try {
    synchronise_cameras(run, radial(), silent());
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(SynchroniseCameras, FindsTheOffsetAndGivesViewsOfCommonMoments) {
  RigCalibrationRun run = filmed_run(0.5);
  synchronise_cameras(run, radial(), silent());
  ASSERT_EQ(run.clocks.size(), 2U);
  EXPECT_EQ(run.clocks[0].offset_s, 0.0);
  EXPECT_NEAR(run.clocks[1].offset_s, kOffset, 1e-3);
  EXPECT_EQ(run.moments.by, MomentsBy::Motion);
  for (std::size_t c = 0; c < 2; ++c) {
    ASSERT_EQ(run.moments.of_view[c].size(), run.images[c].views.size());
    for (const BoardView& view : run.images[c].views) {
      EXPECT_EQ(run.images[c].images[static_cast<std::size_t>(view.frame)].name, view.name);
    }
  }
  run.result = calibrate_rig(run.board.board, rig_views(run), radial());
  ASSERT_EQ(run.result.outcome, RigCalibrationOutcome::Calibrated);
  EXPECT_LT(run.result.rms_px, 0.2);
  const double baseline_m = filming_cameras()[1].T_rig_camera.translation().norm();
  EXPECT_NEAR(run.result.pairs[0].baseline_m, baseline_m, 4 * run.result.pairs[0].baseline_sigma_m);
  const CameraRig rig = rig_of(run);
  EXPECT_EQ(rig.cameras[0].clock_offset_s, 0.0);
  EXPECT_EQ(rig.cameras[1].clock_offset_s, run.clocks[1].offset_s);
}

TEST(SynchroniseCameras, RefusesFilmsOfDifferentTimes) {
  EXPECT_EQ(
      refusal(filmed_run(60)),
      "right.mkv: no time offset to left.mkv: the films show no common motion of the board; let both run while the "
      "board turns in view of both");
}

TEST(SynchroniseCameras, RefusesImagesWithoutTimes) {
  RigCalibrationRun run = filmed_run(0);
  run.images[1].has_times = false;
  EXPECT_EQ(refusal(run),
            "right.mkv: its images have no times, so that no clock can be found; give a video, or a folder with "
            "times.csv (columns t_ns and image)");
}

TEST(SynchroniseCameras, RefusesTimesThatStandStill) {
  RigCalibrationRun run = filmed_run(0);
  run.images[0].views[4].time_s = run.images[0].views[3].time_s;
  EXPECT_EQ(refusal(run),
            "left.mkv: frame4 is no later than frame3, the image before it; correct the times of its images");
}

}  // namespace
}  // namespace alidade
