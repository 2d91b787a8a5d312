// SPDX-License-Identifier: Apache-2.0
#include "app/detector_verification.h"

#include <chrono>

#include "evaluation/position_error.h"

namespace alidade {
namespace {

constexpr auto kLongestGap = std::chrono::milliseconds(100);

CalibrationContext with_prefix(const CalibrationContext& context, const std::string& prefix) {
  CalibrationContext told{nullptr, {}, context.stop};
  if (context.progress) {
    told.progress = [&context, prefix](Progress p) {
      p.stage = prefix + p.stage;
      context.progress(p);
    };
  }
  return told;
}

std::optional<Statistics> errors_of(const std::vector<Eigen::Vector3d>& estimate,
                                    const std::vector<Eigen::Vector3d>& truth) {
  const auto errors = rigid_errors(estimate, truth);
  return errors ? std::optional(errors->distance_m.statistics) : std::nullopt;
}

// Positions at the instants at which all is known that is compared.
struct Compared {
  std::vector<Eigen::Vector3d> truth, before_truth, before, after, onboard;
};

bool is_within(const std::vector<LineReading>& readings, Timestamp time) {
  return !readings.empty() && time >= readings.front().time && time <= readings.back().time;
}

}  // namespace

std::optional<ReferenceErrors> reference_errors(const DetectorVerification& verification,
                                                const VerificationData& data) {
  ReferenceErrors errors;
  Compared compared;
  const bool has_onboard = !data.onboard.empty();
  for (const TimedPosition& instant : has_onboard ? data.onboard : data.reference) {
    const auto truth = position_at(data.reference, instant.time, kLongestGap);
    if (!truth || !is_within(data.readings, instant.time)) continue;
    ++errors.asked;
    if (const auto T = pose_at(verification.before.motion, instant.time, kLongestGap)) {
      compared.before.push_back(T->translation());
      compared.before_truth.push_back(*truth);
    }
    const auto T = pose_at(verification.after.motion, instant.time, kLongestGap);
    if (!T) continue;
    ++errors.answered;
    compared.truth.push_back(*truth);
    compared.after.push_back(T->translation());
    compared.onboard.push_back(instant.p);
  }
  const auto after = errors_of(compared.after, compared.truth);
  if (!after) return std::nullopt;
  errors.after_m = *after;
  errors.before_m = errors_of(compared.before, compared.before_truth).value_or(Statistics{});
  if (has_onboard) errors.onboard_m = errors_of(compared.onboard, compared.truth);
  return errors;
}

DetectorVerification verify_detectors(const DetectorCalibration& given, const DetectorCalibration& refined,
                                      const VerificationData& data, const DetectorCalibrationChoice& choice,
                                      const CalibrationContext& context) {
  DetectorCalibrationOptions held = choice.solver;
  held.hold_detectors = true;
  DetectorVerification result;
  result.before = calibrate_detectors(given.rig.detectors, given.body, data.readings, held,
                                      with_prefix(context, "verifying the detectors as given: "));
  result.after = calibrate_detectors(refined.rig.detectors, refined.body, data.readings, held,
                                     with_prefix(context, "verifying the refined ones: "));
  if (result.after.outcome != CalibrationOutcome::Refined) return result;
  result.windows = fit_windows(refined.rig.detectors, refined.body, data.readings, result.after.motion, choice.windows,
                               context.stop);
  result.errors = reference_errors(result, data);
  return result;
}

}  // namespace alidade
