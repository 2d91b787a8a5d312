// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "app/result_directory.h"
#include "camera/camera.h"
#include "geometry/trajectory.h"
#include "io/video_writer.h"

namespace alidade {

/// How the frames of a sequence are kept.
enum class SequenceForm {
  Images,    ///< images/000000.png, ...
  Movie,     ///< video.mp4
  Lossless,  ///< video.mkv
};

/// Writes frames with their truth as they come: images or a video, frames.csv (index, t_ns and, for images, image),
/// truth.tum and camera.yaml. With depth images also depth/ (16 bits, 5000 = 1 m) and the lists rgb.txt, depth.txt,
/// groundtruth.txt and camera.txt that make the directory a data set in the form of TUM's RGB-D benchmark.
/// Throws DeviceError where the file system refuses.
class SequenceWriter {
 public:
  SequenceWriter(const ResultDirectory& directory, const Camera& camera, SequenceForm form, double fps_hz);

  /// `depth_m`: CV_32FC1, 0 where there is nothing; for every frame or for none, and with images only
  /// (std::invalid_argument).
  void add(const cv::Mat& frame, const StampedPose& pose, const std::optional<cv::Mat>& depth_m);

  /// Writes the lists and closes the video. Once, and last; what was added until then is a whole, shorter sequence.
  void finish();

  const Trajectory& truth() const { return truth_; }

 private:
  void write_lists() const;

  const ResultDirectory& directory_;
  Camera camera_;
  SequenceForm form_;
  std::optional<VideoWriter> video_;
  Trajectory truth_;
  bool with_depth_ = false;
};

}  // namespace alidade
