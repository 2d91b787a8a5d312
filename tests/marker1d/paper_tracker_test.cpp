// SPDX-License-Identifier: Apache-2.0
#include "marker1d/paper_tracker.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/marker1d/body_frames.h"

namespace alidade {
namespace {

std::vector<PaperStep> track(const RigidBody& body, const std::vector<test::BodyFrame>& frames,
                             const PaperTrackerOptions& options = {}) {
  PaperTracker tracker(body, options);
  std::vector<PaperStep> steps;
  for (const auto& frame : frames) steps.push_back(tracker.step(frame.planes.time, frame.planes.planes));
  return steps;
}

double rms_mm(const std::vector<test::BodyFrame>& frames, const std::vector<PaperStep>& steps) {
  double squares = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    squares += (steps[i].T_world_body.translation() - frames[i].T_world_body.translation()).squaredNorm();
  }
  return 1e3 * std::sqrt(squares / static_cast<double>(steps.size()));
}

class PaperTrack : public testing::Test {
 protected:
  static BodySceneOptions options() {
    BodySceneOptions options;
    options.frames = 600;
    return options;
  }

  BodyScene scene_{options()};
  RigidBody body_ = scene_.bodies()[0];
  std::vector<test::BodyFrame> frames_ = test::body_frames(scene_);
};

TEST_F(PaperTrack, FollowsFromItsOwnStartInThreeNewtonSteps) {
  const auto steps = track(body_, frames_);
  double newton = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].outcome, PaperOutcome::Solved);
    EXPECT_FALSE(steps[i].is_degenerate);
    EXPECT_EQ(steps[i].plane_count, 48);
    EXPECT_LE(steps[i].newton_steps, i < 3 ? 6 : 3) << i;
    newton += steps[i].newton_steps;
  }
  EXPECT_LT(newton / 600, 3.1);
  EXPECT_LT(rms_mm(frames_, steps), 0.17);  // 1.08 of the bound, measured
}

TEST_F(PaperTrack, RejectsASinglePlaneFarOff) {
  frames_.resize(1);
  for (MarkerPlane& plane : frames_[0].planes.planes) {  // exact but one
    plane.plane_world.offset = plane.plane_world.normal.dot(
        frames_[0].T_world_body * body_.markers[static_cast<std::size_t>(plane.marker)].p_body);
  }
  frames_[0].planes.planes[11].plane_world.offset += 0.05;
  PaperTrackerOptions keeping;
  keeping.rejection = 1e9;
  EXPECT_GT(rms_mm(frames_, track(body_, frames_, keeping)), 0.5);
  const auto steps = track(body_, frames_);
  EXPECT_EQ(steps[0].rejected_count, 1);
  EXPECT_LT(rms_mm(frames_, steps), 1e-9);
}

TEST_F(PaperTrack, PadsFramesOfFewerThanSixPlanes) {
  for (std::size_t i = 300; i < 310; ++i) {  // one block's four planes of one marker
    auto& planes = frames_[i].planes.planes;
    std::erase_if(planes, [](const MarkerPlane& plane) { return plane.marker != 1; });
    planes.resize(4);
  }
  const auto steps = track(body_, frames_);
  for (std::size_t i = 290; i < 320; ++i) {
    EXPECT_EQ(steps[i].outcome, i >= 300 && i < 310 ? PaperOutcome::Padded : PaperOutcome::Solved) << i;
    EXPECT_LT((steps[i].T_world_body.translation() - frames_[i].T_world_body.translation()).norm(), 0.02) << i;
  }
  EXPECT_NEAR(steps[309].unseen_s, 0.04, 1e-9);
  EXPECT_EQ(steps[310].unseen_s, 0.0);
}

TEST_F(PaperTrack, PadsAFrameWithoutAnyPlane) {
  frames_.resize(110);
  for (std::size_t i = 100; i < 110; ++i) frames_[i].planes.planes.clear();
  const auto steps = track(body_, frames_);
  EXPECT_EQ(steps[109].outcome, PaperOutcome::Padded);
  EXPECT_LT((steps[109].T_world_body.translation() - frames_[109].T_world_body.translation()).norm(), 0.02);
}

