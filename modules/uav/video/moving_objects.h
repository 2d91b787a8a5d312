// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "camera/measurement.h"
#include "core/time.h"
#include "uav/video/background_model.h"
#include "uav/video/dot_filter.h"
#include "uav/video/dot_fit.h"
#include "uav/video/image_stabiliser.h"
#include "uav/video/short_tracks.h"

namespace alidade {

/// A small moving object in a frame.
struct MovingObject {
  /// Its centre, px, where the camera would show it if it did not sway: in the mean view of the frames so far.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();   ///< of pixel, px²
  Eigen::Vector2d frame_pixel = Eigen::Vector2d::Zero();  ///< its centre in this frame
  double size_px = 0.0;  ///< diameter of the disc that looks like it, the lens' blur taken off; 0: a point
  double snr = 0.0;      ///< the dot's height over the noise of a pixel; dark: negative
};

/// Options of MovingObjectDetector.
struct MovingObjectOptions {
  bool is_swaying = true;  ///< the camera's: what stands still is followed (a third of the time)
  StabiliserOptions stabiliser;
  BackgroundOptions background;
  DotFilterOptions filter;
  DotFitOptions fit;
  ShortTrackOptions tracks;
  int warm_up_frames = 30;    ///< in which background and noise are learnt and nothing is reported
  double lens_blur_px = 0.5;  ///< standard deviation of a point's image; of a good lens in focus
  /// What a centre errs by beside noise, standard deviation of each coordinate: stabilisation, and dots that are not
  /// Gaussian.
  double systematic_px = 0.03;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const MovingObjectOptions& options);

/// Finds small objects (2 to 6 px) that move before sky or ground, in the frames of one camera that stands. Frame by
/// frame: take out the camera's swaying, take off the learnt background, filter for dots, keep those that move on, and
/// fit their centres. Objects that stay within a pixel or two for a second become background.
class MovingObjectDetector {
 public:
  explicit MovingObjectDetector(const MovingObjectOptions& options = {});

  /// The moving objects of the next frame, an image of 8 bits, grey or BGR, in order of rows. Empty while warming up.
  /// Throws std::invalid_argument for another type, another size than the first frame's, and a time that is not after
  /// the last one's.
  std::vector<MovingObject> detect(const cv::Mat& image, Timestamp time);

 private:
  std::optional<MovingObject> fit(const cv::Mat& residual, const DotPeak& peak,
                                  const Eigen::Isometry2d& T_image_first) const;

  MovingObjectOptions options_;
  ImageStabiliser stabiliser_;
  BackgroundModel background_;
  DotFilter filter_;
  ShortTracks tracks_;
  int frames_ = 0;
};

/// The readings of a frame taken at `time` by the clock of the receiver whose id this is.
std::vector<ReceiverReading> readings_of(std::span<const MovingObject> objects, int receiver, Timestamp time);

}  // namespace alidade
