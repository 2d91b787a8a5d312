// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_pipeline.h"

#include <set>
#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "datasets/target_scene.h"
#include "tests/support/simulated_flight.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

TargetScene two_targets(int periods) {
  TargetSceneOptions options;
  options.periods = periods;
  options.velocity_sigma_m_s = 5.0;
  options.seed = 3;
  return make_target_scene(options);
}

struct Outcome {
  std::vector<TargetRow> rows;
  TargetRun run;
  std::size_t left_out = 0;
  std::vector<Receiver> operated;
};

Outcome track(const TargetTrackOptions& options, const std::vector<Receiver>& receivers,
              const std::vector<Bearing>& bearings, TargetPipeline::LiveSink live = {},
              TargetPipeline::CueSink cue = {}) {
  const test::TemporaryDirectory folder;
  ResultDirectory directory(folder / "out", "track targets");
  TargetRecord record(directory, receivers);
  TargetPipeline pipeline(options, record, std::move(live), std::move(cue));
  for (const Bearing& bearing : bearings) pipeline.add(bearing);
  pipeline.finish();
  Outcome outcome{{}, record.commit(), pipeline.left_out(), pipeline.receivers_in_operation()};
  directory.commit(nlohmann::json::object());
  if (!outcome.run.targets.empty()) outcome.rows = read_target_rows(folder / "out/tracks.csv");
  return outcome;
}

Outcome track(const TargetTrackOptions& options, const TargetScene& scene) {
  return track(settled(options, std::nullopt), scene.receivers, bearings_of(scene.receivers, scene.readings));
}

double nearest_m(const TargetScene& scene, const TargetRow& row) {
  double nearest = 1e9;
  for (const TargetPath& path : scene.paths) {
    nearest = std::min(nearest, (position_at(path, row.time) - row.p_world).norm());
  }
  return nearest;
}

TEST(SettledOptions, ArePeriodsOfDirectionFindersOrFramesOfCameras) {
  const TargetTrackOptions finders = settled({}, std::nullopt);
  EXPECT_EQ(finders.ours.period_s, 1.0);
  EXPECT_EQ(finders.ours.scan_s, 0.03);
  EXPECT_EQ(finders.output_s, 1.0);
  EXPECT_EQ(finders.ours.least_sightings, TargetTrackerOptions{}.least_sightings);
  const TargetTrackOptions cameras = settled({}, 0.04);
  EXPECT_EQ(cameras.ours.period_s, 0.04);
  EXPECT_NEAR(cameras.ours.scan_s, 0.016, 1e-12);
  EXPECT_EQ(cameras.output_s, 0.2);
  EXPECT_EQ(cameras.ours.least_sightings, 9);
  EXPECT_EQ(cameras.ours.window_periods, 10.0);
  EXPECT_EQ(cameras.ours.patience_periods, 20.0);
  EXPECT_EQ(finders.ours.filter.motion.acceleration_density, 0.1);
  EXPECT_EQ(cameras.ours.filter.motion.acceleration_density, 10.0);
}

TEST(SettledOptions, TakeWhatPosesErrByFromTheirCovariances) {
  std::vector<Receiver> receivers(2);
  EXPECT_EQ(settled({}, std::nullopt, receivers).ours.filter.added_sigma_rad, 0.0);
  receivers[0].camera = Camera{640, 480, 500, 500, 320, 240, {}};
  receivers[1].pose_covariance = 16e-6 * Matrix6d::Identity();
  EXPECT_NEAR(settled({}, std::nullopt, receivers).ours.filter.added_sigma_rad, std::sqrt((9e-6 + 16e-6) / 2), 1e-12);
  TargetTrackOptions options;
  options.added_sigma_rad = 0.0;
  EXPECT_EQ(settled(options, std::nullopt, receivers).ours.filter.added_sigma_rad, 0.0);
}

