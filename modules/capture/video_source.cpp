// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "capture/file_sources.h"
#include "capture/frame_queue.h"
#include "core/errors.h"
#include "io/video_reader.h"

namespace alidade {
namespace {

class Video : public FrameSource {
 public:
  // One frame is held back: the first tells whether the stream has times.
  Video(const std::filesystem::path& path, std::optional<double> fps_hz)
      : path_(path), reader_(path), fps_hz_(fps_hz), pending_(reader_.next()) {
    stream_has_times_ = pending_ && pending_->time;
    if (!pending_) throw InputError(path, 0, "holds no frame that can be read", "record it again");
  }

  std::optional<Frame> next(std::stop_token) override {
    if (!pending_) return std::nullopt;
    const int index = next_index_++;
    Frame frame{index, time_of(index), fmt::format("{}#{}", path_.filename().string(), index),
                std::move(pending_->image)};
    pending_ = reader_.next();
    last_time_ = frame.time;
    return frame;
  }

  std::optional<int> frame_count() const override { return reader_.facts().frame_count; }
  bool has_times() const override { return stream_has_times_ || fps_hz_; }
  std::optional<std::string> fault() const override { return reader_.fault(); }
  std::string describe() const override {
    const VideoFacts& facts = reader_.facts();
    return fmt::format("video {} ({}, {}x{} px)", path_.string(), facts.codec, facts.width, facts.height);
  }

 private:
  Timestamp time_of(int index) const {
    if (!stream_has_times_) return Timestamp(from_seconds(index / fps_hz_.value_or(1.0)));
    if (!pending_->time || (last_time_ && *pending_->time <= *last_time_)) {
      throw InputError(path_, 0, fmt::format("the time of frame {} does not increase", index),
                       "convert the video to a constant frame rate");
    }
    return *pending_->time;
  }

  std::filesystem::path path_;
  VideoReader reader_;
  std::optional<double> fps_hz_;
  std::optional<VideoFrame> pending_;
  bool stream_has_times_ = false;
  std::optional<Timestamp> last_time_;
  int next_index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_video(const std::filesystem::path& path, std::optional<double> fps_hz) {
  if (fps_hz && !(*fps_hz > 0 && std::isfinite(*fps_hz))) throw std::invalid_argument("open_video: fps_hz must be > 0");
  return queued(std::make_unique<Video>(path, fps_hz));
}

}  // namespace alidade
