// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "app/experiments/targets_experiment.h"
#include "app/experiments/tracker_runs.h"

namespace alidade {
namespace {

constexpr double kConeSr = 0.09546;  // of the 20° in which false bearings lie

// What the tracker is told of receivers is what is so.
TrackerCell cell_of(const std::string& name, TargetSceneOptions scene) {
  TrackerCell cell{name, std::move(scene), {}, 0.0};
  cell.tracker.detection_probability = std::min(0.99, cell.scene.detection_probability);
  cell.tracker.false_bearings_per_sr = std::max(0.5, cell.scene.false_bearings / kConeSr);
  return cell;
}

// 20 periods, Pd 0.95, half a false bearing per scan; every second target comes late or leaves early.
TargetSceneOptions standard_scene(int targets) {
  TargetSceneOptions scene;
  scene.targets = targets;
  scene.periods = 20;
  scene.detection_probability = 0.95;
  scene.false_bearings = 0.5;
  scene.comes_and_goes = true;
  return scene;
}

TrackerCell with(TrackerCell cell, ScanAssociation association) {
  cell.tracker.association = association;
  return cell;
}

std::vector<TrackerCell> standard_cells() {
  std::vector<TrackerCell> cells;
  for (const int targets : {2, 5}) {
    cells.push_back(cell_of(fmt::format("{} targets", targets), standard_scene(targets)));
    cells.push_back(with(cells.back(), ScanAssociation::NearestNeighbour));
    cells.back().name += ", nearest neighbour";
    cells.push_back(cells[cells.size() - 2]);
    cells.back().name += ", shuffled within 1 s";
    cells.back().shuffled_s = 0.999;
  }
  return cells;
}

std::vector<TrackerCell> sweep_cells() {
  std::vector<TrackerCell> cells;
  for (const double clutter : {0.0, 1.0, 3.0}) {
    TargetSceneOptions scene = standard_scene(5);
    scene.false_bearings = clutter;
    cells.push_back(cell_of(fmt::format("{} false bearings", clutter), scene));
  }
  for (const double detection : {1.0, 0.9, 0.8}) {
    TargetSceneOptions scene = standard_scene(5);
    scene.detection_probability = detection;
    cells.push_back(cell_of(fmt::format("detection {}", detection), scene));
  }
  for (const auto& [law, name] :
       {std::pair(ScanLaw::Rotating, "rotating receivers"), {ScanLaw::Cued, "cued receivers"}}) {
    TargetSceneOptions scene = standard_scene(2);
    scene.scan_law = law;
    cells.push_back(cell_of(name, scene));
  }
  return cells;
}

// In one heap: 1 m apart where they start, with the common scatter of 1 m/s and with a tenth of it.
std::vector<TrackerCell> spacing_cells() {
  std::vector<TrackerCell> cells;
  for (const double scatter : {1.0, 0.1}) {
    TargetSceneOptions scene = standard_scene(5);
    scene.comes_and_goes = false;
    scene.spread_m = 3.0;
    scene.least_distance_m = 1.0;
    scene.scatter_m_s = scatter;
    const TrackerCell cell = cell_of(fmt::format("scatter {} m/s", scatter), scene);
    cells.push_back(with(cell, ScanAssociation::NearestNeighbour));
    cells.back().name += ", nearest neighbour";
    cells.push_back(with(cell, ScanAssociation::Joint));
    cells.back().name += ", JPDA";
  }
  return cells;
}

// The filter knows how the targets move: straight on, or with gusts.
std::vector<TrackerCell> receiver_cells() {
  std::vector<TrackerCell> cells;
  for (const double agility : {0.0, 0.1}) {
    for (const int receivers : {3, 4, 6}) {
      TargetSceneOptions scene = standard_scene(2);
      scene.comes_and_goes = false;
      scene.receivers = receivers;
      scene.agility_m2_s3 = agility;
      cells.push_back(cell_of(fmt::format("{} receivers{}", receivers, agility > 0.0 ? ", gusts" : ""), scene));
      cells.back().tracker.filter.motion.acceleration_density = agility;
    }
  }
  return cells;
}

std::string with_interval(const Ratio& ratio) {
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", ratio.value, ratio.low, ratio.high);
}

// Runs the cells; adds a table and the numbers under `key`. False where the user stopped it.
bool add_cells(ExperimentSection& section, const std::string& title, const char* key,
               const std::vector<TrackerCell>& cells, const ExperimentContext& context) {
  ReportTable table{title,
                    {"condition", "GOSPA (m)", "OSPA (m)", "false ids per run", "switches per run", "RMS (m)",
                     "/ true association (95 %)", "/ bound (95 %)", "NEES per dof", "found after", "given up after"},
                    {}};
  for (const TrackerCell& cell : cells) {
    const TrackerScore s = score_tracker(cell, context);
    if (context.stop.stop_requested()) return false;
    section.summary[key][cell.name] = summary_of(s);
    table.rows.push_back({cell.name, fmt::format("{:.3f}", s.gospa_m), fmt::format("{:.3f}", s.ospa_m),
                          fmt::format("{:.3f}", s.false_ids_per_run), fmt::format("{:.3f}", s.switches_per_run),
                          fmt::format("{:.3f}", s.rms_m), with_interval(s.to_true_association),
                          with_interval(s.to_bound),
                          fmt::format("{:.3f} ({:.3f} to {:.3f})", s.nees.mean_per_degree, s.nees.lower, s.nees.upper),
                          fmt::format("{:.0f}, {:.0f}", s.found_99, s.found_worst),
                          fmt::format("{:.0f}, {:.0f}", s.given_up_99, s.given_up_worst)});
  }
  section.tables.push_back(std::move(table));
  return true;
}

}  // namespace

ExperimentSection targets_tracker(const ExperimentContext& context) {
  ExperimentSection section{
      "tracker",
      "The recursive tracker",
      {"Answers once a period, after its last look; tentative tracks do not count. An estimate is of the target within "
       "4.2 m that is paired with it at the least sum of squares; GOSPA and OSPA with that cutoff, order 2. True "
       "association: the same filter with the bearings' labels. Bound: posterior Cramer-Rao, of the filter's motion "
       "noise; where that is more than the flight has, an RMS below it is no error.",
       "Found, given up: periods from birth and death, of 99 % of the targets and of the worst.",
       "NEES of the last period, with the 95 % bounds of its mean where it is honest."},
      {},
      {},
      {}};
  const bool is_done =
      add_cells(section, "20 periods, detection 0.95, half a false bearing", "standard", standard_cells(), context) &&
      add_cells(section, "Five targets 1 m apart", "spacing", spacing_cells(), context) &&
      add_cells(section, "Straight flight, and gusts of 0.1 m2/s3, of which the filter knows", "receivers",
                receiver_cells(), context) &&
      add_cells(section, "Sweeps", "sweeps", sweep_cells(), context);
  if (is_done) section.remarks.push_back("False bearings: mean number per scan in a cone of 20 degrees.");
  return section;
}

}  // namespace alidade
