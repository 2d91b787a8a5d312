// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/experiments/camera_runs.h"
#include "app/experiments/experiment_section.h"

namespace alidade {

// The camera tracker paper's experiments on synthetic data, and what they leave out. Each takes the scene's camera and
// points and sets path, frames, noise and outliers by itself. Motion noise is learned from ten runs that are not
// scored.

/// The paper's Fig. 3 and 4: error by frame on every path, sigma 3 px.
ExperimentSection camera_accuracy(const CameraScene& scene, const ExperimentContext& context);

/// The paper's Fig. 5: error by pixel noise, 0 to 5 px, unknown to the filter.
ExperimentSection camera_noise(const CameraScene& scene, const ExperimentContext& context);

/// The same path in more frames.
ExperimentSection camera_frames(const CameraScene& scene, const ExperimentContext& context);

/// Fewer points.
ExperimentSection camera_points(const CameraScene& scene, const ExperimentContext& context);

/// Outliers, against RANSAC.
ExperimentSection camera_outliers(const CameraScene& scene, const ExperimentContext& context);

/// A map of two adjacent views.
ExperimentSection camera_uncertain_map(const CameraScene& scene, const ExperimentContext& context);

/// What else the paper says: each claim measured and judged.
ExperimentSection camera_claims(const CameraScene& scene, const ExperimentContext& context);

}  // namespace alidade
