// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/camera_experiment.h"

#include <cmath>
#include <ctime>
#include <functional>
#include <map>
#include <mutex>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/experiments/camera_scores.h"

namespace alidade {
namespace {

constexpr int kUnscoredRuns = 10;
constexpr unsigned kUnscored = 1'000'000;  // the first of their numbers, far from those of the scored

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// What a method makes of a run; some give several estimates at once (causal, with lag, smoothed).
using NamedTrajectories = std::vector<std::pair<std::string, Trajectory>>;
using Methods = std::vector<std::function<NamedTrajectories(const CameraRun&)>>;

// All methods on all runs, two threads; the order of the runs is kept. Ends early when the user stops it.
std::map<std::string, MethodErrors> compare(const CameraScene& scene, const ExperimentContext& context,
                                            const std::string& stage, const Methods& methods,
                                            const std::function<CameraRun(CameraRun)>& prepare = {}) {
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

std::function<NamedTrajectories(const CameraRun&)> single_frames(const CameraScene& scene, std::string name,
                                                                 PnpMethod method) {
  return [camera = scene.camera, name = std::move(name), method](const CameraRun& run) {
    return NamedTrajectories{{name, estimate_single_frames(camera, run, method)}};
  };
}

std::function<NamedTrajectories(const CameraRun&)> our_filter(const CameraScene& scene, CameraFilterOptions options,
                                                              std::vector<int> lags) {
  return [camera = scene.camera, options = std::move(options), lags = std::move(lags)](const CameraRun& run) {
    const std::vector<FilterStep> steps = filter_run(camera, run, options);
    NamedTrajectories estimates{{"ours, causal", causal_poses(steps)}};
    for (int lag : lags) estimates.emplace_back(fmt::format("ours, lag {}", lag), lagged_poses(steps, lag));
    estimates.emplace_back("ours, smoothed", smoothed_poses(steps));
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

std::string of_path_percent(double error_m, const CameraScene& scene) {
  return fmt::format("{:.4f}", 100.0 * error_m / path_length(simulate_run(scene, 0).truth));
}

nlohmann::json as_json(const Ratio& ratio) {
  return {{"value", ratio.value}, {"low", ratio.low}, {"high", ratio.high}};
}

std::vector<double> in_degrees(std::vector<double> radians) {
  for (double& r : radians) r *= 180.0 / std::numbers::pi;
  return radians;
}

std::vector<double> scaled_by(std::vector<double> values, double factor) {
  for (double& v : values) v *= factor;
  return values;
}

Series series_over_frames(const std::string& name, std::vector<double> values, SeriesStyle style = SeriesStyle::Line) {
  Series series{name, {}, std::move(values), style, std::nullopt};
  for (std::size_t k = 0; k < series.y.size(); ++k) series.x.push_back(static_cast<double>(k + 3));
  return series;
}

const std::map<OrbitPath, std::string> kPathNames{
    {OrbitPath::Smooth, "smooth"}, {OrbitPath::Turn, "turn"}, {OrbitPath::StopAndGo, "stop-and-go"}};

const std::vector<std::string> kMethodOrder{"EPnP",           "EPnP + LM",        "SQPnP",
                                            "paper's filter", "RANSAC-EPnP + LM", "ours, causal",
                                            "ours, lag 3",    "ours, lag 12",     "ours, smoothed"};

// One row per method: its errors, and in proportion to `reference`'s.
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

}  // namespace

ExperimentSection camera_accuracy(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"accuracy", "Error by frame (the paper's Fig. 3 and 4)", {}, {}, {}, {}};
  for (const auto& [path, name] : kPathNames) {
    CameraScene scene = base;
    scene.path = path;
    const std::vector<CameraRun> unscored = unscored_runs(scene, context, 3);
    const MotionNoise paper = tune_paper_noise(scene.camera, unscored, scene.sigma_px);
    const auto paper_filter = [&](const CameraRun& run) {
      return NamedTrajectories{{"paper's filter", estimate_by_paper_filter(scene.camera, run, paper, scene.sigma_px)}};
    };
    const auto errors =
        compare(scene, context, "accuracy, " + name,
                {single_frames(scene, "EPnP", PnpMethod::Epnp), single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm),
                 single_frames(scene, "SQPnP", PnpMethod::Sqpnp), paper_filter,
                 our_filter(scene, learned_options(scene, context), {3})});
    if (context.stop.stop_requested()) return section;
    const FrameBounds bounds = single_frame_bounds(scene);
    ReportTable table = error_table(fmt::format("Path '{}', sigma {} px, {} frames, {} points, {} runs", name,
                                                scene.sigma_px, scene.frames, scene.points.size(), context.runs),
                                    scene, errors, "EPnP + LM");
    section.summary[name] = summary_of(errors, "EPnP + LM");
    table.columns.push_back("frames <= EPnP (%)");
    for (auto& row : table.rows) {
      const double share = frames_not_worse_percent(errors.at(row.front()), errors.at("EPnP"));
      row.push_back(fmt::format("{:.1f}", share));
      section.summary[name][row.front()]["frames_not_worse_than_epnp_percent"] = share;
    }
    section.tables.push_back(std::move(table));
    const double path_m = path_length(simulate_run(scene, 0).truth);
    Plot position{"Path '" + name + "': position", "frame", "mean error (% of path)", {}, false, false};
    Plot rotation{"Path '" + name + "': rotation", "frame", "mean error (deg)", {}, false, false};
    for (const std::string method :
         {"EPnP", "EPnP + LM", "paper's filter", "ours, causal", "ours, lag 3", "ours, smoothed"}) {
      const MethodErrors& e = errors.at(method);
      position.series.push_back(series_over_frames(method, scaled_by(mean_by_frame(e.position_m), 100.0 / path_m)));
      rotation.series.push_back(series_over_frames(method, in_degrees(mean_by_frame(e.rotation_rad))));
    }
    // The bound is on the root mean square; of the mean, a three-dimensional Gaussian error has 0.92.
    const double kMeanOfRms = std::sqrt(8.0 / (3.0 * std::numbers::pi));
    position.series.push_back(series_over_frames(
        "single-frame bound", scaled_by(bounds.position_m, 100.0 * kMeanOfRms / path_m), SeriesStyle::Dashed));
    rotation.series.push_back(series_over_frames(
        "single-frame bound", in_degrees(scaled_by(bounds.rotation_rad, kMeanOfRms)), SeriesStyle::Dashed));
    section.figures.push_back({"accuracy_" + name + ".png",
                               "Mean error of " + std::to_string(context.runs) + " runs in each frame.",
                               {position, rotation}});
  }
  return section;
}

ExperimentSection camera_noise(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"noise", "Error by pixel noise (the paper's Fig. 5)", {}, {}, {}, {}};
  ReportTable table{"Path 'smooth': position RMSE (% of path) and its ratio to EPnP + LM, rotation ratio",
                    {"sigma (px)", "EPnP", "EPnP + LM", "ours, causal", "position ratio", "rotation ratio"},
                    {}};
  Plot plot{"Path 'smooth'", "sigma (px)", "position RMSE (% of path)", {}, false, false};
  for (const char* method : {"EPnP", "EPnP + LM", "ours, causal"})
    plot.series.push_back({method, {}, {}, SeriesStyle::Line, std::nullopt});
  for (double sigma_px : {0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0}) {
    CameraScene scene = base;
    scene.sigma_px = sigma_px;
    const auto errors =
        compare(scene, context, fmt::format("noise, {} px", sigma_px),
                {single_frames(scene, "EPnP", PnpMethod::Epnp), single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm),
                 our_filter(scene, learned_options(scene, context), {})});
    if (context.stop.stop_requested()) return section;
    const double path_m = path_length(simulate_run(scene, 0).truth);
    std::vector<std::string> row{fmt::format("{}", sigma_px)};
    for (Series& series : plot.series) {
      const double percent = 100.0 * rms(errors.at(series.name).position_m) / path_m;
      series.x.push_back(sigma_px);
      series.y.push_back(percent);
      row.push_back(fmt::format("{:.3g}", percent));
    }
    const nlohmann::json summary = summary_of(errors, "EPnP + LM");
    nlohmann::json ours = summary["ours, causal"];
    ours["sigma_px"] = sigma_px;
    ours["of_path_percent"] = plot.series.back().y.back();
    section.summary.push_back(ours);
    for (const char* ratio : {"position_ratio", "rotation_ratio"}) {
      row.push_back(fmt::format("{:.3f}", ours[ratio]["value"].get<double>()));
    }
    table.rows.push_back(std::move(row));
  }
  section.tables.push_back(std::move(table));
  section.figures.push_back({"noise.png", "Error against pixel noise; the filter is not told it.", {plot}});
  return section;
}

