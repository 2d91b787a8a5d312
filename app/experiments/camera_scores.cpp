// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/camera_scores.h"

#include <algorithm>
#include <cmath>

#include "evaluation/consistency.h"
#include "reconstruction/resection.h"

namespace alidade {
namespace {

std::vector<double> mean_squares(const std::vector<std::vector<double>>& errors) {
  std::vector<double> result;
  for (const std::vector<double>& run : errors) {
    double sum = 0.0;
    for (double e : run) sum += e * e;
    result.push_back(sum / static_cast<double>(run.size()));
  }
  return result;
}

}  // namespace

void add_run(MethodErrors& errors, const CameraRun& run, const Trajectory& estimate) {
  const auto skipped = static_cast<std::ptrdiff_t>(run.truth.size() - estimate.size());
  const Trajectory truth(run.truth.begin() + skipped, run.truth.end());
  std::vector<double> position, rotation;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    const Vector6d error = difference(estimate[k].T_world_camera, truth[k].T_world_camera);
    position.push_back(error.head<3>().norm());
    rotation.push_back(error.tail<3>().norm());
  }
  errors.position_m.push_back(std::move(position));
  errors.rotation_rad.push_back(std::move(rotation));
  if (const auto c = consistency({estimate, truth})) errors.nees_per_dof.push_back(c->mean_per_degree);
}

std::vector<double> mean_by_frame(const std::vector<std::vector<double>>& errors) {
  std::vector<double> result(errors.empty() ? 0 : errors.front().size(), 0.0);
  for (const auto& run : errors) {
    for (std::size_t k = 0; k < result.size(); ++k) result[k] += run[k] / static_cast<double>(errors.size());
  }
  return result;
}

std::vector<double> rms_by_frame(const std::vector<std::vector<double>>& errors) {
  std::vector<double> result(errors.empty() ? 0 : errors.front().size(), 0.0);
  for (const auto& run : errors) {
    for (std::size_t k = 0; k < result.size(); ++k) result[k] += run[k] * run[k] / static_cast<double>(errors.size());
  }
  for (double& value : result) value = std::sqrt(value);
  return result;
}

double rms(const std::vector<std::vector<double>>& errors) {
  return pooled_rms(mean_squares(errors));
}

Ratio rms_ratio(const std::vector<std::vector<double>>& errors, const std::vector<std::vector<double>>& reference) {
  return ratio_of_rms(mean_squares(errors), mean_squares(reference));
}

double frames_not_worse_percent(const MethodErrors& errors, const MethodErrors& reference) {
  int good = 0, all = 0;
  for (auto member : {&MethodErrors::position_m, &MethodErrors::rotation_rad}) {
    const std::vector<double> ours = mean_by_frame(errors.*member), theirs = mean_by_frame(reference.*member);
    for (std::size_t k = 0; k < ours.size(); ++k) {
      good += ours[k] <= theirs[k];
      ++all;
    }
  }
  return 100.0 * good / all;
}

double worst_frame_ratio(const MethodErrors& errors, const MethodErrors& reference) {
  double worst = 0.0;
  for (auto member : {&MethodErrors::position_m, &MethodErrors::rotation_rad}) {
    const std::vector<double> ours = rms_by_frame(errors.*member), theirs = rms_by_frame(reference.*member);
    for (std::size_t k = 0; k < ours.size(); ++k) worst = std::max(worst, ours[k] / theirs[k]);
  }
  return worst;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

FrameBounds single_frame_bounds(const CameraScene& scene) {
  FrameBounds bounds;
  CameraScene exact = scene;
  exact.sigma_px = 0.0;
  const CameraRun run = simulate_run(exact, 0);
  for (std::size_t k = 2; k < run.truth.size(); ++k) {
    const auto P = resection_covariance(scene.camera, run.truth[k].T_world_camera, run.sightings[k]);
    const Vector6d variances = scene.sigma_px * scene.sigma_px * (P ? *P : Matrix6d::Zero()).diagonal();
    bounds.position_m.push_back(std::sqrt(variances.head<3>().sum()));
    bounds.rotation_rad.push_back(std::sqrt(variances.tail<3>().sum()));
  }
  return bounds;
}

}  // namespace alidade
