// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/bundle/bundle_fit.h"

namespace alidade {

/// How sure a fit is of what all moments share, and of a common motion of all boards: the frames' mean, seen from the
/// rig, xi = (u, w) that moves a point p_rig by u + w × p_rig. It stands for where "the rig" is: intrinsics that trade
/// against it move no pixel. Source: mrcal, "mean-pcam" projection uncertainty, in closed form.
struct BundleCovariance {
  Eigen::MatrixXd shared_and_motion;  ///< order: the shared parameters of BundleLayout, then u (m) and w (rad)
  double sigma = 1;                   ///< of one coordinate in units of the corners' sigma_px, from the residuals
  double left_out = 1;  ///< by how much errors on views left out enlarge them beside that, >= 1 (see calibrate_camera)
  double within_views = 1;  ///< by how much errors that go together within a view enlarge variances, >= 1
};

/// Of a fit with this freedom. Empty where the views do not determine the parameters.
std::optional<BundleCovariance> bundle_covariance(const BundleFit& fit, const BoardShape& shape,
                                                  const BundleFreedom& freedom);

/// Standard deviations of the free intrinsics of a camera, in their order in BundleFreedom.
Eigen::VectorXd intrinsics_sigma(const BundleCovariance& covariance, const BundleLayout& layout, int camera);

/// Covariance of all of intrinsics() of a camera; rows and columns of those that were held are 0.
Eigen::MatrixXd intrinsics_covariance(const BundleCovariance& covariance, const BundleLayout& layout,
                                      const Camera& camera, int index);

}  // namespace alidade