TEST_F(PaperTrack, IsLostWhereItNeverBegan) {
  PaperTracker tracker(body_);
  const auto& planes = frames_[0].planes.planes;
  EXPECT_FALSE(tracker.predicted(frames_[0].planes.time));
  const PaperStep step = tracker.step(frames_[0].planes.time, std::span(planes).first(5));
  EXPECT_EQ(step.outcome, PaperOutcome::Lost);
  EXPECT_EQ(step.plane_count, 5);
}

TEST_F(PaperTrack, BeginsWhereItIsTold) {
  PaperTracker tracker(body_);
  tracker.start(frames_[0].planes.time, frames_[0].T_world_body);
  const PaperStep step = tracker.step(frames_[1].planes.time, std::span(frames_[1].planes.planes).first(4));
  EXPECT_EQ(step.outcome, PaperOutcome::Padded);
  EXPECT_LT(difference(frames_[0].T_world_body, step.T_world_body).norm(), 0.05);
}

TEST_F(PaperTrack, FlagsFramesOfOneBlockAlone) {
  BodySceneOptions one = options();
  one.frames = 50;
  one.blocks = 1;
  BodyScene scene(one);
  PaperTracker tracker(scene.bodies()[0]);
  for (const auto& frame : test::body_frames(scene)) {
    tracker.start(frame.planes.time, frame.T_world_body);
    EXPECT_TRUE(tracker.step(frame.planes.time, frame.planes.planes).is_degenerate);
  }
}

TEST_F(PaperTrack, RefinesGapsByWhatCameLater) {
  for (const std::size_t gap : {150u, 300u, 450u}) {
    for (std::size_t i = gap; i < gap + 50; ++i) frames_[i].planes.planes.clear();
  }
  const auto forward = track(body_, frames_);
  std::vector<PaperFrame> planes;
  for (const auto& frame : frames_) planes.push_back(frame.planes);
  const auto refined = refine_backward(body_, planes, forward);
  EXPECT_GT(rms_mm(frames_, forward), 5.0);
  EXPECT_LT(rms_mm(frames_, refined), 0.6 * rms_mm(frames_, forward));
  // What both ways solved from the same planes stays.
  EXPECT_LT(difference(forward[50].T_world_body, refined[50].T_world_body).norm(), 1e-9);
  EXPECT_EQ(refined[160].outcome, PaperOutcome::Padded);
  EXPECT_THROW(refine_backward(body_, planes, std::span(forward).first(5)), std::invalid_argument);
}

TEST_F(PaperTrack, RefinesAStartThatWasLost) {
  for (std::size_t i = 0; i < 20; ++i) frames_[i].planes.planes.clear();
  const auto forward = track(body_, frames_);
  EXPECT_EQ(forward[10].outcome, PaperOutcome::Lost);
  std::vector<PaperFrame> planes;
  for (const auto& frame : frames_) planes.push_back(frame.planes);
  const auto refined = refine_backward(body_, planes, forward);
  EXPECT_EQ(refined[10].outcome, PaperOutcome::Padded);
  EXPECT_LT((refined[10].T_world_body.translation() - frames_[10].T_world_body.translation()).norm(), 0.02);
}

TEST_F(PaperTrack, GivesTheSameTwice) {
  const auto first = track(body_, frames_), second = track(body_, frames_);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].T_world_body.matrix(), second[i].T_world_body.matrix());
  }
}

TEST_F(PaperTrack, RefusesWhatCannotBe) {
  EXPECT_THROW(PaperTracker({"empty", {}}), std::invalid_argument);
  PaperTrackerOptions options;
  options.least_planes = 5;
  EXPECT_THROW(PaperTracker(body_, options), std::invalid_argument);
  PaperTracker tracker(body_);
  const std::vector<MarkerPlane> unknown{{4, {}, 1.0}};
  EXPECT_THROW(tracker.step({}, unknown), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
