// SPDX-License-Identifier: Apache-2.0
#include "app/capture_record.h"

#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/boards/board_text.h"
#include "io/table.h"

namespace alidade {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::string_view name_of(CaptureState state) {
  switch (state) {
    case CaptureState::NoBoard:
      return "no board";
    case CaptureState::Moving:
      return "moving";
    case CaptureState::Still:
      return "still";
    case CaptureState::Accepted:
      return "accepted";
    case CaptureState::Repeated:
      return "repeated";
  }
  return "";
}

nlohmann::json to_json(const Eigen::Vector2d& pixel) {
  return {pixel.x(), pixel.y()};
}

nlohmann::json to_json(const BoardStance& stance) {
  return {{"centre_px", to_json(stance.centre_px)},
          {"tilt", name_of(stance.tilt)},
          {"tilt_deg", stance.tilt_rad / kDegree},
          {"image_share", stance.image_share}};
}

nlohmann::json to_json(const CaptureWish& wish) {
  nlohmann::json json = to_json(wish.stance);
  json["column"] = wish.column;
  json["row"] = wish.row;
  json["outline_px"] = nlohmann::json::array();
  for (const Eigen::Vector2d& pixel : wish.outline_px) json["outline_px"].push_back(to_json(pixel));
  return json;
}

nlohmann::json to_json(const CoverageShares& coverage) {
  return {{"positions", coverage.positions}, {"tilts", coverage.tilts}, {"distances", coverage.distances}};
}

nlohmann::json to_json(const CaptureEstimate& estimate) {
  return {{"fx_px", estimate.camera.fx},     {"fx_sigma_share", estimate.focal_sigma}, {"rms_px", estimate.rms_px},
          {"centre_px", estimate.centre_px}, {"corner_px", estimate.corner_px},        {"worst_px", estimate.worst_px}};
}

std::string place_words(const Eigen::Vector2d& pixel, const ImageExtent& image) {
  const double x = pixel.x() / image.width, y = pixel.y() / image.height;
  const std::string across = x < 0.42 ? "left" : x > 0.58 ? "right" : "";
  const std::string down = y < 0.42 ? "top" : y > 0.58 ? "bottom" : "";
  if (across.empty() && down.empty()) return "in the middle";
  return "at the " + down + (across.empty() || down.empty() ? "" : " ") + across;
}

std::string side_words(BoardTilt tilt) {
  const std::string name(name_of(tilt));  // "left nearer"
  return name.substr(0, name.find(' '));
}

std::string percent(double share) {
  return fmt::format("{:.0f} %", 100 * share);
}

}  // namespace

nlohmann::json guide_event(int frame, double time_s, const GuideStep& step) {
  nlohmann::json event{{"event", "guide"},
                       {"frame", frame},
                       {"t_s", time_s},
                       {"state", name_of(step.state)},
                       {"accepted", step.accepted},
                       {"is_enough", step.is_enough},
                       {"coverage", to_json(step.coverage)}};
  if (step.stance) event["board"] = to_json(*step.stance);
  if (step.wish) event["wish"] = to_json(*step.wish);
  if (step.estimate) event["estimate"] = to_json(*step.estimate);
  return event;
}

std::string describe(const CaptureWish& wish, const ImageExtent& image) {
  const BoardStance& s = wish.stance;
  return fmt::format("hold the board {}, its {} side {:.0f} deg nearer, filling {} of the image",
                     place_words(s.centre_px, image), side_words(s.tilt), s.tilt_rad / kDegree, percent(s.image_share));
}

std::vector<std::string> missing_words(const CaptureRecord& record) {
  const GuideStep& last = record.last;
  if (last.is_enough) return {};
  std::vector<std::string> missing;
  if (last.coverage.positions < 1) missing.push_back(percent(1 - last.coverage.positions) + " of the image are empty");
  if (last.coverage.tilts < 1) missing.emplace_back("the board was not tilted in all four directions");
  if (last.coverage.distances < 1) missing.emplace_back("the board was not shown both near and far");
  if (!last.estimate) {
    missing.emplace_back("the views do not tell the focal length");
  } else if (!(last.estimate->worst_px < record.enough_px)) {
    missing.push_back(fmt::format("pixels are certain to {:.2f} px only ({:.2f} are wanted)", last.estimate->worst_px,
                                  record.enough_px));
  }
  return missing;
}

