// SPDX-License-Identifier: Apache-2.0
#include "app/sequence_writer.h"

#include <stdexcept>

#include <fmt/format.h>

#include "core/time.h"
#include "io/camera_file.h"
#include "io/image_files.h"
#include "io/table.h"
#include "io/trajectory_file.h"

namespace alidade {
namespace {

constexpr double kDepthSteps_per_m = 5000.0;  // TUM's; 13.1 m fit into 16 bits

std::string file_name(const char* folder, std::size_t index) {
  return fmt::format("{}/{:06d}.png", folder, index);
}

VideoOptions video_options(SequenceForm form, double fps_hz) {
  VideoOptions options;
  options.kind = form == SequenceForm::Movie ? VideoKind::Movie : VideoKind::Lossless;
  options.fps_hz = fps_hz;
  return options;
}

}  // namespace

SequenceWriter::SequenceWriter(const ResultDirectory& directory, const Camera& camera, SequenceForm form, double fps_hz)
    : directory_(directory), camera_(camera), form_(form) {
  if (form == SequenceForm::Images) return;
  const char* name = form == SequenceForm::Movie ? "video.mp4" : "video.mkv";
  video_.emplace(directory.path(name), cv::Size(camera.width, camera.height), video_options(form, fps_hz));
}

void SequenceWriter::add(const cv::Mat& frame, const StampedPose& pose, const std::optional<cv::Mat>& depth_m) {
  if (truth_.empty()) with_depth_ = depth_m.has_value();
  if (depth_m.has_value() != with_depth_) throw std::invalid_argument("SequenceWriter: depth for all frames or none");
  if (with_depth_ && video_) throw std::invalid_argument("SequenceWriter: depth goes with images");
  if (video_) {
    video_->write(frame);
  } else {
    write_image(directory_.path(file_name("images", truth_.size())), frame);
  }
  if (depth_m) {
    cv::Mat steps;
    depth_m->convertTo(steps, CV_16UC1, kDepthSteps_per_m);
    write_image(directory_.path(file_name("depth", truth_.size())), steps);
  }
  truth_.push_back(pose);
}

void SequenceWriter::finish() {
  if (video_) video_->close();
  write_camera(directory_.path("camera.yaml"), camera_);
  write_trajectory_tum(directory_.path("truth.tum"), truth_);
  write_lists();
}

void SequenceWriter::write_lists() const {
  std::vector<std::string_view> columns{"index", "t_ns"};
  if (!video_) columns.emplace_back("image");
  TableWriter frames(directory_.path("frames.csv"), columns);
  std::string rgb, depth;
  for (std::size_t i = 0; i < truth_.size(); ++i) {
    const Timestamp time = truth_[i].time;
    std::vector<TableCell> row{static_cast<std::int64_t>(i), std::int64_t{time.time_since_epoch().count()}};
    if (!video_) row.emplace_back(file_name("images", i));
    frames.write_row(row);
    rgb += fmt::format("{} {}\n", format_seconds(time), file_name("images", i));
    depth += fmt::format("{} {}\n", format_seconds(time), file_name("depth", i));
  }
  frames.commit();
  if (!with_depth_) return;
  directory_.write_text("rgb.txt", rgb);
  directory_.write_text("depth.txt", depth);
  write_trajectory_tum(directory_.path("groundtruth.txt"), truth_);
  write_camera(directory_.path("camera.txt"), camera_);
}

}  // namespace alidade
