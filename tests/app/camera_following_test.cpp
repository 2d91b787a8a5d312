// SPDX-License-Identifier: Apache-2.0
#include "app/camera_following.h"

#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/live_tracker.h"
#include "datasets/rendered_scene.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

const Camera kCamera{320, 240, 260, 260, 159.5, 119.5, {}};

// Grey frames at 50 Hz, stamped by the host's clock when they are given, as a camera's are; endless.
class PacedSource : public FrameSource {
 public:
  explicit PacedSource(int fails_at = -1) : fails_at_(fails_at) {}

  std::optional<Frame> next(std::stop_token stop) override {
    if (stop.stop_requested()) return std::nullopt;
    if (index_ == fails_at_) throw DeviceError("cam", "wait", "it is gone", "plug it in");
    std::this_thread::sleep_for(20ms);
    Frame frame;
    frame.index = index_++;
    frame.time = Timestamp(HostClock::now().time_since_epoch());
    frame.image = cv::Mat(kCamera.height, kCamera.width, CV_8U, cv::Scalar(100));
    frame.stamp.dropped_before = 1;
    frame.stamp.discarded_before = 2;
    return frame;
  }
  std::optional<int> frame_count() const override { return std::nullopt; }
  bool has_times() const override { return true; }
  std::string describe() const override { return "a camera"; }

 private:
  int fails_at_;
  int index_ = 0;
};

FollowedCamera follow(const FollowOptions& options, int fails_at, std::stop_token stop, bool is_live = true) {
  RunContext context;
  context.stop = std::move(stop);
  context.progress = [](const Progress&) {};
  CameraSource source;
  source.frames = std::make_unique<PacedSource>(fails_at);
  source.camera = kCamera;
  source.is_live = is_live;
  CameraTracker tracker(kCamera, {});
  return follow_camera(context, source, tracker, options);
}

TEST(CameraFollowing, AnswersEveryFrameOfALiveCameraAndCountsWhatWasLost) {
  FollowOptions options;
  options.most_frames = 10;
  const FollowedCamera followed = follow(options, -1, {});
  EXPECT_EQ(followed.reports.size(), 10u);
  EXPECT_EQ(followed.reports.back().state, FrameState::Waiting);
  ASSERT_TRUE(followed.tally.has_value());
  EXPECT_EQ(followed.tally->dropped, 9u);  // not what was lost before the first frame
  EXPECT_EQ(followed.tally->discarded, 18u);
  EXPECT_EQ(followed.tally->latencies_s.size(), 10u);
  EXPECT_GT(latency_quantile(*followed.tally, 0.5), 0.0);
  EXPECT_LT(latency_quantile(*followed.tally, 0.5), 0.5);
  EXPECT_FALSE(followed.interrupted);
}

TEST(CameraFollowing, EndsAfterTheTimeGiven) {
  FollowOptions options;
  options.most_s = 0.2;
  const FollowedCamera followed = follow(options, -1, {});
  EXPECT_GE(followed.reports.size(), 1u);
  EXPECT_LE(followed.reports.size(), 11u);
}

TEST(CameraFollowing, EndsWhenTheUserStopsIt) {
  std::stop_source stop;
  stop.request_stop();
  const FollowedCamera followed = follow({}, -1, stop.get_token());
  EXPECT_TRUE(followed.interrupted);
  EXPECT_TRUE(followed.reports.empty());
}

TEST(CameraFollowing, KeepsWhatThereIsWhenTheCameraFails) {
  const FollowedCamera followed = follow({}, 5, {});
  ASSERT_TRUE(followed.fault.has_value());
  EXPECT_STREQ(followed.fault->what(), "cam: wait: it is gone; plug it in");
  EXPECT_EQ(followed.reports.size(), 5u);
  EXPECT_THROW(follow({}, 0, {}), DeviceError);
}

TEST(CameraFollowing, HasNoTallyOfARecording) {
  FollowOptions options;
  options.most_frames = 3;
  const FollowedCamera followed = follow(options, -1, {}, false);
  EXPECT_EQ(followed.reports.size(), 3u);
  EXPECT_FALSE(followed.tally.has_value());
}

TEST(LatencyQuantile, IsThatOfTheSortedLatencies) {
  LiveTally tally;
  EXPECT_EQ(latency_quantile(tally, 0.5), 0.0);
  for (int i = 100; i >= 0; --i) tally.latencies_s.push_back(static_cast<float>(i));
  EXPECT_EQ(latency_quantile(tally, 0.5), 50.0);
  EXPECT_EQ(latency_quantile(tally, 0.99), 99.0);
  EXPECT_EQ(latency_quantile(tally, 1.0), 100.0);
}

ImageFrame rendered_frame(RenderedScene& scene, int index) {
  ImageFrame frame;
  frame.index = index;
  frame.time = scene.time(index);
  cv::extractChannel(scene.frame(index), frame.grey, 1);
  return frame;
}

TEST(LiveTracker, AnswersWhileTheMapIsMadeAndFollowsOnceItIs) {
  RenderedSceneOptions options;
  options.camera = kCamera;
  options.frames = 400;
  RenderedScene scene(options);
  CameraTracker tracker(kCamera, {});
  LiveTracker live(tracker);
  int waiting = 0, tracked = 0;
  for (int i = 0; i < options.frames && tracked < 5; ++i) {
    const FrameReport report = live.step(rendered_frame(scene, i));
    waiting += report.state == FrameState::Waiting;
    tracked += report.state == FrameState::Tracked;
    EXPECT_EQ(report.index, i);
    std::this_thread::sleep_for(10ms);
  }
  live.finish();
  EXPECT_GT(waiting, 0);
  EXPECT_EQ(tracked, 5);
  EXPECT_LE(tracker.reports().size(), 400u);
  EXPECT_GE(tracker.live_map().map.keyframes.size(), 2u);
}

}  // namespace
}  // namespace alidade
