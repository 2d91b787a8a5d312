// SPDX-License-Identifier: Apache-2.0
#include "tracking/refinement.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "reconstruction/bundle_covariance.h"
#include "tracking/map_search.h"
#include "tracking/sighting_alignment.h"

namespace alidade {
namespace {

constexpr double kLossSigmas = 2.0;  // where the Cauchy loss begins to doubt, in standard deviations as found
constexpr double kCutSigmas = 5.0;   // beyond it a sighting is taken for a mismatch

std::vector<int> all_keyframes(const PointMap& map) {
  std::vector<int> all(map.keyframes.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

Completion complete_everywhere(const Camera& camera, LiveMap live, double radius_px) {
  const std::vector<int> points = living_points(live.map);
  const std::vector<int> keyframes = all_keyframes(live.map);
  return complete_sightings(camera, std::move(live), points, keyframes, radius_px);
}

struct FocalFit {
  double factor = 1.0;
  double sigma = 0.0;
};

// The factor on the focal length that fits the map best. Far from it, the map's shape has to follow, and sightings that
// looked like outliers no longer do: several adjustments, each from where the last one ended.
FocalFit fit_focal_length(Camera camera, LiveMap live, BundleOptions bundle) {
  constexpr int kMostRounds = 8;
  constexpr double kSettled = 2e-3;
  bundle.refine_focal = true;
  FocalFit fit;
  for (int round = 0; round < kMostRounds; ++round) {
    bundle.loss_sigmas = kLossSigmas * reprojection_sigma(camera, live.map);
    BundleResult result = adjust_bundle(camera, std::move(live.map), bundle);
    camera.fx *= result.focal_factor;
    camera.fy *= result.focal_factor;
    fit.factor *= result.focal_factor;
    if (round == 0) fit.sigma = result.focal_factor_sigma;
    if (std::abs(result.focal_factor - 1.0) < kSettled) break;
    live.map = remove_outlying_sightings(camera, std::move(result.map), kCutSigmas).map;
    release_removed_sightings(live);
    live = complete_everywhere(camera, std::move(live), 5.0).live;
  }
  return fit;
}

}  // namespace

std::optional<std::string> doubt_focal_length(const Camera& camera, const RefinementSummary& summary) {
  const double off = std::abs(summary.focal_factor - 1.0);
  if (off < 0.04 || off < 5.0 * summary.focal_factor_sigma) return std::nullopt;
  return fmt::format(
      "the images do not fit the camera's focal length of {:.1f} px; {:.1f} px fits: calibrate the camera again",
      camera.fx, camera.fx * summary.focal_factor);
}

LiveMap refine_locally(const Camera& camera, LiveMap live, int anchored, int window, int most_fixed) {
  const int last = static_cast<int>(live.map.keyframes.size()) - 1;
  BundleOptions bundle;
  bundle.max_iterations = 8;
  for (int k = std::max(anchored, last - window + 1); k <= last; ++k) {
    bundle.free_keyframes.push_back(k);
  }
  // The keyframes that hold them: those that share most points with the newest, and always the oldest anchors.
  const int first_free = bundle.free_keyframes.front();
  const std::vector<int> shared = shared_points(live.map, last);
  std::vector<std::pair<int, int>> ranked;
  for (int k = 0; k < first_free; ++k) {
    if (shared[static_cast<std::size_t>(k)] > 10 || k >= first_free - 2) {
      ranked.emplace_back(-shared[static_cast<std::size_t>(k)], k);
    }
  }
  std::sort(ranked.begin(), ranked.end());
  for (std::size_t i = 0; i < ranked.size() && static_cast<int>(i) < most_fixed; ++i) {
    bundle.fixed_keyframes.push_back(ranked[i].second);
  }
  live.map = adjust_bundle(camera, std::move(live.map), bundle).map;
  live.map = remove_outlying_sightings(camera, std::move(live.map), 4.0).map;
  release_removed_sightings(live);
  live.map = with_covariances(camera, std::move(live.map), bundle);
  return live;
}

RefinedTrack refine_globally(const Camera& camera, LiveMap live, std::vector<FrameReport> reports,
                             const CameraTrackerOptions& options, int anchored, const ProgressSink& progress,
                             const std::stop_token& stop) {
  RefinedTrack refined;
  RefinementSummary& summary = refined.summary;
  summary.rms_px_before = reprojection_rms_px(camera, live.map);
  BundleOptions bundle = global_bundle_options(live.map, anchored);
  bundle.max_iterations = 25;
  const auto complete = [&](double radius_px) {
    Completion completion = complete_everywhere(camera, std::move(live), radius_px);
    live = std::move(completion.live);
    summary.sightings_added += completion.added;
  };
  const auto align = [&] {
    SightingAlignment alignment = align_sightings(camera, std::move(live));
    live = std::move(alignment.live);
    summary.sightings_aligned = alignment.aligned;
  };
  const auto adjust = [&] {
    bundle.loss_sigmas = kLossSigmas * reprojection_sigma(camera, live.map);
    BundleResult result = adjust_bundle(camera, std::move(live.map), bundle);
    live.map = std::move(result.map);
    summary.iterations += result.iterations;
    summary.seconds += result.seconds;
    summary.sightings = result.sighting_count;
  };
  const auto cut = [&] {
    const double most_sigmas = kCutSigmas * reprojection_sigma(camera, live.map);
    SightingCut tidied = remove_outlying_sightings(camera, std::move(live.map), most_sigmas);
    live.map = std::move(tidied.map);
    summary.sightings_removed += tidied.removed;
    release_removed_sightings(live);
  };
  const auto check_focal_length = [&] {
    const FocalFit fit = fit_focal_length(camera, live, bundle);
    summary.focal_factor = fit.factor;
    summary.focal_factor_sigma = fit.sigma;
  };
  const std::vector<std::function<void()>> steps{
      [&] { complete(5.0); }, adjust, cut, [&] { complete(3.0); }, adjust, cut, align, adjust, cut, adjust, cut, adjust,
      check_focal_length};
  for (std::size_t i = 0; i < steps.size() && !stop.stop_requested(); ++i) {
    if (progress) progress({"refining", static_cast<std::int64_t>(i), static_cast<std::int64_t>(steps.size()), ""});
    steps[i]();
  }
  live.map = with_covariances(camera, std::move(live.map), bundle);
  summary.rms_px_after = reprojection_rms_px(camera, live.map);
  refined.reports = relocate_frames(camera, live.map, std::move(reports), options);
  refined.live = std::move(live);
  if (progress) {
    progress({"refining", static_cast<std::int64_t>(steps.size()), static_cast<std::int64_t>(steps.size()), ""});
  }
  return refined;
}

std::vector<FrameReport> relocate_frames(const Camera& camera, const PointMap& map, std::vector<FrameReport> reports,
                                         const CameraTrackerOptions& options) {
  std::map<int, const Keyframe*> keyframe_of_frame;
  for (const Keyframe& keyframe : map.keyframes) keyframe_of_frame[keyframe.frame] = &keyframe;
  for (FrameReport& report : reports) {
    if (report.state != FrameState::Tracked) continue;
    const auto keyframe = keyframe_of_frame.find(report.index);
    const bool is_keyframe = keyframe != keyframe_of_frame.end();
    if (is_keyframe) {
      report.T_world_camera = keyframe->second->T_world_camera;
      report.covariance = keyframe->second->covariance;
    }
    std::vector<PointObservation> observations;
    for (const FrameSighting& s : report.sightings) {
      if (!s.is_inlier) continue;
      const MapPoint& point = map.points[static_cast<std::size_t>(s.point)];
      observations.push_back(as_observation(point, s.pixel, report.sigma_px));
    }
    PosePrior prior;
    prior.T_world_camera = report.T_world_camera;
    const auto update = update_pose(camera, prior, observations, options.update);
    if (!update) continue;
    report.likelihood = update->sightings;
    if (is_keyframe) continue;
    report.T_world_camera = update->T_world_camera;
    report.covariance = update->covariance;
    report.chi2_per_dof = update->chi2_per_dof;
  }
  return reports;
}

}  // namespace alidade
