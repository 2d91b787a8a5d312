// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/camera_comparison.h"

#include <mutex>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/experiments/cpu_clock.h"

namespace alidade {
namespace {

constexpr int kUnscoredRuns = 10;
constexpr unsigned kUnscored = 1'000'000;  // the first of their numbers, far from those of the scored

const std::vector<std::string> kMethodOrder{"EPnP",           "EPnP + LM",        "SQPnP",
                                            "paper's filter", "RANSAC-EPnP + LM", "ours, causal",
                                            "ours, lag 3",    "ours, lag 12",     "ours, smoothed"};

}  // namespace

std::map<std::string, MethodErrors> compare(const CameraScene& scene, const ExperimentContext& context,
                                            const std::string& stage, const std::vector<CameraMethod>& methods,
                                            const std::function<CameraRun(CameraRun)>& prepare) {
  struct Outcome {
    CameraRun run;
    NamedTrajectories estimates;
    std::vector<double> seconds;
  };
  std::vector<Outcome> outcomes(static_cast<std::size_t>(context.runs));
  std::mutex mutex;
  int done = 0;
  tbb::parallel_for(0, context.runs, [&](int i) {
    if (context.stop.stop_requested()) return;
    Outcome& outcome = outcomes[static_cast<std::size_t>(i)];
    outcome.run = simulate_run(scene, context.seed * 1000 + static_cast<unsigned>(i));
    if (prepare) outcome.run = prepare(std::move(outcome.run));
    for (const auto& method : methods) {
      const double start = thread_seconds();
      NamedTrajectories estimates = method(outcome.run);
      const double seconds = thread_seconds() - start;
      for (auto& estimate : estimates) {
        outcome.estimates.push_back(std::move(estimate));
        outcome.seconds.push_back(seconds);
      }
    }
    const std::scoped_lock lock(mutex);
    if (context.progress) context.progress({stage, ++done, context.runs, ""});
  });
  std::map<std::string, MethodErrors> errors;
  for (const Outcome& outcome : outcomes) {
    for (std::size_t m = 0; m < outcome.estimates.size(); ++m) {
      MethodErrors& method = errors[outcome.estimates[m].first];
      method.name = outcome.estimates[m].first;
      add_run(method, outcome.run, outcome.estimates[m].second);
      method.seconds.push_back(outcome.seconds[m]);
    }
  }
  return errors;
}

CameraMethod single_frames(const CameraScene& scene, std::string name, PnpMethod method) {
  return [camera = scene.camera, name = std::move(name), method](const CameraRun& run) {
    return NamedTrajectories{{name, estimate_single_frames(camera, run, method)}};
  };
}

CameraMethod our_filter(const CameraScene& scene, CameraFilterOptions options, std::vector<int> lags) {
  return [camera = scene.camera, options = std::move(options), lags = std::move(lags)](const CameraRun& run) {
    const std::vector<MotionStep> steps = filter_run(camera, run, options);
    NamedTrajectories estimates{{"ours, causal", causal_poses(steps)}};
    for (int lag : lags) estimates.emplace_back(fmt::format("ours, lag {}", lag), smoothed_poses(steps, lag));
    estimates.emplace_back("ours, smoothed", smoothed_poses(steps, -1));
    return estimates;
  };
}

std::vector<CameraRun> unscored_runs(const CameraScene& scene, const ExperimentContext& context, int count) {
  return simulate_runs(scene, kUnscored + context.seed * 1000, count);
}

CameraFilterOptions learned_options(const CameraScene& scene, const ExperimentContext& context) {
  const std::vector<CameraRun> unscored = unscored_runs(scene, context, kUnscoredRuns);
  CameraFilterOptions options;
  options.motion = guessed_motion(unscored.front().truth);
  options.motion = learn_motion(scene.camera, unscored, options);
  return options;
}

std::string with_interval(const Ratio& ratio) {
  return fmt::format("{:.3f} ({:.3f}-{:.3f})", ratio.value, ratio.low, ratio.high);
}

nlohmann::json as_json(const Ratio& ratio) {
  return {{"value", ratio.value}, {"low", ratio.low}, {"high", ratio.high}};
}

std::string of_path_percent(double error_m, const CameraScene& scene) {
  return fmt::format("{:.4f}", 100.0 * error_m / path_length(simulate_run(scene, 0).truth));
}

ReportTable error_table(const std::string& title, const CameraScene& scene,
                        const std::map<std::string, MethodErrors>& errors, const std::string& reference) {
  ReportTable table{title,
                    {"method", "position RMSE (mm)", "% of path", "/ " + reference, "rotation RMSE (deg)",
                     "/ " + reference, "worst frame", "NEES per dof"},
                    {}};
  const MethodErrors& other = errors.at(reference);
  for (const std::string& name : kMethodOrder) {
    if (!errors.contains(name)) continue;
    const MethodErrors& e = errors.at(name);
    table.rows.push_back({name, fmt::format("{:.3f}", 1e3 * rms(e.position_m)),
                          of_path_percent(rms(e.position_m), scene),
                          with_interval(rms_ratio(e.position_m, other.position_m)),
                          fmt::format("{:.4f}", rms(e.rotation_rad) * 180.0 / std::numbers::pi),
                          with_interval(rms_ratio(e.rotation_rad, other.rotation_rad)),
                          fmt::format("{:.2f}", worst_frame_ratio(e, other)),
                          e.nees_per_dof.empty() ? "-" : fmt::format("{:.2f}", mean(e.nees_per_dof))});
  }
  return table;
}

nlohmann::json summary_of(const std::map<std::string, MethodErrors>& errors, const std::string& reference) {
  nlohmann::json summary;
  const MethodErrors& other = errors.at(reference);
  for (const auto& [name, e] : errors) {
    nlohmann::json& s = summary[name];
    s["position_rmse_m"] = rms(e.position_m);
    s["rotation_rmse_rad"] = rms(e.rotation_rad);
    s["position_ratio"] = as_json(rms_ratio(e.position_m, other.position_m));
    s["rotation_ratio"] = as_json(rms_ratio(e.rotation_rad, other.rotation_rad));
    s["worst_frame_ratio"] = worst_frame_ratio(e, other);
    s["cpu_s"] = mean(e.seconds);
    if (!e.nees_per_dof.empty()) s["nees_per_dof"] = mean(e.nees_per_dof);
  }
  return summary;
}

}  // namespace alidade
