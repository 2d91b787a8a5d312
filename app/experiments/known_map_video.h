// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/camera_source.h"
#include "app/experiments/experiment_section.h"
#include "evaluation/truth_covariance.h"
#include "tracking/camera_tracker_options.h"
#include "tracking/posed_map.h"

namespace alidade {

/// A map made of single frames of a video at their true poses, and what those say of the truth itself.
struct KnownMap {
  PointMap map;
  std::vector<int> frames;                      ///< of the video, that the map is made of
  std::vector<MotionResidual> truth_residuals;  ///< between neighbouring ones, by their images and depths alone
};

struct KnownMapOptions {
  int frames_between = 9;  ///< from one frame of the map to the next, at least
  PosedMapOptions map;
  CameraTrackerOptions tracker;
};

/// With as many features per image as its size suggests.
KnownMapOptions known_map_options(const Camera& camera);

/// A frame that is not in the map, as the tracker found it.
struct LocalisedFrame {
  FrameReport report;
  Eigen::Isometry3d T_world_camera_true = Eigen::Isometry3d::Identity();
  /// All that the tracker had found before its gate, sigma_px 1; of a frame that it lost, all matches by descriptor.
  std::vector<PointObservation> matches;
};

/// Opens a recording with depth and truth; throws InputError where it is not one.
CameraSource open_depth_video(const std::filesystem::path& folder);

/// The map from frames with depth, in order.
KnownMap make_known_map(CameraSource source, const KnownMapOptions& options, const ExperimentContext& context);

/// Tracks the other frames, the map's being passed over: those with truth are returned.
std::vector<LocalisedFrame> localise_video(CameraSource source, const KnownMap& known, const KnownMapOptions& options,
                                           const ExperimentContext& context);

}  // namespace alidade
