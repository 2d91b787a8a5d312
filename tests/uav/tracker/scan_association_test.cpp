// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/scan_association.h"

#include <cmath>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Eigen::Vector3d;

constexpr double kSigma_rad = 1e-3;

Timestamp at(double seconds) {
  return Timestamp(from_seconds(seconds));
}

TargetTrack track_at(const Vector3d& p_world, double sigma_m) {
  TargetTrack track;
  track.state.p_world = p_world;
  track.state.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  track.state.covariance.diagonal().segment<3>(3).setConstant(0.01);
  return track;
}

Bearing to(const Vector3d& p_world, double time_s = 0.0) {
  Bearing bearing;
  bearing.time = at(time_s);
  bearing.direction_world = p_world.normalized();
  bearing.covariance = kSigma_rad * kSigma_rad * Eigen::Matrix2d::Identity();
  return bearing;
}

TargetTrackerOptions options_of(ScanAssociation association) {
  TargetTrackerOptions options;
  options.association = association;
  options.detection_probability = 0.95;
  return options;
}

// The second track's bearing is the nearest one of both: the first is left the other.
TEST(ScanAssociation, GivesBearingsForTheBestOfAll) {
  const std::vector<TargetTrack> tracks{track_at({0, 0, 100}, 0.3), track_at({0.6, 0, 100}, 0.3)};
  const BearingScan scan{0, {to({-0.5, 0, 100}), to({0.25, 0, 100})}};
  const ScanOutcome outcome = take_scan(tracks, scan, options_of(ScanAssociation::NearestNeighbour));
  EXPECT_TRUE(outcome.is_claimed[0] && outcome.is_claimed[1]);
  EXPECT_LT(outcome.tracks[0].state.p_world.x(), -0.3);
  EXPECT_NEAR(outcome.tracks[1].state.p_world.x(), 0.25, 0.1);
}

TEST(ScanAssociation, LeavesAloneWhatIsBeyondTheGate) {
  for (const ScanAssociation association : {ScanAssociation::NearestNeighbour, ScanAssociation::Joint}) {
    const std::vector<TargetTrack> tracks{track_at({0, 0, 100}, 0.1)};
    const BearingScan scan{0, {to({3, 0, 100})}};
    const ScanOutcome outcome = take_scan(tracks, scan, options_of(association));
    EXPECT_FALSE(outcome.is_claimed[0]);
    EXPECT_EQ(outcome.tracks[0].sightings, 0);
    EXPECT_EQ(outcome.tracks[0].state.p_world, tracks[0].state.p_world);
  }
}

// Nothing else is near: both ways are one filter's update, but for the small chance that the bearing is false.
TEST(ScanAssociation, IsAPlainUpdateForOneTrackAndOneBearing) {
  const TargetTrackerOptions options = options_of(ScanAssociation::Joint);
  const TargetTrack track = track_at({0, 0, 100}, 0.2);
  const Bearing bearing = to({0.2, 0.1, 100}, 0.5);
  const TargetState expected = filter_bearings(track.state, std::vector<Bearing>{bearing}, options.filter);
  for (const ScanAssociation association : {ScanAssociation::NearestNeighbour, ScanAssociation::Joint}) {
    const ScanOutcome outcome = take_scan({track}, {0, {bearing}}, options_of(association));
    EXPECT_LT((outcome.tracks[0].state.p_world - expected.p_world).norm(), 1e-3);
    EXPECT_EQ(outcome.tracks[0].state.time, at(0.5));
    EXPECT_EQ(outcome.tracks[0].sightings, 1);
  }
}

// Two bearings as near on either side: the mean stays, and the track is less sure than with one that is its own.
TEST(ScanAssociation, WeighsBearingsThatAreAsLikely) {
  const TargetTrackerOptions options = options_of(ScanAssociation::Joint);
  const TargetTrack track = track_at({0, 0, 100}, 0.3);
  const ScanOutcome outcome = take_scan({track}, {0, {to({0.5, 0, 100}), to({-0.5, 0, 100})}}, options);
  const TargetState& state = outcome.tracks[0].state;
  EXPECT_NEAR(state.p_world.x(), 0.0, 1e-6);
  const double own =
      filter_bearings(track.state, std::vector<Bearing>{to({0.5, 0, 100})}, options.filter).covariance(0, 0);
  EXPECT_GT(state.covariance(0, 0), 5.0 * own);
  EXPECT_FALSE(outcome.is_claimed[0]);
}

// As near as each other, one as warm as the track.
TEST(ScanAssociation, TellsTargetsApartByTheirTemperature) {
  TargetTrackerOptions options = options_of(ScanAssociation::NearestNeighbour);
  std::vector<TargetTrack> tracks{track_at({0, 0, 100}, 0.3), track_at({0.02, 0, 100}, 0.3)};
  for (int i = 0; i < 10; ++i) {
    tracks[0].temperature.add(290.0, 1.0);
    tracks[1].temperature.add(320.0, 1.0);
  }
  BearingScan scan{0, {to({0.1, 0, 100}), to({-0.1, 0, 100})}};
  scan.bearings[0].temperature_k = 290.0;
  scan.bearings[1].temperature_k = 320.0;
  const auto x_of_first = [&] { return take_scan(tracks, scan, options).tracks[0].state.p_world.x(); };
  EXPECT_LT(x_of_first(), 0.0);
  options.temperature_sigma_k = 3.0;
  EXPECT_GT(x_of_first(), 0.0);
}

// More probably false than not by themselves, but less so than that the track was missed: 5 %.
TEST(ScanAssociation, WeighsABearingAgainstAMiss) {
  TargetTrackerOptions options = options_of(ScanAssociation::NearestNeighbour);
  const TargetTrack track = track_at({0, 0, 100}, 0.2);
  const Bearing bearing = to({0, 0, 100});
  const double log_density = innovation_of(track.state, bearing)->log_density;
  const auto is_claimed_at = [&](double log_ratio) -> bool {
    options.false_bearings_per_sr = 0.95 * std::exp(log_density - log_ratio);
    return take_scan({track}, {0, {bearing}}, options).is_claimed[0];
  };
  EXPECT_TRUE(is_claimed_at(0.9 * std::log(0.05)));
  EXPECT_FALSE(is_claimed_at(1.1 * std::log(0.05)));
}

// More ways than can be counted: nearest neighbour, and every bearing is of one track still.
TEST(ScanAssociation, FallsBackWhereAllIsOneHeap) {
  std::vector<TargetTrack> tracks;
  BearingScan scan{0, {}};
  for (int i = 0; i < 12; ++i) {
    tracks.push_back(track_at({0.01 * i, 0, 100}, 1.0));
    scan.bearings.push_back(to({0.01 * i, 0.01, 100}));
  }
  const ScanOutcome outcome = take_scan(tracks, scan, options_of(ScanAssociation::Joint));
  for (const TargetTrack& track : outcome.tracks) EXPECT_EQ(track.sightings, 1);
}

}  // namespace
}  // namespace alidade
