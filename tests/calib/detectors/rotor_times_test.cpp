// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/rotor_times.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "datasets/detectors.h"
#include "io/body_file.h"
#include "io/reading_file.h"
#include "tests/support/data_directory.h"

namespace alidade {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kPeriods[] = {959000 / 48e6, 957000 / 48e6};
constexpr double kPhases[] = {0.0031, 0.0142};

double angle_at(int station, int sweep, double t) {
  return 0.3 * std::sin(1.1 * t + station) + 0.1 * std::sin(2.7 * t + 2 * sweep);
}

// How far into its turn a rotor is when its sweep passes.
double turned(int sweep, double angle) {
  return (angle + kTurn / 3.0 * (sweep + 1)) / kTurn;
}

double passing_time(int station, int sweep, int rotation) {
  const double start = kPhases[station] + kPeriods[station] * rotation;
  return start + kPeriods[station] * turned(sweep, angle_at(station, sweep, start));
}

struct TimedReading {
  LineReading reading;
  double passing_s = 0.0;  // true
};

// A marker that two stations sweep. A receiver that is not prompt hands out a rotation when the next sweep, whosever,
// passes after the second one, at least 2 ms later; the second sweep's stamp follows from the angles.
std::vector<TimedReading> record(bool is_prompt, double duration_s, double clock_ratio) {
  std::vector<double> passings;
  const auto rotations = [&](int station) { return static_cast<int>(duration_s / kPeriods[station]); };
  for (int station : {0, 1}) {
    for (int n = 0; n < rotations(station) + 2; ++n) {
      for (int sweep : {0, 1}) passings.push_back(passing_time(station, sweep, n));
    }
  }
  std::sort(passings.begin(), passings.end());
  std::vector<TimedReading> all;
  for (int station : {0, 1}) {
    for (int n = 0; n < rotations(station); ++n) {
      const double first = passing_time(station, 0, n), second = passing_time(station, 1, n);
      const double ended = *std::lower_bound(passings.begin(), passings.end(), second + 0.002);
      double stamp = clock_ratio * (is_prompt ? first : ended);
      for (int sweep : {0, 1}) {
        const double angle = angle_at(station, sweep, kPhases[station] + kPeriods[station] * n);
        all.push_back({{Timestamp(from_seconds(stamp)), 2 * station + sweep, 0, angle, 0.0},
                       clock_ratio * (sweep == 0 ? first : second)});
        stamp += is_prompt ? clock_ratio * (second - first) : second - first;
      }
    }
  }
  std::sort(all.begin(), all.end(),
            [](const TimedReading& a, const TimedReading& b) { return a.reading.time < b.reading.time; });
  return all;
}

std::vector<LineReading> readings_of(const std::vector<TimedReading>& all) {
  std::vector<LineReading> readings;
  for (const TimedReading& one : all) readings.push_back(one.reading);
  return readings;
}

std::vector<LineDetector> two_stations() {
  std::vector<LineDetector> detectors;
  for (int id = 0; id < 4; ++id) {
    detectors.push_back({id, id < 2 ? "a" : "b", Lighthouse2Full{id % 2, {}}});
  }
  return detectors;
}

double seconds_of(const LineReading& reading) {
  return to_seconds(reading.time.time_since_epoch());
}

// Up to a shift that all have in common.
TEST(RotorTimes, AreThoseAtWhichTheSweepsPassed) {
  const auto recorded = record(false, 25.0, 0.989);
  const auto found = time_by_rotors(two_stations(), readings_of(recorded));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->clock_ratio, 0.989, 1e-5);
  EXPECT_GT(found->delay_range_s, 8e-3);
  ASSERT_EQ(found->readings.size(), recorded.size());
  std::vector<double> shifts, stamped;
  for (const TimedReading& one : recorded) {
    const auto same = std::find_if(found->readings.begin(), found->readings.end(), [&](const LineReading& reading) {
      return reading.detector == one.reading.detector && reading.value == one.reading.value;
    });
    ASSERT_NE(same, found->readings.end());
    shifts.push_back(seconds_of(*same) - one.passing_s);
    stamped.push_back(seconds_of(one.reading) - one.passing_s);
  }
  const auto range = [](const std::vector<double>& values) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return *most - *least;
  };
  EXPECT_GT(range(stamped), 8e-3);
  EXPECT_LT(range(shifts), 0.5e-3);
  EXPECT_TRUE(std::is_sorted(found->readings.begin(), found->readings.end(),
                             [](const LineReading& a, const LineReading& b) { return a.time < b.time; }));
}

TEST(RotorTimes, LeaveReadingsOfOtherDetectorsAlone) {
  auto detectors = two_stations();
  detectors.push_back({9, "line", FocalLine{}});
  auto readings = readings_of(record(false, 25.0, 0.989));
  const LineReading other{Timestamp(from_seconds(seconds_of(readings[100]))), 9, 0, 0.123, 0.0};
  readings.insert(readings.begin() + 101, other);
  const auto found = time_by_rotors(detectors, readings);
  ASSERT_TRUE(found);
  const auto same = std::find_if(found->readings.begin(), found->readings.end(),
                                 [](const LineReading& reading) { return reading.detector == 9; });
  ASSERT_NE(same, found->readings.end());
  EXPECT_EQ(same->time, other.time);
}

TEST(RotorTimes, AreNotAskedWhereStampsAgreeWithThem) {
  EXPECT_FALSE(time_by_rotors(two_stations(), readings_of(record(true, 25.0, 1.0))));
}

TEST(RotorTimes, AreEmptyWithTooLittleToGoBy) {
  EXPECT_FALSE(time_by_rotors(two_stations(), {}));
  EXPECT_FALSE(time_by_rotors(two_stations(), readings_of(record(false, 15.0, 0.989))));
  auto one_station = two_stations();
  one_station.resize(2);
  EXPECT_FALSE(time_by_rotors(one_station, readings_of(record(false, 25.0, 0.989))));
}

TEST(RotorTimes, AreEmptyForPeriodsOfNoChannel) {
  auto readings = readings_of(record(false, 25.0, 0.989));
  for (LineReading& reading : readings) reading.time = Timestamp(from_seconds(1.003 * seconds_of(reading)));
  EXPECT_FALSE(time_by_rotors(two_stations(), readings));
}

std::optional<RotorTimes> times_of_recording(const std::filesystem::path& folder) {
  const DetectorRig rig = read_detectors(folder);
  const auto bodies = read_bodies(folder / "body.csv");
  ReadingReader reader(folder / "observations.csv", rig.detectors, bodies);
  std::vector<LineReading> readings;
  while (const auto reading = reader.next()) readings.push_back(*reading);
  return time_by_rotors(rig.detectors, readings);
}

// Motion capture has the drone's clock at 0.989 of its own; both stations' delays span the same.
TEST(RotorTimes, RepairAFlightAndLeaveADeviceThatStampsItself) {
  const auto folder = test::data_directory("marker1d");
  if (!std::filesystem::exists(folder / "lh2_flight01")) GTEST_SKIP() << folder << " is not there";
  const auto flight = times_of_recording(folder / "lh2_flight01");
  ASSERT_TRUE(flight);
  EXPECT_NEAR(flight->clock_ratio, 0.98904, 2e-5);
  EXPECT_NEAR(flight->delay_range_s, 11.7e-3, 0.1e-3);
  EXPECT_EQ(flight->readings.size(), 27392u);
  EXPECT_FALSE(times_of_recording(folder / "sv_index32"));
}

}  // namespace
}  // namespace alidade
