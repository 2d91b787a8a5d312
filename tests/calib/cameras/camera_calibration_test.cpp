// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/camera_calibration.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"
#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

using Outcome = CameraCalibrationOutcome;
constexpr ImageExtent kImage{640, 480};
constexpr LensModel kLenses[] = {LensModel::Radial, LensModel::Brown, LensModel::Rational, LensModel::Fisheye};

CameraCalibrationOptions with_lens(LensModel lens) {
  CameraCalibrationOptions options;
  options.lens = lens;
  return options;
}

CameraCalibration calibrate(const std::vector<BoardView>& views,
                            const CameraCalibrationOptions& options = with_lens(LensModel::Radial)) {
  return calibrate_camera(kImage, test::simulated_board(), views, options);
}

std::vector<BoardView> noisy_views(int count = 12, double noise_px = 0.1, unsigned seed = 7) {
  return test::simulate_views(test::simulated_camera(LensModel::Radial), {.views = count, .noise_px = noise_px}, seed)
      .views;
}

// Corners from the first on, the same number in each view.
std::vector<BoardView> with_corners(std::vector<BoardView> views, std::size_t count) {
  for (BoardView& view : views) view.corners.resize(count);
  return views;
}

// Corners that state next to no noise leave the priors no weight: the coefficients of a rational lens trade against
// each other. Compared where the boards were.
TEST(CalibrateCamera, FindsEveryLensFromExactViews) {
  for (const LensModel lens : kLenses) {
    const Camera truth = test::simulated_camera(lens);
    const auto simulated = test::simulate_views(truth, {.views = 12, .sigma_px = 1e-6}, 9);
    CameraCalibrationOptions options = with_lens(lens);
    options.fit.least_sigma_px = 0;
    const CameraCalibration found = calibrate(simulated.views, options);
    EXPECT_EQ(found.outcome, Outcome::Calibrated) << name_of(lens) << ": " << explain(found);
    EXPECT_LT(test::largest_difference_px(truth, found.camera, 0.2), 1e-6) << name_of(lens);
    EXPECT_EQ(found.camera.width, 640);
    EXPECT_LT(found.rms_all_px, 3e-6) << name_of(lens);  // three stated sigmas: the valley of a rational lens is flat
    EXPECT_LT(found.held_out_rms_px.value(), 1e-4) << name_of(lens);
    EXPECT_EQ(explain(found), "");
  }
}

TEST(CalibrateCamera, ChoosesTheLensByItself) {
  for (const LensModel lens : {LensModel::Radial, LensModel::Fisheye}) {
    const auto simulated = test::simulate_views(test::simulated_camera(lens), {.views = 16, .noise_px = 0.05}, 9);
    const CameraCalibration found = calibrate(simulated.views, {});
    EXPECT_EQ(found.model.lens, lens) << name_of(found.model.lens);
    ASSERT_EQ(found.trials.size(), 8U);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(found.trials[i].model.lens, kLenses[i]);
    EXPECT_EQ(found.held_out_rms_px, found.trials[static_cast<std::size_t>(lens)].held_out_rms_px);
    EXPECT_TRUE(lens_fits(found.residuals));
  }
}

TEST(CalibrateCamera, RejectsAWreckedViewAndCutsOutliers) {
  auto views = noisy_views();
  test::RandomGeometry random(1);
  for (BoardCorner& corner : views[4].corners) corner.pixel += random.vector(20).head<2>();
  for (const std::size_t i : {3U, 20U, 41U}) views[6].corners[i].pixel += Eigen::Vector2d(3, -4);
  const CameraCalibration found = calibrate(views);
  ASSERT_EQ(found.outcome, Outcome::Calibrated) << explain(found);
  ASSERT_EQ(found.verdicts.size(), 12U);
  EXPECT_EQ(found.verdicts[4].use, ViewUse::Rejected);
  EXPECT_GT(found.verdicts[4].outliers, 27);
  EXPECT_GT(found.verdicts[4].rms_px, 5);
  EXPECT_EQ(found.verdicts[6].use, ViewUse::PartlyUsed);
  EXPECT_EQ(found.verdicts[6].outliers, 3);
  EXPECT_EQ(found.verdicts[5].use, ViewUse::Used);
  EXPECT_LT(found.verdicts[5].rms_px, 0.2);
  EXPECT_LT(found.rms_px, 0.16);
  EXPECT_GT(found.rms_all_px, 1);
}

