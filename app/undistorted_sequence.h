// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "app/result_directory.h"
#include "app/sequence_writer.h"
#include "camera/camera.h"
#include "core/time.h"
#include "io/video_writer.h"

namespace alidade {

/// Writes undistorted frames as they come: images/NAME with the name of each source image (PNG where the source is
/// neither PNG nor JPEG), or a video; and camera.yaml of the pinhole camera, frames.csv with the times where there are
/// any. Throws DeviceError where the file system refuses.
class UndistortedSequence {
 public:
  UndistortedSequence(const ResultDirectory& directory, const Camera& pinhole, SequenceForm form, double fps_hz);

  /// `name`: of the source's image, without its folder. Throws InputError where an image of that name was written
  /// before.
  void add(const std::string& name, Timestamp time, const cv::Mat& image);

  /// Closes the video and writes camera.yaml and, if `has_times`, frames.csv. Once, and last.
  void finish(bool has_times);

  std::size_t count() const { return times_.size(); }

 private:
  const ResultDirectory& directory_;
  Camera pinhole_;
  std::optional<VideoWriter> video_;
  std::vector<std::string> names_;  // of images, in order
  std::set<std::string> taken_;
  std::vector<Timestamp> times_;
};

}  // namespace alidade
