// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/targets_video_chain.h"

#include <algorithm>
#include <random>

#include <fmt/format.h>

#include "camera/receiver.h"
#include "datasets/sky_scene.h"
#include "evaluation/target_scores.h"
#include "uav/tracker/target_tracker.h"
#include "uav/video/moving_objects.h"

namespace alidade {
namespace {

constexpr int kWarmUp = 30;
constexpr double kFps = 30.0;
constexpr double kTrueNoise_px = 0.5;

// What detectors read in the frames after warming up, and what they should have read.
struct ChainReadings {
  std::vector<ReceiverReading> detected, disturbed;
};

SkySceneOptions chain_options(double shake_px, unsigned seed) {
  SkySceneOptions options;
  options.width = 960;
  options.height = 540;
  options.focal_px = 675.0;
  options.fps_hz = kFps;
  options.duration_s = 6.0;
  options.dots = {{4.0, 8.0, true}, {3.0, 6.0, false}, {5.0, 5.0, true}, {3.0, 10.0, true}};
  options.look.shake_px = shake_px;
  options.look.shake_roll_rad = 3e-4 * shake_px;
  options.seed = options.look.seed = options.look.backdrop.seed = seed;
  return options;
}

ChainReadings read_videos(const SkyScene& scene, unsigned seed, const ExperimentContext& context) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, kTrueNoise_px);
  ChainReadings readings;
  for (std::size_t k = 0; k < scene.receivers.size(); ++k) {
    const int id = scene.receivers[k].id;
    SkyVideo video(scene, k);
    MovingObjectDetector detector;
    for (int i = 0; const auto frame = video.next(); ++i) {
      if (context.stop.stop_requested()) return readings;
      const auto found = readings_of(detector.detect(frame->image, frame->time), id, frame->time);
      if (i < kWarmUp) continue;
      readings.detected.insert(readings.detected.end(), found.begin(), found.end());
      for (const DotSighting& dot : frame->sightings) {
        const double u = noise(random), v = noise(random);
        readings.disturbed.push_back({frame->time, id, dot.steady_pixel + Eigen::Vector2d(u, v)});
      }
    }
  }
  return readings;
}

TargetTrackerOptions tracker_options() {
  TargetTrackerOptions options;
  options.period_s = 1.0 / kFps;
  options.scan_s = 0.4 / kFps;  // rows of one frame are exposed within a third of a period
  options.lag_s = 0.05;
  options.window_periods = 10.0;
  options.patience_periods = 20.0;
  options.least_sightings = 9;
  options.false_bearings_per_sr = 1.0;
  options.filter.motion.acceleration_density = 0.5;
  return options;
}

std::vector<TargetMoment> follow(const SkyScene& scene, const std::vector<ReceiverReading>& readings) {
  constexpr double kOutput_s = 0.2, kFirst_s = kWarmUp / kFps + 1.0;  // a second for tracks to be found
  TargetTracker tracker(tracker_options());
  std::vector<TargetMoment> moments;
  Timestamp next(from_seconds(kFirst_s));
  for (const Bearing& bearing : bearings_of(scene.receivers, readings)) {
    for (; bearing.time > next; next += from_seconds(kOutput_s)) {
      TargetMoment moment{next, {}, {}};
      for (const TargetPath& path : scene.paths) moment.truth.push_back({path.target, position_at(path, next)});
      for (const TargetEstimate& estimate : tracker.estimates_at(next)) {
        if (estimate.status == TargetStatus::Tentative) continue;
        moment.estimates.push_back(
            {estimate.id, estimate.state.p_world, estimate.state.covariance.topLeftCorner<3, 3>()});
      }
      moments.push_back(std::move(moment));
    }
    tracker.add(bearing);
  }
  return moments;
}

std::vector<std::string> row_of(const std::string& scene, const std::string& source, const TargetScores& scores) {
  return {scene,
          source,
          fmt::format("{:.3f}", scores.identity.completeness),
          std::to_string(scores.identity.false_ids),
          std::to_string(scores.identity.switches),
          fmt::format("{:.3f}", scores.rms_m),
          fmt::format("{:.2f}", scores.nees.mean_per_degree)};
}

nlohmann::json summary_of(const TargetScores& scores) {
  return {{"completeness", scores.identity.completeness},
          {"false_tracks", scores.identity.false_ids},
          {"switches", scores.identity.switches},
          {"rms_m", scores.rms_m}};
}

}  // namespace

void add_video_chain(const ExperimentContext& context, ExperimentSection& section) {
  constexpr double kCutoff_m = 5.0;
  ReportTable table{
      "From three videos to tracks: four targets at about 110 m",
      {"cameras", "from", "share of moments tracked", "false tracks", "switches", "RMSE (m)", "NEES / dof"},
      {}};
  for (const auto& [name, shake_px] : {std::pair{"still", 0.0}, std::pair{"swaying", 0.8}}) {
    const SkyScene scene = make_sky_scene(chain_options(shake_px, context.seed));
    const ChainReadings readings = read_videos(scene, context.seed, context);
    if (context.stop.stop_requested()) return;
    const TargetScores videos = score_targets(follow(scene, readings.detected), kCutoff_m);
    const TargetScores exact = score_targets(follow(scene, readings.disturbed), kCutoff_m);
    table.rows.push_back(row_of(name, "videos", videos));
    table.rows.push_back(row_of(name, "true pixels, 0.5 px of noise", exact));
    section.summary["chain"][name] = {
        {"videos", summary_of(videos)}, {"true_pixels", summary_of(exact)}, {"rms_ratio", videos.rms_m / exact.rms_m}};
    if (context.progress) context.progress({fmt::format("videos to tracks, {}", name), 1, 1, ""});
  }
  section.tables.push_back(std::move(table));
}

}  // namespace alidade