TEST(CalibrateCamera, SaysWhichViewARepeatedOneRepeats) {
  auto views = noisy_views(6);
  views.insert(views.begin() + 3, views[1]);
  views.push_back(views[0]);
  const CameraCalibration found = calibrate(views);
  ASSERT_EQ(found.outcome, Outcome::Calibrated) << explain(found);
  EXPECT_EQ(found.distinct_views, 6);
  EXPECT_EQ(found.verdicts[3].use, ViewUse::Repeated);
  EXPECT_EQ(found.verdicts[3].repeats, 1);
  EXPECT_EQ(found.verdicts[7].repeats, 0);
  EXPECT_EQ(found.verdicts[4].repeats, -1);
  EXPECT_EQ(found.frame_of_view, (std::vector<int>{0, 1, 2, -1, 3, 4, 5, -1}));
  EXPECT_EQ(found.fit.views.size(), 6U);
}

TEST(CalibrateCamera, TakesPartsOfBoards) {
  auto views = noisy_views(16, 0.0);
  for (std::size_t v = 0; v < views.size(); ++v) {
    auto& corners = views[v].corners;
    const bool is_left = v % 2 == 0;
    std::erase_if(corners, [&](const BoardCorner& c) { return (c.id % 9 < 5) != is_left; });
    for (BoardCorner& corner : corners) corner.sigma_px = 1e-4;
  }
  CameraCalibrationOptions options = with_lens(LensModel::Radial);
  options.fit.least_sigma_px = 0;
  const CameraCalibration found = calibrate(views, options);
  ASSERT_EQ(found.outcome, Outcome::Calibrated) << explain(found);
  EXPECT_LT(test::largest_difference_px(test::simulated_camera(LensModel::Radial), found.camera), 1e-6);
}

TEST(CalibrateCamera, GivesTheSameTwice) {
  const auto views = noisy_views();
  const CameraCalibration first = calibrate(views, {}), second = calibrate(views, {});
  EXPECT_EQ(first.camera, second.camera);
  EXPECT_EQ(first.covariance.shared_and_motion, second.covariance.shared_and_motion);
  EXPECT_EQ(first.held_out_rms_px, second.held_out_rms_px);
}

TEST(CalibrateCamera, EndsWhenItIsStopped) {
  std::stop_source stop;
  stop.request_stop();
  const auto found = calibrate_camera(kImage, test::simulated_board(), noisy_views(), {}, {}, stop.get_token());
  EXPECT_EQ(found.outcome, Outcome::Stopped);
  EXPECT_EQ(explain(found), "stopped");
}

