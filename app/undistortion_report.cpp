// SPDX-License-Identifier: Apache-2.0
#include "app/undistortion_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace alidade {

nlohmann::json summary_of(const UndistortionRecord& record) {
  const Camera& c = record.pinhole;
  nlohmann::json summary;
  summary["source"] = record.source;
  summary["frames"] = record.frames;
  summary["width_px"] = c.width;
  summary["height_px"] = c.height;
  summary["intrinsics_px"] = {{"fx", c.fx}, {"fy", c.fy}, {"cx", c.cx}, {"cy", c.cy}};
  summary["warnings"] = record.warnings;
  summary["interrupted"] = record.interrupted;
  return summary;
}

Report report_of(const UndistortionRecord& record, const std::vector<std::string>& arguments,
                 const std::string& options) {
  const Camera& c = record.pinhole;
  Report report;
  report.title = "Undistorted images";
  report.arguments = arguments;
  report.options = options;
  report.warnings = record.warnings;
  if (record.interrupted) report.warnings.emplace_back("interrupted: the frames after these are missing");
  report.summary = {
      {"source", record.source, "", Verdict::None, ""},
      {"frames", fmt::format("{}", record.frames), "", Verdict::None, ""},
      {"focal lengths", fmt::format("{:.3f}, {:.3f}", c.fx, c.fy), "px", Verdict::None, "of the pinhole camera"},
      {"principal point", fmt::format("{:.3f}, {:.3f}", c.cx, c.cy), "px", Verdict::None, "of the pinhole camera"}};
  ReportSection frames{"First frame", {}, {}, {}};
  if (!record.before.empty()) frames.figures.push_back({record.before, "as the lens saw it", FigureFormat::Jpeg});
  if (!record.after.empty()) frames.figures.push_back({record.after, "undistorted", FigureFormat::Jpeg});
  report.sections = {frames};
  report.links = {{"camera.yaml", "the pinhole camera of the undistorted images"}};
  return report;
}

}  // namespace alidade
