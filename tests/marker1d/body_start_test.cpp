// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_start.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "datasets/body_scene.h"

namespace alidade {
namespace {

struct Tally {
  int certain = 0, certain_and_wrong = 0, ambiguous = 0, ambiguous_without_truth = 0, none = 0;
};

// `keep` says which readings of a frame are there.
template <class Keep>
Tally start_every(int frames, int every, const Keep& keep) {
  BodySceneOptions options;
  options.frames = frames;
  BodyScene scene(options);
  const DetectorArray detectors(scene.detectors());
  Tally tally;
  for (int i = 0; const auto frame = scene.next(); ++i) {
    if (i % every != 0) continue;
    std::vector<LineReading> readings;
    for (const LineReading& r : frame->readings) {
      if (keep(r)) readings.push_back(r);
    }
    const auto candidates = start_body(detectors, scene.bodies().front(), readings, frame->time, 1.0);
    const Eigen::Isometry3d truth = pose_in_scene(0, frame->time);
    const bool holds_truth = std::any_of(candidates.begin(), candidates.end(), [&](const BodyCandidate& c) {
      const Vector6d error = difference(c.state.T_world_body, truth);
      return error.dot(c.state.covariance.topLeftCorner<6, 6>().ldlt().solve(error)) < 36.0;  // 2e-6
    });
    if (candidates.empty()) ++tally.none;
    if (candidates.size() == 1) ++tally.certain;
    if (candidates.size() == 1 && !holds_truth) ++tally.certain_and_wrong;
    if (candidates.size() > 1) ++tally.ambiguous;
    if (candidates.size() > 1 && !holds_truth) ++tally.ambiguous_without_truth;
  }
  return tally;
}

TEST(BodyStart, IsCertainAndRightWithFullInformation) {
  const Tally tally = start_every(5000, 25, [](const LineReading&) { return true; });
  EXPECT_EQ(tally.certain, 200);
  EXPECT_EQ(tally.certain_and_wrong, 0);
}

// Detectors 0, 4, 8 are of three blocks. Three markers with two planes each: up to eight poses are exact.
// Of two that lie close together noise may leave none, only a blunt minimum between or beside them: one frame in a
// hundred of this scene.
TEST(BodyStart, NamesAllPosesOfSixPlanes) {
  const Tally tally = start_every(5000, 25, [](const LineReading& r) {
    return (r.marker == 0 && (r.detector == 0 || r.detector == 5)) ||
           (r.marker == 1 && (r.detector == 4 || r.detector == 10)) ||
           (r.marker == 2 && (r.detector == 8 || r.detector == 2));
  });
  EXPECT_GT(tally.ambiguous, 100);
  EXPECT_LE(tally.ambiguous_without_truth, 2);
}

TEST(BodyStart, AnswersNothingFromOneMarker) {
  const Tally tally = start_every(100, 10, [](const LineReading& r) { return r.marker == 0; });
  EXPECT_EQ(tally.none, 10);
}

}  // namespace
}  // namespace alidade
