// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/receiver_checks.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "datasets/flight_recording.h"
#include "tests/calib/receivers/simulated_track.h"
#include "tests/support/data_directory.h"
#include "tests/support/simulated_flight.h"

namespace alidade {
namespace {

constexpr double kDuration_s = 130.0;

const test::SimulatedFlight& sound_flight() {
  static const auto flight = test::simulate_flight({.receivers = 3, .duration_s = kDuration_s});
  return flight;
}

std::vector<ReceiverFinding> checked(const test::SimulatedFlight& flight) {
  return check_receivers(flight.receivers, flight.readings, test::simulated_track(kDuration_s));
}

void swap_places(Receiver& a, Receiver& b) {
  const Eigen::Vector3d place = a.T_world_receiver.translation();
  a.T_world_receiver.translation() = b.T_world_receiver.translation();
  b.T_world_receiver.translation() = place;
}

TEST(ReceiverChecks, FindNothingWhereNothingIsWrong) {
  EXPECT_TRUE(checked(sound_flight()).empty());
}

TEST(ReceiverChecks, NameSwappedPlaces) {
  auto flight = sound_flight();
  swap_places(flight.receivers[0], flight.receivers[2]);
  const auto found = checked(flight);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(describe(found[0]), "receivers 0 and 2: each stands where the other is said to stand");
}

TEST(ReceiverChecks, TellThreeExchangedPlacesFromTwoSwapped) {
  auto flight = sound_flight();
  swap_places(flight.receivers[0], flight.receivers[1]);
  swap_places(flight.receivers[1], flight.receivers[2]);
  const auto found = checked(flight);
  ASSERT_EQ(found.size(), 3u);
  for (const ReceiverFinding& f : found) EXPECT_EQ(f.fault, ReceiverFault::WrongPlace) << describe(f);
}

TEST(ReceiverChecks, NameAWrongPlace) {
  auto flight = sound_flight();
  flight.receivers[1].T_world_receiver.translation() += Eigen::Vector3d(3.0, 0.0, 4.0);
  const auto found = checked(flight);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, ReceiverFault::WrongPlace);
  EXPECT_EQ(found[0].receiver, 1);
  EXPECT_NEAR(found[0].size, 5.0, 0.1);
}

TEST(ReceiverChecks, NameAWrongFocalLength) {
  auto flight = sound_flight();
  flight.receivers[1].camera->fx *= 1.03;
  flight.receivers[1].camera->fy *= 1.03;
  const auto found = checked(flight);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(describe(found[0]), "receiver 1: its focal lengths are to be multiplied by 0.971");
}

TEST(ReceiverChecks, NameAClockThatDroppedFrames) {
  auto flight = sound_flight();
  for (ReceiverReading& reading : flight.readings) {
    if (reading.receiver == 2 && reading.time > Timestamp(from_seconds(70.0))) reading.time -= from_seconds(0.3);
  }
  const auto found = checked(flight);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, ReceiverFault::UnevenClock);
  EXPECT_EQ(found[0].receiver, 2);
}

TEST(ReceiverChecks, RefuseOptionsOutOfBounds) {
  EXPECT_THROW(check_receivers({}, {}, test::simulated_track(5.0), {.least_focal = 0.0}), std::invalid_argument);
}

// The real flight: the phone mate10_1 (2) counts frames unevenly by itself, the others do not.
class ReceiverChecksOfRealFlight : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::data_directory("uav");
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
    flight_ = read_flight(folder);
    std::erase_if(flight_.truth, [&](const TimedPosition& p) { return p.time > flight_.used_until; });
  }
  std::vector<ReceiverFinding> others_than_known() const {
    auto found = check_receivers(flight_.receivers, flight_.readings, KnownTrack(flight_.truth));
    std::erase_if(found, [](const auto& f) { return f.receiver == 2 && f.fault == ReceiverFault::UnevenClock; });
    return found;
  }
  FlightRecording flight_;
};

TEST_F(ReceiverChecksOfRealFlight, FindOnlyTheClockThatIsKnownToBeUneven) {
  EXPECT_TRUE(others_than_known().empty());
}

TEST_F(ReceiverChecksOfRealFlight, NameSwappedPlaces) {
  swap_places(flight_.receivers[1], flight_.receivers[5]);
  const auto found = others_than_known();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(describe(found[0]), "receivers 1 and 5: each stands where the other is said to stand");
}

}  // namespace
}  // namespace alidade
