// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/bundle_priors.h"

#include <cmath>

namespace alidade {
namespace {

// The power of the radius off axis with which a coefficient acts, beyond the first.
int power_of(const Distortion& distortion, int coefficient) {
  if (std::holds_alternative<Fisheye>(distortion)) return 2 * (coefficient + 1);
  constexpr int kPowers[] = {2, 4, 1, 1, 6, 2, 4, 6};
  return kPowers[coefficient];
}

}  // namespace

std::vector<BundlePrior> bundle_priors(const BoardBundle& bundle, const BoardShape& shape,
                                       const BundleFreedom& freedom) {
  const BundleLayout layout(bundle, freedom);
  std::vector<BundlePrior> priors;
  for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
    const Camera& camera = bundle.cameras[i].camera;
    const double radius = 0.5 * std::hypot(camera.width, camera.height) / std::max(camera.fx, 1.0);
    const Intrinsics values = intrinsics(camera);
    const std::vector<int>& free = layout.free_of(static_cast<int>(i));
    for (std::size_t j = 0; j < free.size(); ++j) {
      const int place = free[j];
      if (place < 4) continue;
      const double sigma = std::pow(radius, -power_of(camera.distortion, place - 4));
      priors.push_back(
          {layout.intrinsics_at(static_cast<int>(i)) + static_cast<int>(j), values[place], 1.0 / (sigma * sigma)});
    }
  }
  if (layout.warp) {
    const double sigma = freedom.warp_sigma_share * shape.extent_m;
    priors.push_back({layout.warp_at, bundle.warp.x_m, 1.0 / (sigma * sigma)});
    priors.push_back({layout.warp_at + 1, bundle.warp.y_m, 1.0 / (sigma * sigma)});
  }
  for (std::size_t i = 0; layout.corners && i < bundle.warp.offsets_m.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double sigma = (axis == 2 ? freedom.warp_sigma_share : freedom.corner_sigma_share) * shape.extent_m;
      priors.push_back(
          {layout.corners_at + 3 * static_cast<int>(i) + axis, bundle.warp.offsets_m[i][axis], 1.0 / (sigma * sigma)});
    }
  }
  return priors;
}

Eigen::VectorXd rigid_part(const BoardWarp& warp, const BoardShape& shape) {
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(7);
  for (std::size_t i = 0; i < warp.offsets_m.size(); ++i) {
    moved += shape.rigid_modes.middleRows<3>(3 * static_cast<Eigen::Index>(i)).transpose() * warp.offsets_m[i];
  }
  return moved;
}

double rigid_information(const BoardShape& shape) {
  const double sigma = 1e-6 * shape.extent_m;  // nothing that one would notice, and nothing that spoils the equations
  return 1.0 / (sigma * sigma);
}

}  // namespace alidade
