// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_run.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/app/targets/disturbed_flight.h"

namespace alidade {
namespace {

ReceiverCalibrationInput without_truth() {
  ReceiverCalibrationInput input = test::disturbed_flight();
  input.truth.clear();
  input.sources.truth.clear();
  return input;
}

TEST(ChangeBetween, UndoesADisturbance) {
  const ReceiverCalibrationInput input = test::disturbed_flight();
  Receiver given = input.receivers[1], found = given;
  found.T_world_receiver = given.T_world_receiver * perturbation(test::disturbance());
  found.clock.offset_s += 0.1;
  found.clock.rate += 1e-3;
  found.clock.reference += from_seconds(50.0);  // the same clock shows 1e-3 · 0 more there, and 0.1 s
  found.camera->readout_s += 0.01;
  found.camera->fx *= 1.02;
  const ReceiverChange change = change_between(given, found);
  EXPECT_TRUE(change.head<6>().isApprox(test::disturbance(), 1e-9));
  EXPECT_NEAR(change[kClockOffset], 0.1, 1e-9);
  EXPECT_NEAR(change[kClockRate], 1e-3, 1e-15);
  EXPECT_NEAR(change[kReadout], 0.01, 1e-15);
  EXPECT_NEAR(change[kFocal], std::log(1.02), 1e-12);
}

TEST(ReceiverCalibration, ResectsADisturbedCameraOnAKnownPath) {
  const auto run = calibrate_receivers(test::disturbed_flight(), {}, {});
  ASSERT_EQ(run.receivers.size(), 3u);
  const CalibratedReceiver& one = run.receivers[1];
  ASSERT_TRUE(one.is_calibrated());
  ASSERT_TRUE(one.sigma);
  // 600 readings of 0.5 px at 50 m and 900 px are about 2 mm; the length of the disturbance is 0.54 m.
  EXPECT_NEAR(one.change.head<3>().norm(), test::disturbance().head<3>().norm(), 0.05);
  EXPECT_NEAR(one.change[kClockOffset], -test::kClockError_s, 0.005);
  EXPECT_GT(*one.before.median_px, 5.0);
  EXPECT_LT(*one.after.median_px, 0.8);  // 0.59 px are due: 0.5 px of noise
  EXPECT_TRUE(one.found.pose_covariance);
  EXPECT_TRUE(run.findings.empty());
  ASSERT_EQ(run.warnings.size(), 1u);
  EXPECT_TRUE(run.warnings[0].starts_with("the readings span 30 s only: standard deviations may be too small"));
  EXPECT_FALSE(run.is_interrupted);
  ASSERT_FALSE(run.path.empty());
  EXPECT_GE(run.path.front().time, Timestamp(from_seconds(-0.2)));
  EXPECT_LE(run.path.back().time, Timestamp(from_seconds(test::kFlight_s + 1.0)));
}

TEST(ReceiverCalibration, FindsNoReceiverThatIsImpossible) {
  const auto run = calibrate_receivers(test::disturbed_flight(), {}, {});
  for (const CalibratedReceiver& one : run.receivers) {
    EXPECT_TRUE(one.is_calibrated());
    EXPECT_FALSE(find_fault(one.found)) << *find_fault(one.found);
  }
}

TEST(ReceiverCalibration, StaysNearTheGivenReceiversWhereAShortFlightTellsLittle) {
  ReceiverCalibrationInput input = test::disturbed_flight();
  std::erase_if(input.readings, [&](const ReceiverReading& reading) {
    const auto& clock = input.receivers[static_cast<std::size_t>(reading.receiver)].clock;
    return common_time(clock, reading.time) > Timestamp(from_seconds(7.0));
  });
  const auto run = calibrate_receivers(input, {}, {});
  for (const CalibratedReceiver& one : run.receivers) {
    ASSERT_TRUE(one.after.median_px);
    EXPECT_LT(*one.after.median_px, 1.5 * *one.before.median_px);
  }
}

TEST(ReceiverCalibration, FindsThePathWhereItIsNotKnown) {
  const auto run = calibrate_receivers(without_truth(), {}, {});
  ASSERT_TRUE(run.has_answer());
  EXPECT_LT(*run.receivers[1].after.median_px, 0.8);
  EXPECT_LT(*run.receivers[1].after.median_px, 0.3 * *run.receivers[1].before.median_px);
  EXPECT_FALSE(run.receivers[1].sigma);
  ASSERT_GT(run.path.size(), 250u);  // 10 a second
  double worst_m = 0.0;
  for (const TimedPosition& at : run.path) {
    const double t_s = to_seconds(at.time.time_since_epoch());
    worst_m = std::max(worst_m, (at.p - test::simulated_position(t_s)).norm());
  }
  EXPECT_LT(worst_m, 1.0);  // the whole of it may be shifted and turned
}

TEST(ReceiverCalibration, LeavesWhatItCannotCalibrateAsGivenAndSaysWhy) {
  ReceiverCalibrationInput input = test::disturbed_flight();
  std::erase_if(input.readings, [n = 0](const auto& reading) mutable { return reading.receiver == 2 && n++ >= 40; });
  Receiver finder;
  finder.id = 7;
  input.receivers.push_back(finder);
  for (const bool is_known : {true, false}) {
    if (!is_known) input.truth.clear(), input.sources.truth.clear();
    const auto run = calibrate_receivers(input, {}, {});
    ASSERT_EQ(run.receivers.size(), 4u);
    EXPECT_NE(run.receivers[3].left_why.find("only cameras can be calibrated"), std::string::npos);
    EXPECT_EQ(run.receivers[2].is_calibrated(), !is_known);
    if (is_known) {
      EXPECT_NE(run.receivers[2].left_why.find("40 of its readings"), std::string::npos);
      EXPECT_TRUE(run.receivers[2].found.T_world_receiver.isApprox(input.receivers[2].T_world_receiver));
    }
    EXPECT_TRUE(run.receivers[1].is_calibrated());
  }
}

TEST(ReceiverCalibration, HasNoAnswerWherePathAndReadingsAreOfDifferentPlaces) {
  ReceiverCalibrationInput input = test::disturbed_flight();
  for (Receiver& receiver : input.receivers) receiver.T_world_receiver.translation().z() += 1000.0;
  input.truth.clear();
  input.sources.truth.clear();
  for (Receiver& receiver : input.receivers) {  // all look outwards: no two lines of sight meet
    receiver.T_world_receiver.linear() =
        receiver.T_world_receiver.linear() * Eigen::DiagonalMatrix<double, 3>(-1.0, 1.0, -1.0);
  }
  EXPECT_FALSE(calibrate_receivers(input, {}, {}).has_answer());
}

TEST(ReceiverCalibration, StopsWhenAsked) {
  std::stop_source source;
  const ProgressSink stop_at_second = [&](const Progress& progress) {
    if (progress.done == 1) source.request_stop();
  };
  const auto run = calibrate_receivers(test::disturbed_flight(), {}, {stop_at_second, source.get_token()});
  EXPECT_TRUE(run.is_interrupted);
  EXPECT_TRUE(run.receivers[0].is_calibrated());
  EXPECT_EQ(run.receivers[1].left_why, "interrupted");
  EXPECT_TRUE(run.findings.empty());
  const auto none = calibrate_receivers(without_truth(), {}, {{}, source.get_token()});
  EXPECT_TRUE(none.is_interrupted);
  EXPECT_FALSE(none.has_answer());
}

TEST(ReceiverCalibration, RefusesATimeReceiverThatIsNotThere) {
  ReceiverCalibrationChoice choice;
  choice.time_receiver = "nobody";
  EXPECT_THROW(calibrate_receivers(without_truth(), choice, {}), InputError);
}

}  // namespace
}  // namespace alidade
