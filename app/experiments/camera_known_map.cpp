// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/experiments/camera_comparison.h"
#include "app/experiments/known_map_video.h"
#include "app/experiments/recording_experiment.h"
#include "core/errors.h"
#include "evaluation/absolute_error.h"
#include "evaluation/consistency.h"
#include "evaluation/relative_error.h"
#include "tracking/track_smoothing.h"

namespace alidade {
namespace {

constexpr std::size_t kBlock = 10;  // frames in succession, whose errors are alike
const std::string kOurs = "ours, causal", kOpponent = "RANSAC-EPnP + LM", kLm = "EPnP + LM, our inliers",
                  kPaper = "paper's filter, our inliers";

struct Localised {
  std::string name;
  std::vector<std::optional<StampedPose>> poses;  // one per frame; empty: lost
};

// The frames that are compared, and each method's errors in them.
struct Comparison {
  std::vector<int> frames;
  struct Errors {
    std::string name;
    std::vector<double> position_m, rotation_deg;
    std::vector<double> step_m;  // of the motion since the frame just before
    std::optional<Consistency> consistency, against_exact_truth;
  };
  std::vector<Errors> methods;
};

std::vector<PointObservation> inliers_of(const LocalisedFrame& frame) {
  std::vector<PointObservation> inliers;
  for (std::size_t i = 0; i < frame.report.sightings.size(); ++i) {
    if (frame.report.sightings[i].is_inlier) inliers.push_back(frame.matches[i]);
  }
  return inliers;
}

StampedPose stamped(const LocalisedFrame& frame, const Eigen::Isometry3d& T) {
  return {frame.report.time, T, std::nullopt};
}

Localised ours(std::string name, const std::vector<FrameReport>& reports) {
  Localised method{std::move(name), {}};
  for (const FrameReport& r : reports) {
    method.poses.emplace_back();
    if (r.state == FrameState::Tracked) method.poses.back() = StampedPose{r.time, r.T_world_camera, r.covariance};
  }
  return method;
}

Localised by_ransac(const Camera& camera, const std::vector<LocalisedFrame>& frames, double sigma_px) {
  Localised method{kOpponent, {}};
  for (const LocalisedFrame& f : frames) {
    const auto T = solve_pnp_ransac_lm(camera, f.matches, sigma_px);
    method.poses.push_back(T ? std::optional(stamped(f, *T)) : std::nullopt);
  }
  return method;
}

Localised by_lm(const Camera& camera, const std::vector<LocalisedFrame>& frames) {
  Localised method{kLm, {}};
  for (const LocalisedFrame& f : frames) {
    const auto T = solve_pnp(camera, inliers_of(f), PnpMethod::EpnpLm);
    method.poses.push_back(T ? std::optional(stamped(f, *T)) : std::nullopt);
  }
  return method;
}

// Begins with the first two true poses, as in the paper; its noises are those that these very sightings make likeliest.
Localised by_paper_filter(const Camera& camera, const std::vector<LocalisedFrame>& frames, double sigma_px) {
  Localised method{kPaper, std::vector<std::optional<StampedPose>>(frames.size())};
  CameraRun run;
  std::vector<std::size_t> at;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (frames[k].report.state != FrameState::Tracked) continue;
    run.truth.push_back(stamped(frames[k], frames[k].T_world_camera_true));
    run.sightings.push_back(inliers_of(frames[k]));
    at.push_back(k);
  }
  if (run.truth.size() < 3) return method;
  const MotionNoise noise = tune_paper_noise(camera, std::span(&run, 1), sigma_px);
  const Trajectory estimate = estimate_by_paper_filter(camera, run, noise, sigma_px);
  for (std::size_t k = 0; k < estimate.size(); ++k) method.poses[at[k + 2]] = estimate[k];
  return method;
}

std::vector<std::size_t> located_by_all(const std::vector<Localised>& methods) {
  std::vector<std::size_t> frames;
  for (std::size_t k = 0; k < methods.front().poses.size(); ++k) {
    const auto has = [k](const Localised& m) { return m.poses[k].has_value(); };
    if (std::all_of(methods.begin(), methods.end(), has)) frames.push_back(k);
  }
  return frames;
}

Comparison compare(const std::vector<LocalisedFrame>& frames, const std::vector<Localised>& methods,
                   const Matrix6d& truth_covariance) {
  Comparison comparison;
  const std::vector<std::size_t> common = located_by_all(methods);
  for (std::size_t k : common) comparison.frames.push_back(frames[k].report.index);
  for (const Localised& method : methods) {
    PairedTrajectories pairs;
    for (std::size_t k : common) {
      pairs.truth.push_back(stamped(frames[k], frames[k].T_world_camera_true));
      pairs.estimate.push_back(*method.poses[k]);
    }
    const AbsoluteErrors absolute = absolute_errors(pairs);
    const RelativeErrors relative = relative_errors(pairs, FrameStep{1});
    Comparison::Errors errors{method.name, absolute.translation_m.values, absolute.rotation_deg.values, {}, {}, {}};
    for (std::size_t i = 0; i < relative.spans.size(); ++i) {
      const PoseSpan& span = relative.spans[i];
      if (comparison.frames[span.last] != comparison.frames[span.first] + 1) continue;
      errors.step_m.push_back(relative.translation_m.values[i]);
    }
    errors.against_exact_truth = consistency(pairs);
    for (StampedPose& pose : pairs.estimate) {
      if (pose.covariance) *pose.covariance += truth_covariance;
    }
    errors.consistency = consistency(pairs);
    comparison.methods.push_back(std::move(errors));
  }
  return comparison;
}

std::vector<int> lost_frames(const std::vector<LocalisedFrame>& frames, const Localised& method) {
  std::vector<int> lost;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (!method.poses[k]) lost.push_back(frames[k].report.index);
  }
  return lost;
}