TEST(SettledOptions, KeepWhatTheUserHasSaid) {
  TargetTrackOptions options;
  options.period_s = 2.0;
  options.scan_s = 0.5;
  options.output_s = 0.1;
  options.ours.least_sightings = 30;
  for (const std::optional<double>& frame_s : {std::optional<double>(), std::optional<double>(0.04)}) {
    const TargetTrackOptions all = settled(options, frame_s);
    EXPECT_EQ(all.ours.period_s, 2.0);
    EXPECT_EQ(all.ours.scan_s, 0.5);
    EXPECT_EQ(all.output_s, 0.1);
    EXPECT_EQ(all.ours.least_sightings, 30);
  }
}

TEST(TargetTrackOptions, NameFieldValueAndBound) {
  const auto message = [](auto change) -> std::string {
    TargetTrackOptions options;
    change(options);
    try {
      validate(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "fine";
  };
  EXPECT_EQ(message([](auto&) {}), "fine");
  EXPECT_EQ(message([](auto& o) { o.output_s = -1; }), "output_s must be >= 0 s, got -1");
  EXPECT_EQ(message([](auto& o) { o.cue.slew_rad_s = 0; }), "slew_rad_s must be > 0 rad/s, got 0");
  EXPECT_NE(message([](auto& o) { o.ours.lag_s = -1; }).find("lag_s must be"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.paper.periods = 0; }).find("periods must be"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.flight.step_s = 0; }).find("step_s must be"), std::string::npos);
}

TEST(TargetPipeline, FollowsTargetsAndWritesThemInOrderOfTime) {
  const TargetScene scene = two_targets(12);
  const Outcome outcome = track({}, scene);
  EXPECT_EQ(outcome.run.targets.size(), 2u);
  EXPECT_EQ(outcome.run.bearings, 12 * 3 * 2);
  EXPECT_EQ(outcome.left_out, 0u);
  std::set<std::pair<Timestamp, int>> told;
  for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
    const TargetRow& row = outcome.rows[i];
    EXPECT_GE(row.time, outcome.rows[i > 0 ? i - 1 : 0].time);
    EXPECT_TRUE(told.emplace(row.time, row.target).second);
    EXPECT_LT(nearest_m(scene, row), 1.0);
    EXPECT_NE(row.state, "tentative");
    EXPECT_EQ(row.time.time_since_epoch() % std::chrono::seconds(1), std::chrono::nanoseconds(0));
  }
  EXPECT_EQ(outcome.rows.back().time, Timestamp(std::chrono::seconds(11)));
}

// What is written does not depend on the order of arrival within the lag; later ones are counted.
TEST(TargetPipeline, PutsLateBearingsWhereTheyBelong) {
  const TargetScene scene = two_targets(10);
  std::vector<Bearing> bearings = bearings_of(scene.receivers, scene.readings);
  const TargetTrackOptions options = settled({}, std::nullopt);
  const Outcome in_order = track(options, scene.receivers, bearings);
  for (std::size_t i = 1; i + 6 < bearings.size(); i += 6) std::swap(bearings[i], bearings[i + 4]);  // by 0.2 s
  const Outcome shuffled = track(options, scene.receivers, bearings);
  ASSERT_EQ(shuffled.rows.size(), in_order.rows.size());
  for (std::size_t i = 0; i < in_order.rows.size(); ++i) {
    EXPECT_LT((shuffled.rows[i].p_world - in_order.rows[i].p_world).norm(), 1e-9);
  }
  bearings.push_back(bearings.front());
  EXPECT_EQ(track(options, scene.receivers, bearings).left_out, 1u);
}

