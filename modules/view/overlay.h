// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace alidade {

/// What a tracker made of a point in this frame; each has its colour in the overlay.
enum class TrackState {
  Tracked,    ///< found and used: green
  Predicted,  ///< expected, not found: amber
  Rejected,   ///< found and refused by a gate: red
  New,        ///< first seen or triangulated now: blue
};

/// Where a point was expected.
struct PredictedPixel {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();           ///< px
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();  ///< of the innovation, px²
};

/// One point of the overlay.
struct OverlayTrack {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< px, where it was found (or expected)
  std::vector<Eigen::Vector2d> tail;                ///< px, where it was before, oldest first
  TrackState state = TrackState::Tracked;
  std::optional<PredictedPixel> predicted;  ///< drawn as an ellipse of three sigma
};

/// All that is drawn on one frame.
struct Overlay {
  std::vector<OverlayTrack> tracks;
  std::string status;  ///< one line in a strip at the bottom; empty: no strip
};

/// A copy of `frame` (CV_8UC1 or CV_8UC3, BGR) with the tracks drawn on it, CV_8UC3 of the same size; what lies outside
/// the frame or is not finite is left out. Needs no display. Throws std::invalid_argument for another type of frame.
cv::Mat draw_overlay(const cv::Mat& frame, const Overlay& overlay);

}  // namespace alidade
