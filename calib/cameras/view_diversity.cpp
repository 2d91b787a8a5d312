// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/view_diversity.h"

#include <algorithm>
#include <cmath>

namespace alidade {
namespace {

bool show_the_same(const BundleView& a, const BundleView& b, double distance_px) {
  if (a.camera != b.camera) return false;
  const CommonMotion motion = common_motion(a.corners, b.corners);
  const auto smaller = static_cast<double>(std::min(a.corners.size(), b.corners.size()));
  return motion.corners > 0 && motion.corners >= 0.8 * smaller && motion.rms_px < distance_px;
}

}  // namespace

CommonMotion common_motion(std::span<const BoardCorner> from, std::span<const BoardCorner> to) {
  CommonMotion motion;
  double sum = 0;
  for (auto i = from.begin(), j = to.begin(); i != from.end() && j != to.end();) {
    if (i->id < j->id) {
      ++i;
    } else if (j->id < i->id) {
      ++j;
    } else {
      sum += (i++->pixel - j++->pixel).squaredNorm();
      ++motion.corners;
    }
  }
  if (motion.corners > 0) motion.rms_px = std::sqrt(sum / motion.corners);
  return motion;
}

std::vector<int> find_repeated_views(std::span<const BundleView> views, double distance_px) {
  std::vector<int> earlier(views.size(), -1);
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = 0; j < i && earlier[i] < 0; ++j) {
      if (earlier[j] < 0 && show_the_same(views[j], views[i], distance_px)) earlier[i] = static_cast<int>(j);
    }
  }
  return earlier;
}

double tilt_spread_rad(const BoardBundle& bundle, std::span<const BundleView> views, int index) {
  const Eigen::Matrix3d R_camera_rig =
      bundle.cameras[static_cast<std::size_t>(index)].T_rig_camera.linear().transpose();
  std::vector<Eigen::Vector3d> normals;
  for (const BundleView& view : views) {
    if (view.camera != index || std::none_of(view.weights.begin(), view.weights.end(), [](double w) { return w > 0; }))
      continue;
    normals.push_back(R_camera_rig * bundle.T_rig_board[static_cast<std::size_t>(view.frame)].linear().col(2));
  }
  double widest = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      widest = std::max(widest, std::acos(std::clamp(normals[i].dot(normals[j]), -1.0, 1.0)));
    }
  }
  return widest;
}

}  // namespace alidade