const Comparison::Errors& errors_of(const Comparison& comparison, const std::string& name) {
  return *std::find_if(comparison.methods.begin(), comparison.methods.end(),
                       [&](const Comparison::Errors& e) { return e.name == name; });
}

void add_errors(ExperimentSection& section, const Comparison& comparison) {
  ReportTable table{fmt::format("{} frames, each in a map that it is not part of", comparison.frames.size()),
                    {"method", "position RMSE (mm)", "/ " + kOpponent, "rotation RMSE (deg)", "/ " + kOpponent,
                     "frame to frame (mm)", "/ " + kOpponent, "NEES per dof", "were the truth exact"},
                    {}};
  const Comparison::Errors& opponent = errors_of(comparison, kOpponent);
  for (const Comparison::Errors& e : comparison.methods) {
    nlohmann::json& summary = section.summary[e.name];
    std::vector<std::string> row{e.name};
    const auto add = [&](const char* what, const std::vector<double>& errors, const std::vector<double>& reference,
                         double unit) {
      const double rmse = summarise(errors).rmse;
      const Ratio ratio = ratio_of_rms_in_blocks(errors, reference, kBlock);
      row.push_back(fmt::format("{:.3f}", unit * rmse));
      row.push_back(with_interval(ratio));
      summary[what] = {{"rmse", rmse}, {"ratio", as_json(ratio)}};
    };
    add("position_m", e.position_m, opponent.position_m, 1e3);
    add("rotation_deg", e.rotation_deg, opponent.rotation_deg, 1.0);
    add("frame_to_frame_m", e.step_m, opponent.step_m, 1e3);
    for (const auto& [what, nees] : {std::pair{"nees_per_dof", e.consistency},
                                     std::pair{"nees_per_dof_against_exact_truth", e.against_exact_truth}}) {
      row.push_back(nees ? fmt::format("{:.2f}", nees->mean_per_degree) : "-");
      if (nees) summary[what] = nees->mean_per_degree;
    }
    table.rows.push_back(std::move(row));
  }
  section.tables.push_back(std::move(table));
}