// At each time of output the newest estimates and cues, before late bearings have settled them.
TEST(TargetPipeline, TellsTheNewestAtOnce) {
  const TargetScene scene = two_targets(10);
  const auto bearings = bearings_of(scene.receivers, scene.readings);
  std::vector<Timestamp> times;
  int cues = 0;
  std::size_t most = 0;
  track(
      settled({}, std::nullopt), scene.receivers, bearings,
      [&](Timestamp time, const std::vector<TargetEstimate>& targets) {
        times.push_back(time);
        most = std::max(most, targets.size());
      },
      [&](const AddressedCue& cue) {
        ++cues;
        EXPECT_GE(cue.cue.time, cue.told);
      });
  ASSERT_EQ(times.size(), 9u);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(times[i], Timestamp(std::chrono::seconds(i + 1)));
  EXPECT_EQ(most, 2u);
  EXPECT_GT(cues, 2 * 3);
}

TEST(TargetPipeline, FollowsWithThePapersMethods) {
  const TargetScene scene = two_targets(8);
  for (const TargetMethod method : {TargetMethod::PaperAlternative, TargetMethod::PaperProposed}) {
    TargetTrackOptions options;
    options.method = method;
    const Outcome outcome = track(options, scene);
    ASSERT_FALSE(outcome.rows.empty());
    std::vector<double> errors;
    for (const TargetRow& row : outcome.rows) errors.push_back(nearest_m(scene, row));
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 2.0);
    EXPECT_NE(describe(options).find(method == TargetMethod::PaperProposed ? "three" : "two"), std::string::npos);
    EXPECT_TRUE(outcome.operated.empty());
  }
}

TEST(TargetPipeline, SmoothsAFlightAndCorrectsTheReceiversClocks) {
  test::SimulatedFlightOptions flight;
  flight.duration_s = 15.0;
  flight.clock_errors_s = {0.0, 0.08};
  flight.clock_sigma_s = 0.1;
  const test::SimulatedFlight simulated = test::simulate_flight(flight);
  TargetTrackOptions options;
  options.method = TargetMethod::Flight;
  options.output_s = 0.5;
  const Outcome outcome =
      track(settled(options, 0.05), simulated.receivers, bearings_of(simulated.receivers, simulated.readings));
  ASSERT_EQ(outcome.run.targets.size(), 1u);
  EXPECT_GE(outcome.rows.size(), 25u);
  for (const TargetRow& row : outcome.rows) {
    const double t_s = to_seconds(row.time.time_since_epoch());
    EXPECT_LT((row.p_world - test::simulated_position(t_s)).norm(), 1.0) << t_s;
  }
  ASSERT_EQ(outcome.operated.size(), simulated.receivers.size());
  const double corrected_s = outcome.operated[1].clock.offset_s - simulated.receivers[1].clock.offset_s -
                             (outcome.operated[0].clock.offset_s - simulated.receivers[0].clock.offset_s);
  EXPECT_NEAR(corrected_s, 0.08, 0.02);
}

TEST(TargetPipeline, WritesNothingWithoutBearings) {
  for (const TargetMethod method : {TargetMethod::Ours, TargetMethod::Flight, TargetMethod::PaperAlternative}) {
    TargetTrackOptions options;
    options.method = method;
    const Outcome outcome = track(settled(options, std::nullopt), two_targets(1).receivers, {});
    EXPECT_EQ(outcome.run.bearings, 0);
    EXPECT_TRUE(outcome.run.targets.empty());
  }
}

TEST(TargetRowOfEstimate, HasTheTemperatureWhereItWasRead) {
  TargetEstimate estimate;
  estimate.id = 4;
  estimate.status = TargetStatus::Coasting;
  estimate.sightings = 9;
  EXPECT_FALSE(row_of(estimate).temperature_k);
  estimate.temperature_readings = 3;
  estimate.temperature_mean_k = 300.0;
  estimate.temperature_spread_k = 2.0;
  const TargetRow row = row_of(estimate);
  EXPECT_EQ(row.temperature_k, 300.0);
  EXPECT_EQ(row.temperature_sigma_k, 2.0);
  EXPECT_EQ(row.state, "coasting");
  EXPECT_EQ(row.sightings, 9);
}

}  // namespace
}  // namespace alidade
