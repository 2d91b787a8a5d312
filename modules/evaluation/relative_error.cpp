// SPDX-License-Identifier: Apache-2.0
#include "evaluation/relative_error.h"

#include <numbers>
#include <stdexcept>
#include <utility>

namespace alidade {
namespace {

// Where each pose stands on the scale that the step is measured on.
std::vector<double> milestones(const Trajectory& truth, const Step& step) {
  std::vector<double> at;
  double along_m = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0) along_m += (truth[i].T_world_camera.translation() - truth[i - 1].T_world_camera.translation()).norm();
    if (std::holds_alternative<FrameStep>(step)) at.push_back(static_cast<double>(i));
    if (std::holds_alternative<PathStep>(step)) at.push_back(along_m);
    if (std::holds_alternative<TimeStep>(step)) at.push_back(to_seconds(truth[i].time - truth[0].time));
  }
  return at;
}

double length_of(const Step& step) {
  if (const auto* frames = std::get_if<FrameStep>(&step)) return static_cast<double>(frames->frames);
  if (const auto* path = std::get_if<PathStep>(&step)) return path->metres;
  return std::get<TimeStep>(step).seconds;
}

}  // namespace

std::vector<PoseSpan> spans(const Trajectory& truth, const Step& step) {
  const double length = length_of(step);
  if (!(length > 0)) throw std::invalid_argument("spans: the step must be > 0");
  const double rounding = 1e-9 * length;
  const std::vector<double> at = milestones(truth, step);
  std::vector<PoseSpan> result;
  std::size_t last = 0;
  for (std::size_t first = 0; first < at.size(); ++first) {
    while (last < at.size() && at[last] - at[first] < length - rounding) ++last;
    if (last == at.size()) break;
    result.push_back({first, last});
  }
  return result;
}

RelativeErrors relative_errors(const PairedTrajectories& pairs, const Step& step) {
  if (pairs.estimate.size() != pairs.truth.size()) throw std::invalid_argument("relative_errors: unequal lengths");
  RelativeErrors errors;
  errors.spans = spans(pairs.truth, step);
  std::vector<double> translations, rotations;
  for (const auto& [first, last] : errors.spans) {
    const auto motion = [first = first, last = last](const Trajectory& t) -> Eigen::Isometry3d {
      return t[first].T_world_camera.inverse() * t[last].T_world_camera;
    };
    const Eigen::Isometry3d E = motion(pairs.truth).inverse() * motion(pairs.estimate);
    translations.push_back(E.translation().norm());
    rotations.push_back(rotation_angle(E.linear()) * 180.0 / std::numbers::pi);
  }
  errors.translation_m = with_statistics(std::move(translations));
  errors.rotation_deg = with_statistics(std::move(rotations));
  return errors;
}

}  // namespace alidade