void add_truth(ExperimentSection& section, const Matrix6d& P, std::size_t motions) {
  const Vector6d sigma = P.diagonal().cwiseSqrt();
  ReportTable table{fmt::format("The truth's own error, 1 sigma, from {} motions between frames of the map", motions),
                    {"", "x", "y", "z"},
                    {}};
  const auto add = [&](const char* name, const Eigen::Vector3d& s) {
    table.rows.push_back(
        {name, fmt::format("{:.3f}", s.x()), fmt::format("{:.3f}", s.y()), fmt::format("{:.3f}", s.z())});
  };
  add("position (mm)", 1e3 * sigma.head<3>());
  add("rotation (deg)", 180.0 / std::numbers::pi * sigma.tail<3>());
  section.tables.push_back(std::move(table));
  for (int i = 0; i < 6; ++i) section.summary["truth_sigma"].push_back(sigma(i));
}

Plot errors_by_frame(const Comparison& comparison) {
  Plot plot{"Position error by frame", "frame", "error (mm)", {}, false, false};
  for (const std::string& name : {kOpponent, kOurs}) {
    Series series{name, {}, {}, SeriesStyle::Line, std::nullopt};
    int before = -1;
    for (std::size_t i = 0; i < comparison.frames.size(); ++i) {
      if (i > 0 && comparison.frames[i] > before + 2) {  // a gap, unless it is a frame of the map
        series.x.push_back(before + 1);
        series.y.push_back(std::numeric_limits<double>::quiet_NaN());
      }
      before = comparison.frames[i];
      series.x.push_back(before);
      series.y.push_back(1e3 * errors_of(comparison, name).position_m[i]);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot cumulative_errors(const Comparison& comparison) {
  Plot plot{"Frames with at most this position error", "error (mm)", "frames (%)", {}, false, false};
  for (const std::string& name : {kOpponent, kOurs, kLm, kPaper}) {
    Series series{name, errors_of(comparison, name).position_m, {}, SeriesStyle::Line, std::nullopt};
    std::sort(series.x.begin(), series.x.end());
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      series.x[i] *= 1e3;
      series.y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(series.x.size()));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

ExperimentSection camera_known_map(const std::filesystem::path& video, const ExperimentContext& context) {
  ExperimentSection section{"known-map", "Video in a known map", {}, {}, {}, {}};
  CameraSource source = open_depth_video(video);
  const Camera camera = source.camera;
  const KnownMapOptions options = known_map_options(camera);
  const KnownMap known = make_known_map(std::move(source), options, context);
  const std::vector<LocalisedFrame> frames = localise_video(open_depth_video(video), known, options, context);
  if (context.stop.stop_requested()) return section;
  const double sigma_px = options.tracker.sigma_px;
  std::vector<FrameReport> reports;
  for (const LocalisedFrame& frame : frames) reports.push_back(frame.report);
  const std::vector<Localised> methods{ours(kOurs, reports),
                                       by_ransac(camera, frames, sigma_px),
                                       by_lm(camera, frames),
                                       by_paper_filter(camera, frames, sigma_px),
                                       ours("ours, lag 3", smoothed(reports, {.lag = 3})),
                                       ours("ours, smoothed", smoothed(reports))};
  const auto P_truth = truth_covariance(known.truth_residuals);
  const Comparison comparison = compare(frames, methods, P_truth.value_or(Matrix6d(Matrix6d::Zero())));
  if (comparison.frames.empty()) {
    throw InputError(video.string(), 0, "no frame was found in the map of the others",
                     "give a recording whose frames overlap");
  }
  section.remarks.push_back(fmt::format("The map: {} points of {} frames at their true poses.", known.map.points.size(),
                                        known.frames.size()));
  for (std::size_t m : {0u, 1u}) {
    const std::vector<int> lost = lost_frames(frames, methods[m]);
    section.remarks.push_back(
        lost.empty() ? fmt::format("{}: no frame lost.", methods[m].name)
                     : fmt::format("{}: lost {} frames: {}.", methods[m].name, lost.size(), fmt::join(lost, ", ")));
    section.summary["lost"][methods[m].name] = lost;
  }
  section.summary["frames"] = comparison.frames.size();
  add_errors(section, comparison);
  if (P_truth) add_truth(section, *P_truth, known.truth_residuals.size());
  section.figures.push_back({"known_map.png",
                             "The frames of the map are left out.",
                             {errors_by_frame(comparison), cumulative_errors(comparison)}});
  return section;
}

}  // namespace alidade
