// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/experiments/camera_runs.h"
#include "app/experiments/experiment_section.h"

namespace alidade {

/// Something that the camera tracker paper says, and whether it was found so.
struct Claim {
  std::string key;  ///< in summary.json
  std::string text;
  bool is_confirmed = false;
  nlohmann::json figures;  ///< by which that was decided
};

/// What was measured for claims that are judged by the same runs.
struct ClaimEvidence {
  std::vector<Claim> claims;
  std::vector<std::string> remarks;
  std::vector<ReportTable> tables;
};

/// "A filter with the map in its state costs more and is less accurate", for 25 to 400 points.
ClaimEvidence map_in_state_claims(const CameraScene& scene, const ExperimentContext& context);

/// "The smaller state cures the non-linearity": the paper's filter, an unscented one and an iterated one.
ClaimEvidence nonlinearity_claims(const CameraScene& scene, const ExperimentContext& context);

/// "A better start makes bundle adjustment end better or sooner".
ClaimEvidence bundle_start_claims(const CameraScene& scene, const ExperimentContext& context);

}  // namespace alidade
