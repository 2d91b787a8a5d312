// SPDX-License-Identifier: Apache-2.0
#include "app/undistorted_sequence.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "io/camera_file.h"
#include "io/image_files.h"
#include "io/table.h"

namespace alidade {
namespace {

std::string output_name(const std::filesystem::path& name) {
  const bool can_be_written = name.extension() == ".png" || name.extension() == ".jpg" || name.extension() == ".jpeg";
  return can_be_written ? name.string() : std::filesystem::path(name).replace_extension(".png").string();
}

}  // namespace

UndistortedSequence::UndistortedSequence(const ResultDirectory& directory, const Camera& pinhole, SequenceForm form,
                                         double fps_hz)
    : directory_(directory), pinhole_(pinhole) {
  if (form == SequenceForm::Images) return;
  VideoOptions options;
  options.kind = form == SequenceForm::Movie ? VideoKind::Movie : VideoKind::Lossless;
  options.fps_hz = fps_hz;
  const char* name = form == SequenceForm::Movie ? "video.mp4" : "video.mkv";
  video_.emplace(directory.path(name), cv::Size(pinhole.width, pinhole.height), options);
}

void UndistortedSequence::add(const std::string& name, Timestamp time, const cv::Mat& image) {
  if (video_) {
    video_->write(image);
  } else {
    const std::string file = output_name(name);
    if (!taken_.insert(file).second) {
      throw InputError(name, 0, "two images have this name", "undistort their folders one by one");
    }
    write_image(directory_.path("images/" + file), image);
    names_.push_back("images/" + file);
  }
  times_.push_back(time);
}

void UndistortedSequence::finish(bool has_times) {
  if (video_) video_->close();
  write_camera(directory_.path("camera.yaml"), pinhole_, "undistorted");
  if (!has_times) return;
  std::vector<std::string_view> columns{"index", "t_ns"};
  if (!video_) columns.emplace_back("image");
  TableWriter frames(directory_.path("frames.csv"), columns);
  for (std::size_t i = 0; i < times_.size(); ++i) {
    std::vector<TableCell> row{static_cast<std::int64_t>(i), std::int64_t{times_[i].time_since_epoch().count()}};
    if (!video_) row.emplace_back(names_[i]);
    frames.write_row(row);
  }
  frames.commit();
}

}  // namespace alidade
