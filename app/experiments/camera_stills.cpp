// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "app/camera_source.h"
#include "app/experiments/recording_experiment.h"
#include "core/errors.h"
#include "evaluation/absolute_error.h"
#include "tracking/camera_tracker.h"
#include "tracking/refinement.h"

namespace alidade {
namespace {

constexpr std::size_t kGiven = 2;  // poses that every method starts from

struct StillsTrack {
  std::string name;
  std::vector<FrameReport> reports;
  PointMap map;
  std::string picture{};  // its file; empty: none
};

// By frame after the given ones; a frame without a pose has NaN.
struct StillsErrors {
  std::vector<double> position_m, rotation_deg;
  int lost = 0;
};

CameraSource open_stills(const std::filesystem::path& folder) {
  const std::string remedy = "give a data set with a true pose of every image, such as Strecha's";
  CameraSource source = open_camera_source(folder.string(), {}, std::nullopt);
  if (!source.dataset || source.dataset->truth.empty())
    throw InputError(folder.string(), 0, "has no true poses", remedy);
  for (const DatasetFrame& frame : source.dataset->frames) {
    if (!frame.T_world_camera) throw InputError(frame.image.string(), 0, "has no true pose", remedy);
  }
  if (source.dataset->frames.size() <= kGiven) {
    throw InputError(folder.string(), 0, fmt::format("holds {} images, 3 are needed", source.dataset->frames.size()),
                     remedy);
  }
  return source;
}

Trajectory truth_of(const Dataset& dataset) {
  Trajectory truth;
  for (const DatasetFrame& frame : dataset.frames) truth.push_back({frame.time, *frame.T_world_camera, std::nullopt});
  return truth;
}

CameraTrackerOptions stills_options(const Camera& camera, PoseMethod method, bool local_refinement) {
  CameraTrackerOptions options;
  options.pose = method;
  options.features = FeatureMode::Sift;
  options.local_refinement = local_refinement;
  options.sift.most = suggested_feature_count(camera);
  return options;
}

struct StillsMethod {
  std::string name;
  PoseMethod pose = PoseMethod::Ekf;
  bool local_refinement = false;
  std::string picture{};  // file of the cameras over the map; empty: none
};

const std::string kGloballyRefined = "ours, global refinement";
const std::vector<StillsMethod> kMethods{{"EPnP", PoseMethod::Epnp},
                                         {"EPnP + LM", PoseMethod::EpnpLm},
                                         {"paper's filter", PoseMethod::EkfPaper, false, "stills_paper_filter.png"},
                                         {"ours", PoseMethod::Ekf, false, "stills_ours.png"},
                                         {"ours, local refinement", PoseMethod::Ekf, true}};

StillsTrack refined(const Camera& camera, const CameraTracker& tracker, const ExperimentContext& context) {
  RefinedTrack track = refine_globally(camera, tracker.live_map(), tracker.reports(), tracker.options(),
                                       tracker.anchored_keyframes(), context.progress, context.stop);
  return {kGloballyRefined, std::move(track.reports), without_unseen_points(std::move(track.live.map))};
}

// The method's track, and where it refines, the same refined globally.
std::vector<StillsTrack> track_stills(const std::filesystem::path& folder, const StillsMethod& method,
                                      const ExperimentContext& context) {
  CameraSource source = open_stills(folder);
  Trajectory given = truth_of(*source.dataset);
  given.resize(kGiven);
  CameraTracker tracker(source.camera, stills_options(source.camera, method.pose, method.local_refinement),
                        std::nullopt, given);
  const auto total = static_cast<int>(source.dataset->frames.size());
  while (const auto frame = next_image(source)) {
    if (context.stop.stop_requested()) return {};
    tracker.step(*frame);
    if (context.progress) context.progress({method.name, frame->index + 1, total, ""});
  }
  std::vector<StillsTrack> tracks{
      {method.name, tracker.reports(), without_unseen_points(tracker.live_map().map), method.picture}};
  if (method.local_refinement) tracks.push_back(refined(source.camera, tracker, context));
  return tracks;
}

StillsErrors errors_of(const StillsTrack& track, const Trajectory& truth) {
  StillsErrors errors;
  for (std::size_t k = kGiven; k < truth.size(); ++k) {
    const FrameReport& report = track.reports[k];
    if (report.state != FrameState::Tracked) {
      ++errors.lost;
      errors.position_m.push_back(std::numeric_limits<double>::quiet_NaN());
      errors.rotation_deg.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const AbsoluteErrors e = absolute_errors({{{report.time, report.T_world_camera, std::nullopt}}, {truth[k]}});
    errors.position_m.push_back(e.translation_m.values.front());
    errors.rotation_deg.push_back(e.rotation_deg.values.front());
  }
  return errors;
}

Statistics of_found(std::vector<double> errors) {
  std::erase_if(errors, [](double e) { return std::isnan(e); });
  return summarise(errors);
}

double not_worse_percent(const StillsErrors& errors, const StillsErrors& reference) {
  int good = 0;
  for (std::size_t k = 0; k < errors.position_m.size(); ++k) {
    good += errors.position_m[k] <= reference.position_m[k] || std::isnan(reference.position_m[k]);
  }
  return 100.0 * good / static_cast<double>(errors.position_m.size());
}

Series series_over_frames(const std::string& name, const std::vector<double>& errors, double unit) {
  Series series{name, {}, {}, SeriesStyle::Line, std::nullopt};
  for (std::size_t k = 0; k < errors.size(); ++k) {
    series.x.push_back(static_cast<double>(k + kGiven + 1));
    series.y.push_back(unit * errors[k]);
  }
  return series;
}

// Without what lies far behind: the cameras would be small beside it.
PointMap nearby(PointMap map, const Eigen::Vector3d& from) {
  std::vector<double> distances;
  for (const MapPoint& p : map.points) distances.push_back((p.p_world - from).norm());
  if (distances.empty()) return map;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  std::erase_if(map.points, [&](const MapPoint& p) { return (p.p_world - from).norm() > 2.0 * *middle; });
  return map;
}

ExperimentScene scene_of(const StillsTrack& track, const Trajectory& truth, const Camera& camera) {
  const Eigen::Vector3d start = truth.front().T_world_camera.translation();
  TrackPicture picture{nearby({track.map.points, {}}, start), {}, truth, camera, track.name};
  for (const FrameReport& r : track.reports) {
    if (r.has_pose()) picture.estimate.push_back({r.time, r.T_world_camera, std::nullopt});
  }
  return {track.picture, "True and estimated cameras over the map, by " + track.name + ".", std::move(picture)};
}

}  // namespace

ExperimentSection camera_stills(const std::filesystem::path& stills, const ExperimentContext& context) {
  ExperimentSection section{"stills", "Stills, their map made on the way (the paper's Fig. 6 to 8)", {}, {}, {}, {}};
  const CameraSource source = open_stills(stills);
  const Trajectory truth = truth_of(*source.dataset);
  const double path_m = path_length(truth);
  std::vector<StillsTrack> tracks;
  for (const StillsMethod& method : kMethods) {
    for (StillsTrack& track : track_stills(stills, method, context)) tracks.push_back(std::move(track));
    if (context.stop.stop_requested()) return section;
  }
  ReportTable table{
      fmt::format("{} images, the first two poses given, path {:.2f} m, no alignment", truth.size(), path_m),
      {"method", "position mean (mm)", "RMSE (mm)", "mean (% of path)", "rotation mean (deg)", "RMSE (deg)",
       "frames <= EPnP (%)", "lost"},
      {}};
  Plot position{"Position", "image", "error (% of path)", {}, false, true};
  Plot rotation{"Rotation", "image", "error (deg)", {}, false, true};
  const StillsErrors epnp = errors_of(tracks.front(), truth);
  for (const StillsTrack& track : tracks) {
    const StillsErrors errors = errors_of(track, truth);
    const Statistics p = of_found(errors.position_m), r = of_found(errors.rotation_deg);
    const double share = not_worse_percent(errors, epnp);
    table.rows.push_back({track.name, fmt::format("{:.2f}", 1e3 * p.mean), fmt::format("{:.2f}", 1e3 * p.rmse),
                          fmt::format("{:.4f}", 100.0 * p.mean / path_m), fmt::format("{:.4f}", r.mean),
                          fmt::format("{:.4f}", r.rmse), fmt::format("{:.0f}", share), std::to_string(errors.lost)});
    section.summary[track.name] = {{"position_mean_m", p.mean},   {"position_rmse_m", p.rmse},
                                   {"rotation_mean_deg", r.mean}, {"rotation_rmse_deg", r.rmse},
                                   {"frames_lost", errors.lost},  {"frames_not_worse_than_epnp_percent", share}};
    position.series.push_back(series_over_frames(track.name, errors.position_m, 100.0 / path_m));
    rotation.series.push_back(series_over_frames(track.name, errors.rotation_deg, 1.0));
    if (!track.picture.empty()) section.scenes.push_back(scene_of(track, truth, source.camera));
  }
  section.tables.push_back(std::move(table));
  section.remarks.push_back("The paper's filter linearises once, about its prediction: in stills, a baseline away.");
  section.figures.push_back({"stills.png", "Error of each image after the given two.", {position, rotation}});
  return section;
}

}  // namespace alidade
