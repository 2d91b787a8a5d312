// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_picture.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "app/detector_scene.h"
#include "app/targets/receiver_scene.h"

namespace alidade {
namespace {

constexpr Rgb kSight{196, 200, 208};
constexpr std::size_t kMostNamed = 8;  // targets with a colour and a name of their own

// The targets that were seen longest, in order of identity.
std::vector<int> foremost(const TargetRun& run) {
  std::vector<int> ids;
  for (const auto& [id, tally] : run.targets) ids.push_back(id);
  std::stable_sort(ids.begin(), ids.end(),
                   [&](int a, int b) { return run.targets.at(a).rows > run.targets.at(b).rows; });
  ids.resize(std::min(ids.size(), kMostNamed));
  std::sort(ids.begin(), ids.end());
  return ids;
}

Eigen::AlignedBox3d box_of(const TargetRun& run) {
  Eigen::AlignedBox3d box;
  for (const auto& [id, tally] : run.targets) {
    for (const TargetRow& row : tally.samples.values()) box.extend(row.p_world);
  }
  return box;
}

// Lines of sight as far as the targets' middle.
void add_sights(const TargetRun& run, const Eigen::AlignedBox3d& box, Scene& scene) {
  constexpr std::size_t kMost = 90;
  const std::vector<SkySample>& sights = run.sights.values();
  if (box.isEmpty() || sights.empty()) return;
  const std::size_t every = sights.size() / kMost + 1;
  for (std::size_t i = 0; i < sights.size(); i += every) {
    const double reach = std::max(0.0, sights[i].direction_world.dot(box.center() - sights[i].origin_world));
    scene.paths.push_back(
        {{sights[i].origin_world, sights[i].origin_world + reach * sights[i].direction_world}, kSight, 0.7});
  }
  scene.legend.push_back({"lines of sight", kSight, PyramidStyle::Solid});
}

void add_covariances(const TargetTally& tally, double sigmas, const Rgb& colour, Scene& scene) {
  constexpr std::size_t kMost = 16;
  const std::vector<TargetRow>& rows = tally.samples.values();
  const std::size_t count = std::min(kMost, rows.size());
  for (std::size_t k = 0; k < count; ++k) {
    const TargetRow& row = rows[k * rows.size() / count];
    if (!row.covariance) continue;
    scene.translucent.push_back(
        covariance_ellipsoid(row.p_world, row.covariance->topLeftCorner<3, 3>(), sigmas, colour));
  }
}

double mean_sigma_m(const TargetRun& run) {
  double sum = 0.0;
  std::int64_t count = 0;
  for (const auto& [id, tally] : run.targets) sum += tally.position_sigma_sum_m, count += tally.rows;
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

ScenePath path_of(const TargetTally& tally, const Rgb& colour) {
  ScenePath path;
  path.colour = colour;
  for (const TargetRow& row : tally.samples.values()) path.points_world.push_back(row.p_world);
  return path;
}

std::map<int, ScenePath> true_paths(std::span<const TargetRow> truth) {
  std::map<int, ScenePath> paths;
  for (const TargetRow& row : truth) paths[row.target].points_world.push_back(row.p_world);
  return paths;
}

double seconds_since(Timestamp first, Timestamp time) {
  return to_seconds(time - first);
}

// Dashed lines, one of them with a name.
void add_truth(const std::map<int, Series>& lines, Plot& plot) {
  for (auto [target, line] : lines) {
    line.style = SeriesStyle::Dashed;
    line.colour = palette::kReference;
    if (plot.series.empty()) line.name = "truth";
    plot.series.push_back(std::move(line));
  }
}

}  // namespace

Scene scene_of(const TargetRun& run, std::span<const TargetRow> truth) {
  Scene scene;
  scene.up_world = Eigen::Vector3d::UnitZ();
  const Eigen::AlignedBox3d box = box_of(run);
  const double size_m = receiver_size_m(run.receivers, box);
  add_receivers(run.receivers, size_m, scene);
  add_sights(run, box, scene);
  for (auto& [target, path] : true_paths(truth)) {
    path.colour = palette::kReference;
    path.width_px = 4.0;
    scene.paths.push_back(std::move(path));
  }
  if (!truth.empty()) scene.legend.push_back({"true paths", palette::kReference, PyramidStyle::Solid});
  const double sigmas = enlargement(mean_sigma_m(run), 0.5 * size_m);
  const std::vector<int> named = foremost(run);
  for (const auto& [id, tally] : run.targets) {
    const auto place = std::find(named.begin(), named.end(), id);
    const Rgb colour =
        place == named.end() ? palette::kEstimate : curve_colour(static_cast<std::size_t>(place - named.begin()) + 1);
    scene.paths.push_back(path_of(tally, colour));
    if (place == named.end()) continue;
    scene.labels.push_back({tally.samples.values().back().p_world, fmt::format("{}", id), colour});
    add_covariances(tally, sigmas, colour, scene);
  }
  if (!run.targets.empty()) {
    scene.legend.push_back({fmt::format("targets, position within {:g} standard deviations", sigmas),
                            palette::kEstimate, PyramidStyle::Hollow});
  }
  return scene;
}

std::vector<Plot> plots_of(const TargetRun& run, std::span<const TargetRow> truth) {
  Plot above{"Paths from above", "x (m)", "y (m)", {}, true, false};
  Plot height{"Height", "time (s)", "z (m)", {}, false, false};
  Plot sigma{"Standard deviation of the position", "time (s)", "sigma (m)", {}, false, true};
  std::map<int, Series> true_ways, true_heights;
  for (const TargetRow& row : truth) {
    true_ways[row.target].x.push_back(row.p_world.x());
    true_ways[row.target].y.push_back(row.p_world.y());
    if (row.time < run.first || row.time > run.last) continue;
    true_heights[row.target].x.push_back(seconds_since(run.first, row.time));
    true_heights[row.target].y.push_back(row.p_world.z());
  }
  add_truth(true_ways, above);
  add_truth(true_heights, height);
  std::size_t curve = 1;
  for (const int id : foremost(run)) {
    Series from_above, over_time, spread;
    from_above.name = fmt::format("target {}", id);
    from_above.colour = over_time.colour = spread.colour = curve_colour(curve++);
    for (const TargetRow& row : run.targets.at(id).samples.values()) {
      from_above.x.push_back(row.p_world.x());
      from_above.y.push_back(row.p_world.y());
      over_time.x.push_back(seconds_since(run.first, row.time));
      over_time.y.push_back(row.p_world.z());
      spread.x.push_back(over_time.x.back());
      spread.y.push_back(row.covariance ? std::sqrt(row.covariance->topLeftCorner<3, 3>().trace()) : 0.0);
    }
    above.series.push_back(std::move(from_above));
    height.series.push_back(std::move(over_time));
    sigma.series.push_back(std::move(spread));
  }
  return {above, height, sigma};
}

}  // namespace alidade