ExperimentSection camera_frames(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"frames", "The same path in more frames", {}, {}, {}, {}};
  section.remarks.push_back("A lag of 12 frames of 220 is the same time as 3 of 55.");
  for (int frames : {110, 220}) {
    CameraScene scene = base;
    scene.frames = frames;
    const auto errors = compare(scene, context, fmt::format("{} frames", frames),
                                {single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm),
                                 our_filter(scene, learned_options(scene, context), {3, 12})});
    if (context.stop.stop_requested()) return section;
    section.tables.push_back(
        error_table(fmt::format("Path 'smooth' in {} frames", frames), scene, errors, "EPnP + LM"));
    section.summary[std::to_string(frames)] = summary_of(errors, "EPnP + LM");
  }
  return section;
}

ExperimentSection camera_points(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"points", "Fewer points", {}, {}, {}, {}};
  ReportTable table{"Path 'smooth', sigma 3 px: position RMSE (mm)",
                    {"points", "EPnP", "EPnP + LM", "ours, causal", "ratio to EPnP + LM"},
                    {}};
  for (std::size_t count : {10u, 20u, 50u, 100u, 200u}) {
    CameraScene scene = base;
    scene.points.clear();
    const std::size_t step = std::max<std::size_t>(1, base.points.size() / count);
    for (std::size_t i = 0; i < base.points.size() && scene.points.size() < count; i += step) {
      scene.points.push_back(base.points[i]);
    }
    const auto errors =
        compare(scene, context, fmt::format("{} points", count),
                {single_frames(scene, "EPnP", PnpMethod::Epnp), single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm),
                 our_filter(scene, learned_options(scene, context), {})});
    if (context.stop.stop_requested()) return section;
    std::vector<std::string> row{std::to_string(scene.points.size())};
    for (const char* name : {"EPnP", "EPnP + LM", "ours, causal"}) {
      row.push_back(fmt::format("{:.3f}", 1e3 * rms(errors.at(name).position_m)));
    }
    row.push_back(with_interval(rms_ratio(errors.at("ours, causal").position_m, errors.at("EPnP + LM").position_m)));
    table.rows.push_back(std::move(row));
    section.summary[std::to_string(scene.points.size())] = summary_of(errors, "EPnP + LM");
  }
  section.tables.push_back(std::move(table));
  return section;
}