void write_views(const CaptureRecord& record, const ResultDirectory& directory) {
  const std::vector<std::string_view> columns{"image",       "frame", "t_ns",     "centre_x_px",
                                              "centre_y_px", "tilt",  "tilt_deg", "image_share"};
  TableWriter table(directory.path("views.csv"), columns);
  for (std::size_t i = 0; i < record.accepted.size(); ++i) {
    const AcceptedImage& image = record.accepted[i];
    std::vector<TableCell> row{image.file, std::int64_t{image.frame},
                               std::int64_t{image.time.time_since_epoch().count()}};
    const auto& stance = record.stances[i];
    if (stance) {
      row.insert(row.end(), {stance->centre_px.x(), stance->centre_px.y(), std::string(name_of(stance->tilt)),
                             stance->tilt_rad / kDegree, stance->image_share});
    } else {
      row.resize(columns.size(), std::string());
    }
    table.write_row(row);
  }
  table.commit();
}

nlohmann::json summary_of(const CaptureRecord& record) {
  nlohmann::json summary{{"source", record.source},
                         {"board", board_text(record.board)},
                         {"width_px", record.image.width},
                         {"height_px", record.image.height},
                         {"frames", record.frames},
                         {"frames_with_board", record.boards},
                         {"accepted", record.accepted.size()},
                         {"is_enough", record.last.is_enough},
                         {"missing", missing_words(record)},
                         {"coverage", to_json(record.last.coverage)},
                         {"warnings", record.warnings},
                         {"interrupted", record.interrupted}};
  if (record.last.estimate) summary["estimate"] = to_json(*record.last.estimate);
  return summary;
}

Report report_of(const CaptureRecord& record, const std::vector<std::string>& arguments, const std::string& options) {
  Report report;
  report.title = "Guided capture";
  report.arguments = arguments;
  report.options = options;
  report.warnings = record.warnings;
  if (record.interrupted) report.warnings.emplace_back("interrupted before it was enough");
  const GuideStep& last = record.last;
  report.summary = {
      {"source", record.source, "", Verdict::None, ""},
      {"board", describe(record.board), "", Verdict::None, ""},
      {"images taken", fmt::format("{} of {}", record.accepted.size(), record.frames), "",
       last.is_enough ? Verdict::Good : Verdict::Poor,
       last.is_enough ? "enough" : fmt::format("not enough: {}", fmt::join(missing_words(record), "; "))},
      {"image covered", percent(last.coverage.positions), "", Verdict::None, ""},
      {"tilts shown", percent(last.coverage.tilts), "", Verdict::None, "of left, right, top and bottom nearer"},
      {"distances shown", percent(last.coverage.distances), "", Verdict::None, "of near and far"}};
  if (last.estimate) {
    report.summary.push_back({"uncertainty of pixels", fmt::format("{:.3f}", last.estimate->worst_px), "px",
                              last.estimate->worst_px < record.enough_px ? Verdict::Good : Verdict::Poor,
                              "where it is largest, at the boards' distance"});
    report.summary.push_back({"uncertainty of the focal length",
                              fmt::format("{:.3f}", 100 * last.estimate->focal_sigma), "%", Verdict::None,
                              "standard deviation"});
  }
  ReportSection section{"Last image", {}, {}, {}};
  if (!record.sample.empty()) section.figures.push_back({record.sample, "the last one taken", FigureFormat::Jpeg});
  report.sections = {section};
  report.links = {{"views.csv", "the images taken, and how the board stands in them"}};
  return report;
}

}  // namespace alidade
