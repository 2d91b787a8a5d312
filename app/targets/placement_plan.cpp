// SPDX-License-Identifier: Apache-2.0
#include "app/targets/placement_plan.h"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/targets/number_list.h"
#include "io/image_files.h"
#include "io/table.h"
#include "view/heat_map.h"
#include "view/report.h"

namespace alidade {
namespace {

Eigen::Vector3d vector_of(const char* option, const std::string& text) {
  const std::vector<double> numbers = parse_numbers(option, text);
  if (numbers.size() != 3) throw std::invalid_argument(fmt::format("{} must be three numbers x,y,z", option));
  return {numbers[0], numbers[1], numbers[2]};
}

std::vector<double> located(const PlacementMap& map) {
  std::vector<double> values;
  for (const PlacementPoint& point : map.points) {
    if (point.rms_m) values.push_back(*point.rms_m);
  }
  std::sort(values.begin(), values.end());
  return values;
}

HeatMap level_of(const PlacementMap& map, int level, std::span<const Receiver> receivers) {
  const auto per_level = static_cast<std::size_t>(map.counts[0] * map.counts[1]);
  const std::size_t begin = static_cast<std::size_t>(level) * per_level;
  const PlacementPoint& first = map.points[begin];
  HeatMap heat{fmt::format("z = {:g} m", first.p_world.z()),
               "x (m)",
               "y (m)",
               map.counts[0],
               map.counts[1],
               first.p_world.x(),
               first.p_world.y(),
               1.0,
               {},
               {}};
  if (map.counts[0] > 1) heat.step = map.points[begin + 1].p_world.x() - first.p_world.x();
  for (std::size_t i = begin; i < begin + per_level; ++i) {
    heat.values.push_back(map.points[i].rms_m.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  for (const Receiver& receiver : receivers) {
    const Eigen::Vector3d p = receiver.T_world_receiver.translation();
    heat.marks.push_back({p.x(), p.y(), receiver.name});
  }
  return heat;
}

cv::Mat draw_levels(const PlacementMap& map, std::span<const Receiver> receivers) {
  constexpr int kMost = 4;
  const int count = std::min(kMost, map.counts[2]);
  std::set<int> levels;
  for (int i = 0; i < count; ++i) levels.insert(count == 1 ? 0 : i * (map.counts[2] - 1) / (count - 1));
  std::vector<HeatMap> maps;
  for (const int level : levels) maps.push_back(level_of(map, level, receivers));
  return draw_heat_maps(maps);
}

void write_table(const std::filesystem::path& path, const PlacementMap& map) {
  constexpr std::array<std::string_view, 5> kColumns{"x_m", "y_m", "z_m", "receivers", "rms_m"};
  TableWriter table(path, kColumns);
  for (const PlacementPoint& point : map.points) {
    const TableCell rms = point.rms_m ? TableCell(*point.rms_m) : TableCell(std::string());
    table.write_row({point.p_world.x(), point.p_world.y(), point.p_world.z(), std::int64_t{point.receivers}, rms});
  }
  table.commit();
}

}  // namespace

void bind(OptionFields& fields, PlanOptions& options) {
  PlacementOptions& placement = options.placement;
  fields.add("plan.least_m", options.least_m, "m", "x,y,z of the corner of the volume with the least coordinates");
  fields.add("plan.greatest_m", options.greatest_m, "m", "the opposite corner");
  fields.add("plan.step_m", placement.step_m, "m", "between places");
  fields.add("plan.periods", placement.periods, "", "of looks that a position is from");
  fields.add("plan.period_s", placement.period_s, "s", "from look to look");
  fields.add("plan.delays_s", options.delays_s, "s", "of the receivers' looks, with commas between");
  fields.add("plan.v_m_s", options.v_m_s, "m/s", "x,y,z of the target's velocity");
  fields.add_check([&options] { validate(placement_of(options)); });
}

PlacementOptions placement_of(const PlanOptions& options) {
  PlacementOptions placement = options.placement;
  placement.least_world = vector_of("plan.least_m", options.least_m);
  placement.greatest_world = vector_of("plan.greatest_m", options.greatest_m);
  if (!(placement.greatest_world.array() >= placement.least_world.array()).all()) {
    throw std::invalid_argument(fmt::format("plan.greatest_m must be >= plan.least_m in each coordinate, got {} and {}",
                                            options.greatest_m, options.least_m));
  }
  placement.v_world = vector_of("plan.v_m_s", options.v_m_s);
  placement.delays_s = parse_numbers("plan.delays_s", options.delays_s);
  return placement;
}

nlohmann::json summary_of(const PlacementMap& map) {
  const std::vector<double> values = located(map);
  nlohmann::json summary{{"places", map.points.size()}, {"located", values.size()}};
  if (values.empty()) return summary;
  summary["best_rms_m"] = values.front();
  summary["median_rms_m"] = values[values.size() / 2];
  summary["worst_rms_m"] = values.back();
  return summary;
}

void write_plan(const PlacementMap& map, std::span<const Receiver> receivers, const ResultDirectory& directory,
                const std::vector<std::string>& arguments, const std::string& options_yaml) {
  write_table(directory.path("placement.csv"), map);
  const cv::Mat picture = draw_levels(map, receivers);
  write_image(directory.path("placement.png"), picture);
  const std::vector<double> values = located(map);
  Report report;
  report.title = "Placement of receivers";
  report.arguments = arguments;
  report.options = options_yaml;
  report.summary = {{"places", fmt::format("{}", map.points.size()), "", Verdict::None, ""},
                    {"where a target is located", fmt::format("{}", values.size()), "", Verdict::None, ""}};
  if (!values.empty()) {
    report.summary.push_back({"median bound", fmt::format("{:.3g}", values[values.size() / 2]), "m", Verdict::None,
                              "RMS of a position (Cramér–Rao)"});
    report.summary.push_back(
        {"best, worst", fmt::format("{:.3g}, {:.3g}", values.front(), values.back()), "m", Verdict::None, ""});
  }
  report.sections = {{"The bound over the volume",
                      {"RMS (m) that no unbiased estimate of a position can undercut; blank: not determined there."},
                      {},
                      {{picture, "", FigureFormat::Png}}}};
  report.links = {{"placement.csv", "all places"}};
  directory.write_text("options.yaml", options_yaml);
  write_report(directory.path("report.html"), report);
}

}  // namespace alidade
