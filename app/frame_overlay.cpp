// SPDX-License-Identifier: Apache-2.0
#include "app/frame_overlay.h"

#include <algorithm>

#include <fmt/format.h>

#include "view/overlay.h"

namespace alidade {
namespace {

constexpr std::size_t kTail = 8;  // frames of a track that its tail shows
constexpr int kSamples = 6;       // pictures in the report

std::string status_line(const FrameReport& report) {
  const auto inliers =
      std::count_if(report.sightings.begin(), report.sightings.end(), [](const auto& s) { return s.is_inlier; });
  std::string line = fmt::format("frame {}  {}", report.index, to_string(report.state));
  if (inliers > 0) line += fmt::format("  {} points", inliers);
  if (report.is_keyframe) line += "  keyframe";
  if (!report.reason.empty()) line += "  " + report.reason;
  return line;
}

}  // namespace

OverlayMovie::OverlayMovie(std::filesystem::path path, double fps_hz, std::optional<int> frame_count)
    : path_(std::move(path)), sample_every_(std::max(1, frame_count.value_or(300) / kSamples)) {
  options_.fps_hz = fps_hz;
}

void OverlayMovie::add(const ImageFrame& frame, const FrameReport& report) {
  Overlay overlay;
  overlay.status = status_line(report);
  std::unordered_map<int, std::vector<Eigen::Vector2d>> tails;
  for (std::size_t i = 0; i < report.sightings.size(); ++i) {
    const FrameSighting& s = report.sightings[i];
    std::vector<Eigen::Vector2d>& tail = tails_[s.point];
    OverlayTrack track{s.pixel, tail, s.is_inlier ? TrackState::Tracked : TrackState::Rejected, std::nullopt};
    if (tail.empty()) track.state = s.is_inlier ? TrackState::New : TrackState::Rejected;
    if (i < report.expectations.size()) {
      track.predicted = PredictedPixel{report.expectations[i].pixel, report.expectations[i].covariance};
    }
    overlay.tracks.push_back(std::move(track));
    tail.push_back(s.pixel);
    if (tail.size() > kTail) tail.erase(tail.begin());
    tails[s.point] = std::move(tail);
  }
  tails_ = std::move(tails);  // points that were not seen start anew
  const cv::Mat picture = draw_overlay(frame.colour.empty() ? frame.grey : frame.colour, overlay);
  if (!writer_) writer_.emplace(path_, picture.size(), options_);
  writer_->write(picture);
  if (frame.index % sample_every_ == sample_every_ - 1 && static_cast<int>(samples_.size()) < kSamples) {
    samples_.push_back({frame.index, picture});
  }
}

std::vector<OverlaySample> OverlayMovie::close() {
  if (writer_) writer_->close();
  return std::move(samples_);
}

}  // namespace alidade
