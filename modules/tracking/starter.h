// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "features/flow.h"
#include "features/matching.h"
#include "geometry/trajectory.h"
#include "reconstruction/two_view.h"
#include "tracking/frame.h"
#include "tracking/live_map.h"

namespace alidade {

struct StarterOptions {
  SiftOptions sift;
  FlowOptions flow;
  TwoViewOptions two_view;
  double ratio = 0.8;                ///< of descriptor distances
  double sigma_px = 1.0;             ///< of a feature
  double least_motion_share = 0.01;  ///< of the image width that the tracks must have moved before geometry is tried
  double least_survivors = 0.3;      ///< of the reference's features still followed; below it the reference moves on
};

/// A map of two keyframes, and the frames between them.
struct StartedMap {
  LiveMap live;
  bool poses_were_given = false;        ///< both keyframes stand where the user said
  std::vector<FrameReport> in_between;  ///< poses of frames that were waiting
};

/// Waits for two images that fix a relative pose, with the reason told while it waits, and makes the first map of them.
class MapStarter {
 public:
  /// `given_poses`: where the user knows the camera to be; if two of the frames have one, the map starts from them.
  MapStarter(Camera camera, StarterOptions options, Trajectory given_poses);

  /// The next image; `flow` is its pyramid. A map once it can be made (the frame is its second keyframe).
  std::optional<StartedMap> add(const ImageFrame& frame, const FlowImage& flow);

  /// Why the last frame did not make a map.
  const std::string& reason() const { return reason_; }

 private:
  struct Waiting {
    FrameReport report;
    std::vector<std::optional<Eigen::Vector2d>> pixels;  // of the reference's features
  };

  void begin(const ImageFrame& frame, const FlowImage& flow);
  void follow(const FlowImage& flow);
  std::vector<PixelPair> followed_pairs(std::vector<int>& features) const;
  double median_motion(const std::vector<PixelPair>& pairs) const;
  std::optional<StartedMap> try_flow(const ImageFrame& frame);
  std::optional<StartedMap> try_descriptors(const ImageFrame& frame);
  StartedMap build(const ImageFrame& frame, Features features, const std::vector<Match>& matches,
                   const TwoViewGeometry& geometry) const;
  std::vector<FrameReport> locate_waiting(const LiveMap& live) const;
  std::optional<Eigen::Isometry3d> given_pose(Timestamp time) const;

  Camera camera_;
  StarterOptions options_;
  Trajectory given_poses_;
  std::string reason_;
  std::optional<ImageFrame> reference_;
  Features reference_features_;
  FlowImage previous_;
  std::vector<std::optional<Eigen::Vector2d>> tracks_;  // where the reference's features are now
  std::vector<Waiting> waiting_;
};

}  // namespace alidade
