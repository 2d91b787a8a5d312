// SPDX-License-Identifier: Apache-2.0
#include "app/camera_following.h"

#include <chrono>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/live_messages.h"
#include "app/live_tracker.h"

namespace alidade {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

class Following {
 public:
  Following(const RunContext& context, CameraSource& source, CameraTracker& tracker, const FollowOptions& options)
      : context_(context), source_(source), tracker_(tracker), options_(options), total_(source.frames->frame_count()) {
    if (!source_.is_live) return;
    followed_.tally.emplace();
    source_.first.reset();  // it waited while all was set up, and so did others behind it
    live_tracker_.emplace(tracker_);
  }

  FollowedCamera run() {
    try {
      while (!is_over() && follow_next()) {
      }
    } catch (const DeviceError& error) {
      if (followed_.reports.empty() && tracker_.reports().empty()) throw;
      followed_.fault = error;
    }
    if (live_tracker_) {
      live_tracker_->finish();
    } else {
      followed_.reports = tracker_.reports();
    }
    return std::move(followed_);
  }

 private:
  bool is_over() {
    followed_.interrupted = context_.stop.stop_requested();
    const bool has_all = options_.most_frames && frames_ >= *options_.most_frames;
    return followed_.interrupted || has_all || (options_.most_s && seconds_since(begin_) >= *options_.most_s);
  }

  // False at the end of the source.
  bool follow_next() {
    const auto begin = Clock::now();
    const auto frame = next_image(source_, context_.stop);
    if (!frame) {
      followed_.interrupted = context_.stop.stop_requested();
      return false;
    }
    FrameReport report = live_tracker_ ? live_tracker_->step(*frame) : tracker_.step(*frame);
    followed_.tracked_at_once += report.state == FrameState::Tracked;
    const auto told =
        options_.live ? options_.live->send(pose_message(options_.source, report, source_.stamp)) : Clock::now();
    followed_.tracking_s += seconds_since(begin);
    if (followed_.tally) count(*frame, told);
    ++frames_;
    if (options_.looks_for_markers && report.is_keyframe) {
      followed_.markers.push_back({report.index, detect_markers(frame->grey)});
    }
    if (options_.movie) options_.movie->add(*frame, report);
    show(*frame, report);
    if (live_tracker_) followed_.reports.push_back(kept(std::move(report)));
    return true;
  }

  // What was lost before the first frame is not for want of speed.
  void count(const ImageFrame& frame, Clock::time_point told) {
    LiveTally& tally = *followed_.tally;
    const Clock::time_point exposed{std::chrono::duration_cast<Clock::duration>(frame.time.time_since_epoch())};
    tally.latencies_s.push_back(std::chrono::duration<float>(told - exposed).count());
    if (frames_ == 0) return;
    tally.dropped += source_.stamp.dropped_before;
    tally.discarded += source_.stamp.discarded_before;
  }

  FrameReport kept(FrameReport report) const {
    report.expectations.clear();
    std::erase_if(report.sightings, [](const FrameSighting& s) { return !s.is_inlier; });
    if (!tracker_.options().will_be_refined) report.sightings = {};
    return report;
  }

  void show(const ImageFrame& frame, const FrameReport& report) {
    Progress progress{"tracking", frame.index + 1, total_.value_or(0), ""};
    const std::string news = report.reason.empty() ? "" : fmt::format("{}: {}", to_string(report.state), report.reason);
    if (news != told_) progress.message = told_ = news;
    context_.progress(progress);
  }

  const RunContext& context_;
  CameraSource& source_;
  CameraTracker& tracker_;
  const FollowOptions& options_;
  const std::optional<int> total_;
  const Clock::time_point begin_ = Clock::now();
  FollowedCamera followed_;
  std::optional<LiveTracker> live_tracker_;
  int frames_ = 0;
  std::string told_;
};

}  // namespace

FollowedCamera follow_camera(const RunContext& context, CameraSource& source, CameraTracker& tracker,
                             const FollowOptions& options) {
  return Following(context, source, tracker, options).run();
}

}  // namespace alidade
