// SPDX-License-Identifier: Apache-2.0
#include "app/targets/video_sky.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/frame_sources.h"
#include "core/errors.h"
#include "uav/video/moving_objects.h"

namespace alidade {
namespace {

// One camera's images, and what moves in them.
class Watcher {
 public:
  Watcher(const std::string& source, const Receiver& receiver, const std::stop_token& stop)
      : source_(source), receiver_(receiver), frames_(open_frames(source, {}, {})) {
    if (!receiver.camera) {
      throw InputError(source, 0, fmt::format("receiver '{}' is a direction finder", receiver.name),
                       "videos go with cameras; give the others' bearings as a table");
    }
    if (!frames_->has_times()) throw InputError(source, 0, "its images have no times", "give a video or a recording");
    frame_ = frames_->next(stop);
    check_size();
  }

  bool has_frame() const { return frame_.has_value(); }
  Timestamp next_time() const { return common_time(receiver_.clock, frame_->time); }
  std::optional<int> frame_count() const { return frames_->frame_count(); }
  const Receiver& receiver() const { return receiver_; }

  // Looks at the frame that is next, and fetches the one after it.
  std::vector<ReceiverReading> look(const std::stop_token& stop) {
    const std::vector<ReceiverReading> readings =
        readings_of(detector_.detect(frame_->image, frame_->time), receiver_.id, frame_->time);
    const Timestamp time = frame_->time;
    frame_ = frames_->next(stop);
    if (frame_) interval_s_ = to_seconds(frame_->time - time);
    return readings;
  }

  double interval_s() const { return interval_s_; }

  std::optional<std::string> loss() const {
    const auto fault = frames_->fault();
    if (!fault) return std::nullopt;
    return fault->find(source_) == std::string::npos ? source_ + ": " + *fault : *fault;
  }

 private:
  void check_size() const {
    if (!frame_) return;
    const Camera& camera = *receiver_.camera;
    if (frame_->image.cols == camera.width && frame_->image.rows == camera.height) return;
    throw InputError(source_, 0,
                     fmt::format("images are {}x{} px, those of receiver '{}' {}x{}", frame_->image.cols,
                                 frame_->image.rows, receiver_.name, camera.width, camera.height),
                     "give the videos in the order of the receivers, unscaled");
  }

  std::string source_;
  Receiver receiver_;
  std::unique_ptr<FrameSource> frames_;
  MovingObjectDetector detector_;
  std::optional<Frame> frame_;
  double interval_s_ = 0.0;
};

class VideoSky : public SkySource {
 public:
  VideoSky(const std::vector<std::string>& sources, std::span<const Receiver> receivers, ReadingSink found,
           std::stop_token stop)
      : found_(std::move(found)), stop_(std::move(stop)) {
    for (std::size_t i = 0; i < sources.size(); ++i) watchers_.emplace_back(sources[i], receivers[i], stop_);
    for (const Watcher& watcher : watchers_) total_ += watcher.frame_count().value_or(0);
    for (Watcher& watcher : watchers_) {
      if (watcher.has_frame()) look(watcher);  // two frames tell how fast they come
    }
  }

  std::optional<Bearing> next() override {
    while (waiting_.empty()) {
      Watcher* first = nullptr;
      for (Watcher& watcher : watchers_) {
        if (watcher.has_frame() && (!first || watcher.next_time() < first->next_time())) first = &watcher;
      }
      if (!first || stop_.stop_requested()) return std::nullopt;
      look(*first);
    }
    const Bearing bearing = waiting_.front();
    waiting_.pop_front();
    return bearing;
  }

  Progress progress() const override { return {"watching (frames)", done_, total_, ""}; }
  std::int64_t without_direction() const override { return without_direction_; }

  std::vector<std::string> losses() const override {
    std::vector<std::string> losses;
    for (const Watcher& watcher : watchers_) {
      if (const auto loss = watcher.loss()) losses.push_back(*loss);
    }
    return losses;
  }

  std::optional<double> frame_interval_s() const override {
    double longest = 0.0;
    for (const Watcher& watcher : watchers_) longest = std::max(longest, watcher.interval_s());
    if (longest <= 0.0) return std::nullopt;
    return longest;
  }

 private:
  void look(Watcher& watcher) {
    ++done_;
    for (const ReceiverReading& reading : watcher.look(stop_)) {
      if (found_) found_(reading);
      if (const auto bearing = bearing_of(watcher.receiver(), reading)) {
        waiting_.push_back(*bearing);
      } else {
        ++without_direction_;
      }
    }
  }

  std::deque<Watcher> watchers_;
  ReadingSink found_;
  std::stop_token stop_;
  std::deque<Bearing> waiting_;
  std::int64_t done_ = 0, total_ = 0, without_direction_ = 0;
};

}  // namespace

bool shows_images(const std::string& source) {
  if (source == "-") return false;
  const std::filesystem::path path(source);
  if (std::filesystem::is_directory(path)) return !std::filesystem::exists(path / "receivers.yaml");
  const std::string extension = path.extension().string();
  return extension != ".csv" && extension != ".txt";
}

std::vector<std::string> videos_in(const std::string& folder, std::span<const Receiver> receivers) {
  const std::filesystem::path path(folder);
  if (!std::filesystem::is_directory(path) || std::filesystem::exists(path / "observations.csv")) return {};
  std::vector<std::string> videos;
  for (const Receiver& receiver : receivers) {
    for (const char* extension : {".mkv", ".mp4"}) {
      const std::filesystem::path video = path / (receiver.name + extension);
      if (!std::filesystem::exists(video)) continue;
      videos.push_back(video.string());
      break;
    }
  }
  if (videos.size() != receivers.size()) return {};
  return videos;
}

std::unique_ptr<SkySource> open_videos(const std::vector<std::string>& sources, std::span<const Receiver> receivers,
                                       ReadingSink found, std::stop_token stop) {
  if (sources.size() != receivers.size()) {
    throw InputError(
        sources.front(), 0,
        fmt::format("{} video{} for {} receivers", sources.size(), sources.size() == 1 ? "" : "s", receivers.size()),
        "give one for each receiver, in the order of their file");
  }
  return std::make_unique<VideoSky>(sources, receivers, std::move(found), std::move(stop));
}

}  // namespace alidade