TEST(CalibrateCamera, TellsOfItsProgress) {
  std::vector<std::int64_t> done;
  calibrate_camera(kImage, test::simulated_board(), noisy_views(), {}, [&](const Progress& p) {
    EXPECT_EQ(p.total, 8);
    done.push_back(p.done);
  });
  EXPECT_EQ(done, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(CalibrateCamera, RefusesCornersThatTheBoardDoesNotHave) {
  for (const int id : {54, 100000, -1}) {
    auto views = noisy_views(4);
    views[1].corners.back().id = id;
    EXPECT_THROW(calibrate(views), std::invalid_argument) << id;
    views.resize(2);
    EXPECT_THROW(calibrate(views), std::invalid_argument) << id;
  }
}

void expect_sentence(const CameraCalibration& found, Outcome outcome, const std::string& sentence) {
  EXPECT_EQ(found.outcome, outcome);
  EXPECT_EQ(explain(found), sentence);
}

TEST(ExplainCamera, TooFewViews) {
  const auto views = noisy_views(2);
  expect_sentence(calibrate({}), Outcome::TooFewViews,
                  "the board is seen in 0 images, three are the least; take 10 to 20 with the board at different "
                  "places and tilts");
  expect_sentence(calibrate({views[0]}), Outcome::TooFewViews,
                  "the board is seen in 1 image, three are the least; take 10 to 20 with the board at different "
                  "places and tilts");
  expect_sentence(calibrate({views[0], views[1], views[0], views[1], views[1]}), Outcome::TooFewViews,
                  "the board is seen in 5 images, but only 2 of them differ; move and tilt the board between images");
  expect_sentence(calibrate(std::vector<BoardView>(8, views[0])), Outcome::TooFewViews,
                  "the board is seen in 8 images, but only 1 of them differs; move and tilt the board between images");
}

// The distortion lets boards that face the camera seem tilted by some degrees.
TEST(ExplainCamera, AllFrontal) {
  const auto frontal = test::simulate_views(test::simulated_camera(LensModel::Radial),
                                            {.views = 10, .noise_px = 0.1, .most_tilt = 0.0}, 3);
  const CameraCalibration found = calibrate(frontal.views);
  EXPECT_LT(found.tilt_spread_rad, 0.14);
  expect_sentence(found, Outcome::NoTilt,
                  fmt::format("the board faces the camera alike in all 10 images (within {:.1f} deg), so that focal "
                              "length and distance cannot be told apart; tilt it by 30 to 45 deg in different "
                              "directions",
                              found.tilt_spread_rad * 180 / std::numbers::pi));
}

// 8 intrinsics, 2 of the warp and 18 of three poses: 28 corners are the least.
TEST(ExplainCamera, TooFewCorners) {
  EXPECT_NE(calibrate(with_corners(noisy_views(3), 10)).outcome, Outcome::TooFewCorners);
  expect_sentence(calibrate(with_corners(noisy_views(3), 9)), Outcome::TooFewCorners,
                  "27 corners in 3 images do not suffice for the lens; take more images, with more of the board "
                  "in them");
}

TEST(ExplainCamera, NoPoseOfAnyBoard) {
  expect_sentence(calibrate(with_corners(noisy_views(4), 5)), Outcome::TooFewCorners,
                  "20 corners in 4 images do not suffice for the lens; take more images, with more of the board "
                  "in them");
}

// Seven rows of eight instead of nine by six: the ids mean other places.
TEST(ExplainCamera, WrongBoardSize) {
  Board wrong = test::simulated_board();
  wrong.columns = 6;
  wrong.rows = 9;
  const auto found = calibrate_camera(kImage, wrong, noisy_views(), with_lens(LensModel::Radial));
  EXPECT_NE(found.outcome, Outcome::Calibrated) << found.rms_px << " px";
}

TEST(ValidateCameraOptions, NamesFieldValueAndBound) {
  const auto message_of = [](auto change) -> std::string {
    CameraCalibrationOptions options;
    change(options);
    try {
      validate(options);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_EQ(message_of([](auto&) {}), "none");
  EXPECT_EQ(message_of([](auto& o) { o.folds = 1; }), "folds must be >= 2, got 1");
  EXPECT_EQ(message_of([](auto& o) { o.simpler_within = 0.9; }), "simpler_within must be >= 1, got 0.9");
  EXPECT_EQ(message_of([](auto& o) { o.repeated_view_px = -1; }), "repeated_view_px must be >= 0 px, got -1");
  EXPECT_EQ(message_of([](auto& o) { o.least_tilt_deg = std::nan(""); }), "least_tilt_deg must be >= 0 deg, got nan");
  EXPECT_EQ(message_of([](auto& o) { o.worst_focal_sigma = 0; }), "worst_focal_sigma must be > 0, got 0");
  EXPECT_EQ(message_of([](auto& o) { o.fit.outlier_sigmas = 1; }), "outlier_sigmas must be >= 2, got 1");
}

}  // namespace
}  // namespace alidade
