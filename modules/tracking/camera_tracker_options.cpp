// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_tracker_options.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

void require(bool holds, const char* field, double value, const char* bound) {
  if (!holds) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

}  // namespace

int suggested_feature_count(const Camera& camera) {
  return std::clamp(camera.width * camera.height / 100, 1000, 6000);
}

void validate(const CameraTrackerOptions& o) {
  require(o.sigma_px > 0, "sigma_px", o.sigma_px, "> 0 px");
  require(o.sift.most >= 50, "sift.most", o.sift.most, ">= 50");
  require(o.least_inliers >= 6, "least_inliers", o.least_inliers, ">= 6");
  require(o.slam_points >= 6, "slam_points", o.slam_points, ">= 6");
  require(o.most_tracks >= o.least_inliers, "most_tracks", o.most_tracks, ">= least_inliers");
  require(o.window >= 2, "window", o.window, ">= 2 keyframes");
  require(o.keyframe_share > 0 && o.keyframe_share <= 1, "keyframe_share", o.keyframe_share, "in (0, 1]");
  require(o.start.two_view.least_parallax_deg > 0, "start.two_view.least_parallax_deg",
          o.start.two_view.least_parallax_deg, "> 0 deg");
}

}  // namespace alidade
