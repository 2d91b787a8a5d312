// SPDX-License-Identifier: Apache-2.0
#include "app/record_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/decoding.h"
#include "capture/recording/recorded_frames.h"
#include "capture/recording/recording.h"
#include "capture/recording/recording_group.h"
#include "view/plot.h"

namespace alidade {
namespace {

std::string title_of(const RecordedCamera& camera) {
  return camera.name.empty() ? camera.session.camera.source : camera.name;
}

std::int64_t bytes_of(const RecordedCamera& camera) {
  std::int64_t bytes = 0;
  for (const RecordedFile& file : camera.session.files) bytes += file.bytes;
  return bytes;
}

std::string codec_of(const RecordedCamera& camera) {
  return camera.session.codec ? std::string(name_of(*camera.session.codec)) : "none";
}

RecordedCamera read_one(const std::filesystem::path& top, const std::filesystem::path& folder) {
  RecordedCamera camera;
  camera.folder = folder.lexically_relative(top).string();
  camera.name = camera.folder == "." ? "" : camera.folder;
  camera.session = read_session(folder);
  FrameRows rows(folder);
  while (const auto row = rows.next()) camera.times_s.push_back(to_seconds(row->time.time_since_epoch()));
  if (camera.times_s.empty()) return camera;
  const auto frame = decoded(open_recording(folder))->next();
  if (frame) camera.first = frame->image;
  return camera;
}

// Milliseconds from each frame to the next.
Plot interval_plot(const std::vector<RecordedCamera>& cameras) {
  Plot plot{"Intervals between frames", "time (s)", "interval (ms)", {}};
  for (const RecordedCamera& camera : cameras) {
    Series series{cameras.size() > 1 ? title_of(camera) : "", {}, {}, SeriesStyle::Dots, {}};
    for (std::size_t i = 1; i < camera.times_s.size(); ++i) {
      series.x.push_back(camera.times_s[i]);
      series.y.push_back(1e3 * (camera.times_s[i] - camera.times_s[i - 1]));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

cv::Mat thumbnail(const cv::Mat& image) {
  if (image.cols <= 640) return image;
  cv::Mat small;
  cv::resize(image, small, {640, 640 * image.rows / image.cols}, 0, 0, cv::INTER_AREA);
  return small;
}

nlohmann::json to_json(const RecordedCamera& camera) {
  const RecordingTotals& totals = camera.session.totals;
  nlohmann::json json{{"name", camera.name},
                      {"folder", camera.folder},
                      {"source", camera.session.camera.source},
                      {"width_px", camera.session.camera.size.width},
                      {"height_px", camera.session.camera.size.height},
                      {"pixel_format", name_of(camera.session.camera.format)},
                      {"codec", codec_of(camera)},
                      {"frames", totals.frames},
                      {"dropped", totals.dropped},
                      {"discarded", totals.discarded},
                      {"damaged", totals.damaged},
                      {"events", camera.session.events},
                      {"bytes", bytes_of(camera)},
                      {"rate_hz", mean_rate_hz(camera)}};
  if (camera.session.offset_at_end) json["host_minus_device_s"] = to_seconds(*camera.session.offset_at_end);
  for (const auto& [name, count] : camera.session.statistics) json["statistics"][name] = count;
  return json;
}

}  // namespace

std::vector<RecordedCamera> read_recorded(const std::filesystem::path& folder) {
  std::vector<RecordedCamera> cameras;
  double start_s = std::numeric_limits<double>::infinity();
  for (const std::filesystem::path& member : recordings_of(folder)) {
    cameras.push_back(read_one(folder, member));
    if (!cameras.back().times_s.empty()) start_s = std::min(start_s, cameras.back().times_s.front());
  }
  for (RecordedCamera& camera : cameras) {
    for (double& time_s : camera.times_s) time_s -= start_s;
  }
  return cameras;
}

double mean_rate_hz(const RecordedCamera& camera) {
  if (camera.times_s.size() < 2) return 0;
  return static_cast<double>(camera.times_s.size() - 1) / (camera.times_s.back() - camera.times_s.front());
}

std::vector<std::string> table_lines(const RecordRecord& record) {
  std::vector<std::string> lines;
  for (const RecordedCamera& camera : record.cameras) {
    const RecordingTotals& totals = camera.session.totals;
    lines.push_back(fmt::format(
        "{}: {} frames at {:.4g} Hz, {:.1f} MB ({}); {} dropped by the camera, {} discarded here, {} damaged",
        title_of(camera), totals.frames, mean_rate_hz(camera), 1e-6 * static_cast<double>(bytes_of(camera)),
        codec_of(camera), totals.dropped, totals.discarded, totals.damaged));
  }
  return lines;
}

nlohmann::json summary_of(const RecordRecord& record) {
  nlohmann::json cameras = nlohmann::json::array();
  for (const RecordedCamera& camera : record.cameras) cameras.push_back(to_json(camera));
  return {{"cameras", std::move(cameras)}, {"warnings", record.warnings}, {"interrupted", record.interrupted}};
}

Report report_of(const RecordRecord& record, const std::vector<std::string>& arguments, const std::string& options) {
  Report report;
  report.title = "Recording";
  report.arguments = arguments;
  report.options = options;
  report.warnings = record.warnings;
  ReportTable table{
      "Cameras", {"camera", "frames", "Hz", "dropped by the camera", "discarded here", "damaged", "codec", "MB"}, {}};
  ReportSection images{"First frames", {}, {}, {}};
  for (const RecordedCamera& camera : record.cameras) {
    const RecordingTotals& totals = camera.session.totals;
    table.rows.push_back({title_of(camera), fmt::format("{}", totals.frames),
                          fmt::format("{:.4g}", mean_rate_hz(camera)), fmt::format("{}", totals.dropped),
                          fmt::format("{}", totals.discarded), fmt::format("{}", totals.damaged), codec_of(camera),
                          fmt::format("{:.1f}", 1e-6 * static_cast<double>(bytes_of(camera)))});
    const bool is_whole = totals.dropped + totals.discarded == 0 && totals.damaged == 0 && totals.frames > 0;
    report.summary.push_back({title_of(camera), fmt::format("{}", totals.frames), "frames",
                              is_whole ? Verdict::Good : Verdict::Poor, is_whole ? "none lost" : "see below"});
    if (!camera.first.empty()) {
      images.figures.push_back({thumbnail(camera.first), title_of(camera), FigureFormat::Jpeg});
    }
    report.links.push_back({camera.folder + "/frames.csv", "times, counts and faults of every frame"});
    report.links.push_back({camera.folder + "/events.csv", "what happened to the camera"});
  }
  ReportSection timing{"Timing", {}, {}, {{draw_plot(interval_plot(record.cameras)), "", FigureFormat::Png}}};
  timing.tables.push_back(std::move(table));
  report.sections = {std::move(timing), std::move(images)};
  return report;
}

}  // namespace alidade
