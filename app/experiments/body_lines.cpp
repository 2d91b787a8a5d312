// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include <fmt/format.h>

#include "app/experiments/body_experiment.h"
#include "app/experiments/body_recording.h"
#include "datasets/line_image_scene.h"
#include "marker1d/blink_code.h"
#include "marker1d/line_signal.h"

namespace alidade {
namespace {

// What was read from images, and what was to be read.
struct ReadImages {
  std::vector<BodySceneFrame> truth;  // exact, with sigma the bound
  std::vector<LineReading> readings;
  std::int64_t spots = 0;
};

// Of the identified spots.
struct SignalScore {
  double right_share = 0.0;       // bear the id of the marker that is there
  double identified_share = 0.0;  // of all spots
  double found_share = 0.0;       // of all lit markers in view
  double to_bound = 0.0;          // RMS error of those that are right over the bound of a lone spot
  double to_sigma = 0.0;          // the same over the stated standard deviations
};

std::vector<LineSignalOptions> options_for(const LineImageScene& scene) {
  const LineImageNoise noise = noise_of(scene.look);
  std::vector<LineSignalOptions> options;
  for (const LineDetector& detector : scene.detectors) {
    options.push_back({});
    options.back().detector = detector.id;
    options.back().rate_hz = scene.scene.rate_hz;
    options.back().signs = scene.signs;
    options.back().peaks.noise = {noise.read, noise.shot};
    options.back().peaks.spot_sigma_px = scene.look.spot_sigma_px;
  }
  return options;
}

ReadImages read_images(const LineImageScene& scene, const std::string& stage, const ExperimentContext& context) {
  constexpr int kRows = 250;
  LineImageRecording recording(scene);
  LineSignals signals(options_for(scene));
  ReadImages read;
  const auto take = [&](const std::vector<LineReading>& found) {
    read.readings.insert(read.readings.end(), found.begin(), found.end());
  };
  while (const auto block = recording.next(kRows)) {
    if (context.stop.stop_requested()) return read;
    take(signals.read(block->images));
    read.truth.insert(read.truth.end(), block->frames.begin(), block->frames.end());
    if (context.progress) {
      context.progress({stage, static_cast<std::int64_t>(read.truth.size()), context.runs, ""});
    }
  }
  take(signals.finish());
  for (const LineSignalCounts& counts : signals.counts()) read.spots += counts.peaks;
  return read;
}

using Sight = std::tuple<Timestamp, int, int>;  // time, detector, marker

Sight sight_of(const LineReading& reading) {
  return {reading.time, reading.detector, reading.marker};
}

std::map<Sight, LineReading> sights_of(const std::vector<BodySceneFrame>& frames) {
  std::map<Sight, LineReading> sights;
  for (const BodySceneFrame& frame : frames) {
    for (const LineReading& reading : frame.readings) sights.emplace(sight_of(reading), reading);
  }
  return sights;
}

// Whether the marker that a reading names is there: within five standard deviations.
bool is_right(const LineReading& reading, const std::map<Sight, LineReading>& truth) {
  const auto at = truth.find(sight_of(reading));
  return at != truth.end() && std::abs(reading.value - at->second.value) <= 5.0 * reading.sigma;
}

SignalScore score_of(const ReadImages& read, const std::map<Sight, LineReading>& truth) {
  double right = 0, to_bound2 = 0, to_sigma2 = 0;
  for (const LineReading& reading : read.readings) {
    if (!is_right(reading, truth)) continue;
    const LineReading& exact = truth.at(sight_of(reading));
    const double error = reading.value - exact.value;
    ++right;
    to_bound2 += std::pow(error / exact.sigma, 2);
    to_sigma2 += std::pow(error / reading.sigma, 2);
  }
  const double identified = static_cast<double>(read.readings.size());
  return {right / identified, identified / static_cast<double>(read.spots), right / static_cast<double>(truth.size()),
          std::sqrt(to_bound2 / right), std::sqrt(to_sigma2 / right)};
}

// The frames of `truth` with the readings from images, in order of time, in place of what was to be read.
std::vector<BodySceneFrame> frames_of(const ReadImages& read, const std::map<Sight, LineReading>& truth) {
  std::vector<BodySceneFrame> frames;
  auto reading = read.readings.begin();
  for (const BodySceneFrame& exact : read.truth) {
    BodySceneFrame frame{exact.time, {}, {}};
    for (; reading != read.readings.end() && reading->time <= exact.time; ++reading) {
      frame.readings.push_back(*reading);
      frame.is_right.push_back(is_right(*reading, truth));
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::vector<BodySceneFrame> with_noise(std::vector<BodySceneFrame> frames, unsigned seed) {
  std::mt19937_64 random(seed);
  for (BodySceneFrame& frame : frames) frame = disturbed(std::move(frame), random);
  return frames;
}

struct LineCell {
  double snr = 0.0;
  SignalScore signal;
  BodyScore images, exact;  // poses, forward
};

std::optional<LineCell> score_cell(double snr, const ExperimentContext& context) {
  BodySceneOptions options;
  options.frames = context.runs;
  options.seed = context.seed;
  LineImageLook look;
  look.snr = snr;
  constexpr double kMostIn8Bits = 50.0, kHeightIn16Bits = 12000.0;
  if (snr > kMostIn8Bits) look.full_height = kHeightIn16Bits;
  const LineImageScene scene = line_image_scene(options, blink_codes(options.markers), look);
  const ReadImages read = read_images(scene, fmt::format("line images, SNR {:g}", snr), context);
  if (context.stop.stop_requested()) return std::nullopt;
  const auto truth = sights_of(read.truth);
  const auto score = [&](std::vector<BodySceneFrame> frames) {
    const BodyRecording recording = recording_of(scene.detectors, scene.bodies.front(), std::move(frames));
    return score_of(recording, track_by_ours(recording).forward);
  };
  return LineCell{snr, score_of(read, truth), score(frames_of(read, truth)),
                  score(with_noise(read.truth, context.seed))};
}

nlohmann::json summary_of(const LineCell& cell) {
  return {{"ids_right_share", cell.signal.right_share},
          {"identified_share", cell.signal.identified_share},
          {"found_share", cell.signal.found_share},
          {"position_to_bound", cell.signal.to_bound},
          {"position_to_sigma", cell.signal.to_sigma},
          {"pose_position_rms_m", cell.images.rms_m},
          {"pose_position_to_exact", cell.images.rms_m / cell.exact.rms_m},
          {"pose_rotation_to_exact", cell.images.rms_rad / cell.exact.rms_rad},
          {"answered_share", cell.images.answered_share}};
}

std::vector<std::string> row_of(const LineCell& cell) {
  const SignalScore& s = cell.signal;
  return {fmt::format("{:g}", cell.snr),
          fmt::format("{:.3f}", 100 * s.right_share),
          fmt::format("{:.2f}", 100 * s.identified_share),
          fmt::format("{:.2f}", 100 * s.found_share),
          fmt::format("{:.3f}", s.to_bound),
          fmt::format("{:.3f}", s.to_sigma),
          fmt::format("{:.4f}", 1e3 * cell.images.rms_m),
          fmt::format("{:.3f}", cell.images.rms_m / cell.exact.rms_m),
          fmt::format("{:.3f}", cell.images.rms_rad / cell.exact.rms_rad)};
}

}  // namespace

ExperimentSection body_lines(const ExperimentContext& context) {
  ExperimentSection section{
      "lines",
      "From line images of blinking markers",
      {"Each row of 2048 pixels is an exposure; four markers blink codes of 13 rows whose phase is unknown. SNR is the "
       "height of a spot over the noise of its highest pixel. Beside poses from images stand those from exact planes "
       "of all lit markers, disturbed by the bound of a spot that stands alone."},
      {},
      {},
      {}};
  ReportTable table{"Line images",
                    {"SNR", "ids right (%)", "identified (% of spots)", "found (% of lit)", "error / bound",
                     "error / sigma", "pose RMS (mm)", "position / exact", "rotation / exact"},
                    {}};
  for (const double snr : {5.0, 10.0, 20.0, 100.0}) {
    const auto cell = score_cell(snr, context);
    if (!cell) return section;
    table.rows.push_back(row_of(*cell));
    section.summary[fmt::format("{:g}", snr)] = summary_of(*cell);
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
