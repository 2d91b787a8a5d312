// SPDX-License-Identifier: Apache-2.0
#include "tracking/pose_method.h"

#include <vector>

#include <Eigen/LU>

#include "reconstruction/resection.h"
#include "tracking/paper_filter.h"
#include "tracking/unscented_filter.h"

namespace alidade {
namespace {

PosePrior prior_of(const MotionState& predicted, bool use_prior) {
  PosePrior prior;
  prior.T_world_camera = predicted.T_world_body;
  if (use_prior) prior.information = predicted.covariance.topLeftCorner<6, 6>().inverse();
  return prior;
}

std::vector<PointObservation> inliers_of(std::span<const PointObservation> observations, const PoseUpdate& update) {
  std::vector<PointObservation> inliers;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (update.is_inlier[i]) inliers.push_back(observations[i]);
  }
  return inliers;
}

std::optional<PoseUpdate> from_frame_alone(PnpMethod method, const Camera& camera,
                                           std::span<const PointObservation> inliers, PoseUpdate update) {
  const auto T = solve_pnp(camera, inliers, method);
  if (!T) return std::nullopt;
  const auto covariance = resection_covariance(camera, *T, inliers);
  if (!covariance) return std::nullopt;
  update.T_world_camera = *T;
  update.covariance = *covariance;
  update.sightings = {*T, covariance->inverse(), Vector6d::Zero()};
  return update;
}

std::optional<PoseUpdate> from_filter(const MotionState& state, PoseUpdate update) {
  if (!state.T_world_body.matrix().allFinite()) return std::nullopt;
  update.T_world_camera = state.T_world_body;
  update.covariance = state.covariance.topLeftCorner<6, 6>();
  return update;
}

}  // namespace

std::optional<PoseUpdate> estimate_pose(PoseMethod method, const Camera& camera, const MotionState& predicted,
                                        std::span<const PointObservation> observations,
                                        const PoseUpdateOptions& options, bool use_prior) {
  auto update = update_pose(camera, prior_of(predicted, use_prior), observations, options);
  if (!update || method == PoseMethod::Ekf || method == PoseMethod::EkfSlam) return update;
  const std::vector<PointObservation> inliers = inliers_of(observations, *update);
  switch (method) {
    case PoseMethod::EkfPaper:
      return from_filter(update_paper_filter(camera, predicted, inliers), std::move(*update));
    case PoseMethod::Ukf:
      return from_filter(update_unscented_filter(camera, predicted, inliers), std::move(*update));
    case PoseMethod::Epnp:
      return from_frame_alone(PnpMethod::Epnp, camera, inliers, std::move(*update));
    case PoseMethod::EpnpLm:
      return from_frame_alone(PnpMethod::EpnpLm, camera, inliers, std::move(*update));
    case PoseMethod::Sqpnp:
      return from_frame_alone(PnpMethod::Sqpnp, camera, inliers, std::move(*update));
    case PoseMethod::Ekf:
    case PoseMethod::EkfSlam:
      break;
  }
  return update;
}

}  // namespace alidade
