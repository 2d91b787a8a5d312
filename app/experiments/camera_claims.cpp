// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/camera_claims.h"

#include "app/experiments/camera_experiment.h"

namespace alidade {

ExperimentSection camera_claims(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"claims", "The paper's other claims", {}, {}, {}, {}};
  ReportTable verdicts{"The paper's claims", {"claim", "verdict"}, {}};
  for (const auto measure : {map_in_state_claims, nonlinearity_claims, bundle_start_claims}) {
    ClaimEvidence evidence = measure(base, context);
    if (context.stop.stop_requested()) return section;
    section.remarks.insert(section.remarks.end(), evidence.remarks.begin(), evidence.remarks.end());
    section.tables.insert(section.tables.end(), evidence.tables.begin(), evidence.tables.end());
    for (const Claim& claim : evidence.claims) {
      const std::string verdict = claim.is_confirmed ? "confirmed" : "not confirmed";
      verdicts.rows.push_back({claim.text, verdict});
      section.summary[claim.key] = {{"claim", claim.text}, {"verdict", verdict}, {"figures", claim.figures}};
    }
  }
  section.tables.push_back(std::move(verdicts));
  return section;
}

}  // namespace alidade
