// SPDX-License-Identifier: Apache-2.0
#include "app/line_image_source.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/errors.h"
#include "core/find_by_id.h"
#include "io/image_files.h"
#include "marker1d/blink_code.h"

namespace alidade {
namespace {

bool has_marker(std::span<const RigidBody> bodies, int id) {
  return std::any_of(bodies.begin(), bodies.end(), [id](const RigidBody& body) {
    return std::any_of(body.markers.begin(), body.markers.end(), [id](const BodyMarker& m) { return m.id == id; });
  });
}

int width_of(const std::filesystem::path& image, int id, std::span<const LineDetector> detectors) {
  const LineDetector* detector = find_by_id(detectors, id);
  if (!detector) throw InputError(image, 0, fmt::format("there is no detector {}", id), "list it with the detectors");
  const auto* lens = std::get_if<LineCamera>(&detector->model);
  if (!lens) {
    throw InputError(image, 0, fmt::format("detector {} has no line of pixels", id), "its model must be line_camera");
  }
  return lens->width;
}

}  // namespace

LineImageSource::LineImageSource(const std::filesystem::path& directory, std::span<const LineDetector> detectors,
                                 std::span<const RigidBody> bodies, std::stop_token stop)
    : stop_(std::move(stop)), set_(read_line_image_set(directory)) {
  const auto index = directory / "lines.yaml";
  if (const auto fault = find_fault(set_.signs)) throw InputError(index, 0, *fault, "");
  for (const MarkerSign& sign : set_.signs) {
    if (!has_marker(bodies, sign.id)) {
      throw InputError(index, 0, fmt::format("marker {} is on no body", sign.id), "list it in the body file");
    }
  }
  for (const LineImageFiles& files : set_.detectors) {
    strips_.push_back({files, width_of(files.parts.front(), files.detector, detectors), 0, {}, 0, 0, 0, 0});
    for (const auto& part : files.parts) bytes_ += file_bytes(part);
  }
}

std::optional<LineReading> LineImageSource::next() {
  while (readings_.empty() && !is_finished_) {
    if (stop_.stop_requested()) return std::nullopt;
    std::vector<LineReading> found;
    if (read_parts()) {
      found = signals_->read(next_rows());
    } else {
      is_finished_ = true;
      if (signals_) found = signals_->finish();
    }
    readings_.insert(readings_.end(), found.begin(), found.end());
  }
  if (readings_.empty()) return std::nullopt;
  const LineReading reading = readings_.front();
  readings_.pop_front();
  return reading;
}

SourceExtent LineImageSource::extent() const {
  std::int64_t done = 0;
  for (const Strip& strip : strips_) {
    done += strip.bytes + strip.part_bytes * strip.next_row / std::max(1, strip.image.rows);
  }
  return {done, bytes_};
}

std::vector<DetectorSignal> LineImageSource::signals() const {
  if (!signals_) return {};
  const auto counts = signals_->counts();
  std::vector<DetectorSignal> result;
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    result.push_back({strips_[i].files.detector, counts[i].rows, counts[i].peaks, counts[i].identified});
  }
  return result;
}

LineSignalOptions LineImageSource::options_of(const Strip& strip) const {
  LineSignalOptions options;
  options.detector = strip.files.detector;
  options.rate_hz = set_.rate_hz;
  options.first_time = set_.first_time;
  options.signs = set_.signs;
  options.peaks.noise = {set_.read_noise, set_.counts_per_electron};
  options.peaks.saturation = set_.saturation;
  if (set_.spot_sigma_px) {
    options.peaks.spot_sigma_px = *set_.spot_sigma_px;
  } else if (const auto seen = estimate_spot_sigma(strip.image, options.peaks)) {
    options.peaks.spot_sigma_px = *seen;
  }
  return options;
}

void LineImageSource::read_part(Strip& strip) const {
  strip.rows += strip.image.rows;
  strip.bytes += strip.part_bytes;
  strip.image = read_line_image(strip.files.parts[strip.next_part++]);
  strip.part_bytes = file_bytes(strip.path());
  strip.next_row = 0;
  if (strip.image.cols == strip.width) return;
  throw InputError(strip.path(), 0,
                   fmt::format("is {} px wide, detector {} is {}", strip.image.cols, strip.files.detector, strip.width),
                   "are these the detectors of this recording?");
}

// False at the end of all images.
bool LineImageSource::read_parts() {
  const Strip* ended = nullptr;
  const Strip* goes_on = nullptr;
  for (Strip& strip : strips_) {
    if (strip.is_used_up() && strip.next_part < strip.files.parts.size()) read_part(strip);
    (strip.is_used_up() ? ended : goes_on) = &strip;
  }
  if (ended && goes_on) {
    throw InputError(ended->path(), 0,
                     fmt::format("ends after row {}, {} goes on", ended->rows + ended->image.rows,
                                 goes_on->path().filename().string()),
                     "all detectors are recorded together");
  }
  if (!goes_on) return false;
  if (!signals_) {
    std::vector<LineSignalOptions> options;
    for (const Strip& strip : strips_) options.push_back(options_of(strip));
    signals_.emplace(options);
  }
  return true;
}

// As many of each as there are of all.
std::vector<cv::Mat> LineImageSource::next_rows() {
  int count = 64;
  for (const Strip& strip : strips_) count = std::min(count, strip.image.rows - strip.next_row);
  std::vector<cv::Mat> rows;
  for (Strip& strip : strips_) {
    rows.push_back(strip.image.rowRange(strip.next_row, strip.next_row + count));
    strip.next_row += count;
  }
  return rows;
}

}  // namespace alidade
