// SPDX-License-Identifier: Apache-2.0
#include "calib/rigs/pair_error.h"

#include <cmath>

#include "geometry/rotation.h"

namespace alidade {
namespace {

// Distance in px from the second camera's pixel to the epipolar line of the first one's ray, by the focal length.
std::optional<double> epipolar_px(const BundleCamera& first, const Eigen::Vector2d& in_first,
                                  const BundleCamera& second, const Eigen::Vector2d& in_second) {
  const auto a = unproject(first.camera, in_first), b = unproject(second.camera, in_second);
  if (!a || !b || !(b->z() > 0.05)) return std::nullopt;
  const Eigen::Isometry3d T_second_first = second.T_rig_camera.inverse() * first.T_rig_camera;
  const Eigen::Vector3d line = T_second_first.translation().cross(T_second_first.linear() * *a);
  const double scale = line.head<2>().norm();
  if (!(scale > 0)) return std::nullopt;
  return std::abs(line.dot(*b / b->z())) / scale * second.camera.fx;
}

struct Squares {
  double sum = 0;
  int count = 0;
};

void add_view(const BundleFit& fit, const BundleView& a, const BundleView& b, Squares& squares) {
  const BundleCamera& first = fit.bundle.cameras[static_cast<std::size_t>(a.camera)];
  const BundleCamera& second = fit.bundle.cameras[static_cast<std::size_t>(b.camera)];
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    for (std::size_t j = 0; j < b.corners.size(); ++j) {
      if (a.corners[i].id != b.corners[j].id || a.weights[i] <= 0 || b.weights[j] <= 0) continue;
      const auto there = epipolar_px(first, a.corners[i].pixel, second, b.corners[j].pixel);
      const auto back = epipolar_px(second, b.corners[j].pixel, first, a.corners[i].pixel);
      if (!there || !back) continue;
      squares.sum += 0.5 * (*there * *there + *back * *back);
      ++squares.count;
    }
  }
}

// The baseline's direction in each camera's own axes, by the poses' xi; the first camera of the rig stands.
double baseline_sigma(const BundleFit& fit, const BundleFreedom& freedom, const BundleCovariance& covariance, int first,
                      int second, const Eigen::Vector3d& direction_rig) {
  const BundleLayout layout(fit.bundle, freedom);
  Eigen::RowVectorXd J = Eigen::RowVectorXd::Zero(covariance.shared_and_motion.cols());
  for (const auto& [camera, sign] : {std::pair{first, -1.0}, std::pair{second, 1.0}}) {
    if (camera == 0 || !layout.camera_poses) continue;
    const auto& R = fit.bundle.cameras[static_cast<std::size_t>(camera)].T_rig_camera.linear();
    J.segment<3>(layout.pose_at(camera)) = sign * direction_rig.transpose() * R;
  }
  return std::sqrt((J * covariance.shared_and_motion * J.transpose())(0, 0));
}

}  // namespace

std::optional<PairError> pair_error(const BundleFit& fit, const BundleFreedom& freedom,
                                    const BundleCovariance& covariance, int first, int second) {
  Squares squares;
  for (const BundleView& a : fit.views) {
    if (a.camera != first) continue;
    for (const BundleView& b : fit.views) {
      if (b.camera == second && b.frame == a.frame) add_view(fit, a, b, squares);
    }
  }
  const auto centre = [&](int camera) {
    return fit.bundle.cameras[static_cast<std::size_t>(camera)].T_rig_camera.translation();
  };
  const Eigen::Vector3d baseline = centre(second) - centre(first);
  if (squares.count == 0 || !(baseline.norm() > 0)) return std::nullopt;
  PairError error{first, second, squares.count, std::sqrt(squares.sum / squares.count), baseline.norm(), 0.0};
  error.baseline_sigma_m = baseline_sigma(fit, freedom, covariance, first, second, baseline.normalized());
  return error;
}

}  // namespace alidade