ExperimentSection camera_outliers(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"outliers", "Outliers, against RANSAC", {}, {}, {}, {}};
  for (double share : {0.3, 0.5}) {
    CameraScene scene = base;
    scene.outliers = share;
    const auto ransac = [&](const CameraRun& run) {
      return NamedTrajectories{{"RANSAC-EPnP + LM", estimate_by_ransac(scene.camera, run, scene.sigma_px)}};
    };
    const std::string name = fmt::format("{:.0f}", 100.0 * share);
    const auto errors =
        compare(scene, context, name + " % outliers", {ransac, our_filter(scene, learned_options(scene, context), {})});
    if (context.stop.stop_requested()) return section;
    section.tables.push_back(
        error_table(fmt::format("Path 'smooth', {} % outliers", name), scene, errors, "RANSAC-EPnP + LM"));
    section.summary[name] = summary_of(errors, "RANSAC-EPnP + LM");
    section.summary[name]["time_ratio"] =
        mean(errors.at("ours, causal").seconds) / mean(errors.at("RANSAC-EPnP + LM").seconds);
  }
  return section;
}

ExperimentSection camera_uncertain_map(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"uncertain-map", "A map of two adjacent views", {}, {}, {}, {}};
  CameraScene scene = base;
  scene.sigma_px = 1.0;
  const auto prepare = [&](CameraRun run) {
    return with_map_of_two_views(scene.camera, std::move(run), scene.sigma_px);
  };
  std::vector<CameraRun> unscored = unscored_runs(scene, context, kUnscoredRuns / 2);
  for (CameraRun& run : unscored) run = prepare(std::move(run));
  struct Variant {
    std::string name;
    MapUncertainty uncertainty;
    SharedMapError shared;
  };
  const std::vector<Variant> variants{
      {"R inflated", MapUncertainty::Inflated, SharedMapError::Ignored},
      {"points refitted", MapUncertainty::Refitted, SharedMapError::Ignored},
      {"refitted, shared error considered", MapUncertainty::Refitted, SharedMapError::Considered}};
  Methods methods{single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm)};
  for (const Variant& variant : variants) {
    CameraFilterOptions options;
    options.update.map_uncertainty = variant.uncertainty;
    options.motion = guessed_motion(unscored.front().truth);
    options.motion = learn_motion(scene.camera, unscored, options, variant.shared);
    methods.push_back([&scene, variant, options](const CameraRun& run) {
      return NamedTrajectories{{variant.name, causal_poses(filter_run(scene.camera, run, options, variant.shared))}};
    });
  }
  const auto errors = compare(scene, context, "uncertain map", methods, prepare);
  if (context.stop.stop_requested()) return section;
  section.summary = summary_of(errors, "EPnP + LM");
  ReportTable table{"Path 'smooth', map triangulated from the first two frames, sigma 1 px",
                    {"method", "position RMSE (% of path)", "/ EPnP + LM", "rotation / EPnP + LM", "NEES per dof"},
                    {}};
  std::vector<std::string> names{"EPnP + LM"};
  for (const Variant& variant : variants) names.push_back(variant.name);
  for (const std::string& name : names) {
    const MethodErrors& e = errors.at(name);
    const MethodErrors& lm = errors.at("EPnP + LM");
    table.rows.push_back({name, of_path_percent(rms(e.position_m), scene),
                          with_interval(rms_ratio(e.position_m, lm.position_m)),
                          with_interval(rms_ratio(e.rotation_rad, lm.rotation_rad)),
                          e.nees_per_dof.empty() ? "-" : fmt::format("{:.2f}", mean(e.nees_per_dof))});
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
