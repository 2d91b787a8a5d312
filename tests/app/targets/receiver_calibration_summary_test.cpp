// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_summary.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

using testing::HasSubstr;

// A camera that was calibrated, one that was not, and a direction finder.
ReceiverCalibrationRun run_of_three() {
  ReceiverCalibrationRun run;
  run.sources = {"receivers.yaml", "observations.csv", "path.csv", {}, {}};
  run.receivers.resize(3);
  for (int k = 0; k < 3; ++k) {
    CalibratedReceiver& one = run.receivers[static_cast<std::size_t>(k)];
    one.given.id = k;
    if (k < 2) one.given.camera = Camera{1920, 1080, 1500, 1500, 959.5, 539.5, {}, 0.0};
  }
  CalibratedReceiver& found = run.receivers[0];
  found.given.name = "north";
  found.change[kTranslation + 1] = 0.5;
  found.change[kClockOffset] = -0.012;
  found.sigma = ReceiverChange::Constant(0.001);
  found.before.median_px = 12.0;
  found.after = {500, 1.5, {}};
  run.receivers[1].left_why = "7 of its readings lie on the path, wanted are 100";
  run.receivers[2].left_why = "it is a direction finder; only cameras can be calibrated";
  return run;
}

TEST(ReceiverCalibrationSummary, HasChangesWithTheirDeviations) {
  const auto summary = summary_of(run_of_three());
  EXPECT_EQ(summary["method"], "resection");
  const auto& north = summary["receivers"][0];
  EXPECT_EQ(north["readings"], 500);
  EXPECT_EQ(north["median_px"], 1.5);
  EXPECT_EQ(north["change"]["place_m"], 0.5);
  EXPECT_EQ(north["change"]["clock_s"], -0.012);
  EXPECT_EQ(north["change"]["focal"], 1.0);
  EXPECT_NEAR(north["sigma"]["place_m"].get<double>(), 0.001 * std::sqrt(3.0), 1e-12);
  EXPECT_FALSE(summary["receivers"][1]["is_calibrated"].get<bool>());
  EXPECT_THAT(summary["receivers"][2]["left_why"].get<std::string>(), HasSubstr("direction finder"));
  EXPECT_FALSE(summary["receivers"][2].contains("change"));
}

TEST(ReceiverCalibrationSummary, WarnsOfWhatWasLeftAndWhatIsWrong) {
  auto run = run_of_three();
  run.findings = {{ReceiverFault::WrongFocal, 0, -1, 0.97, 0.001}};
  ReceiverCalibrationChoice choice;
  add_warnings(run, choice);
  EXPECT_THAT(
      run.warnings,
      testing::ElementsAre("receiver 1 is left as given: 7 of its readings lie on the path, wanted are 100",
                           "receiver 2 is left as given: it is a direction finder; only cameras can be calibrated",
                           "receiver 0: its focal lengths are to be multiplied by 0.970 (north); calibrate its lens "
                           "in this video mode, or let them be found (--resection-find-focal)"));
  choice.resection.find_focal = true;
  run.warnings.clear();
  add_warnings(run, choice);
  EXPECT_THAT(run.warnings.back(), HasSubstr("receivers.yaml has them so"));
}

TEST(ReceiverCalibrationSummary, NamesBothOfSwappedReceivers) {
  auto run = run_of_three();
  run.receivers[1].given.name = "south";
  run.findings = {{ReceiverFault::SwappedPlaces, 0, 1, 80.0, 0.1}};
  const auto finding = summary_of(run)["findings"][0];
  EXPECT_EQ(finding["fault"], "swapped_places");
  EXPECT_EQ(finding["other"], 1);
  EXPECT_THAT(finding["text"].get<std::string>(), HasSubstr("(north, south)"));
}

TEST(ReceiverCalibrationSummary, EveryFaultHasARemedy) {
  for (const auto fault : {ReceiverFault::SwappedPlaces, ReceiverFault::WrongPlace, ReceiverFault::WrongFocal,
                           ReceiverFault::UnevenClock, ReceiverFault::Unexplained}) {
    auto run = run_of_three();
    run.findings = {{fault, 0, 1, 1.0, 0.1}};
    add_warnings(run, {});
    EXPECT_THAT(run.warnings.back(), HasSubstr("; "));
  }
}

TEST(ReceiverCalibrationSummary, SaysWhyThereIsNoAnswer) {
  auto run = run_of_three();
  run.receivers.erase(run.receivers.begin());
  EXPECT_FALSE(run.has_answer());
  EXPECT_EQ(explain_no_answer(run),
            "no camera can be calibrated (receiver 1: 7 of its readings lie on the path, wanted are 100); check that "
            "path and observations are of one flight, not too short, and count time by one clock");
}

TEST(ReceiverCalibrationSummary, TellsALineOfEach) {
  EXPECT_THAT(table_lines(run_of_three()),
              testing::ElementsAre("north: 500 readings, median 1.50 px (was 12.00), moved 0.50 m, turned 0.00 mrad, "
                                   "clock -12.0 ms",
                                   "receiver 1: left as given", "receiver 2: left as given"));
}

}  // namespace
}  // namespace alidade
