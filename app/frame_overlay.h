// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <unordered_map>

#include "app/track_record.h"
#include "io/video_writer.h"
#include "tracking/frame.h"

namespace alidade {

/// Draws what the tracker saw on every frame into a movie, and keeps a few of the pictures for the report.
class OverlayMovie {
 public:
  /// `frame_count`: in all, where known, to spread the pictures that are kept.
  OverlayMovie(std::filesystem::path path, double fps_hz, std::optional<int> frame_count);

  void add(const ImageFrame& frame, const FrameReport& report);

  /// Closes the movie and hands over the pictures kept.
  std::vector<OverlaySample> close();

 private:
  std::filesystem::path path_;
  VideoOptions options_;
  int sample_every_;
  std::optional<VideoWriter> writer_;
  std::unordered_map<int, std::vector<Eigen::Vector2d>> tails_;  // recent pixels of each point
  std::vector<OverlaySample> samples_;
};

}  // namespace alidade
