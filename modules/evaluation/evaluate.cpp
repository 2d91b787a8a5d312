// SPDX-License-Identifier: Apache-2.0
#include "evaluation/evaluate.h"

#include <vector>

namespace alidade {
namespace {

std::vector<Eigen::Vector3d> centres(const Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> points;
  for (const StampedPose& pose : trajectory) points.emplace_back(pose.T_world_camera.translation());
  return points;
}

}  // namespace

std::optional<Evaluation> evaluate(const PairedTrajectories& pairs, const EvaluationOptions& options) {
  const auto alignment = align_points(centres(pairs.estimate), centres(pairs.truth), options.alignment);
  if (!alignment) return std::nullopt;
  Evaluation evaluation;
  evaluation.alignment = *alignment;
  evaluation.pairs = {transform(*alignment, pairs.estimate), pairs.truth};
  evaluation.absolute = absolute_errors(evaluation.pairs);
  evaluation.relative = relative_errors(evaluation.pairs, options.step);
  evaluation.path = path_errors(evaluation.pairs);
  evaluation.consistency = consistency(evaluation.pairs);
  return evaluation;
}

}  // namespace alidade
