// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "io/reading_file.h"

namespace alidade {

ReadingWriter::ReadingWriter(const std::filesystem::path& path, std::span<const LineDetector> detectors,
                             bool with_sigma)
    : file_(path), with_sigma_(with_sigma) {
  for (const LineDetector& d : detectors) reads_pixels_.emplace_back(d.id, reads_pixels(d.model));
  std::sort(reads_pixels_.begin(), reads_pixels_.end());
  has_pixels_ = std::any_of(reads_pixels_.begin(), reads_pixels_.end(), [](const auto& d) { return d.second; });
  has_angles_ = std::any_of(reads_pixels_.begin(), reads_pixels_.end(), [](const auto& d) { return !d.second; });
  std::string header = "t_ns,detector,marker";
  if (has_angles_) header += with_sigma_ ? ",value_rad,sigma_rad" : ",value_rad";
  if (has_pixels_) header += with_sigma_ ? ",value_px,sigma_px" : ",value_px";
  file_.write(header + '\n');
}

void ReadingWriter::write(const LineReading& reading) {
  const auto found = std::lower_bound(reads_pixels_.begin(), reads_pixels_.end(), std::pair(reading.detector, false));
  if (found == reads_pixels_.end() || found->first != reading.detector) {
    throw std::invalid_argument(fmt::format("ReadingWriter::write: no detector {}", reading.detector));
  }
  fmt::memory_buffer row;
  const auto out = std::back_inserter(row);
  fmt::format_to(out, "{},{},{}", reading.time.time_since_epoch().count(), reading.detector, reading.marker);
  for (const bool pixels : {false, true}) {
    if (!(pixels ? has_pixels_ : has_angles_)) continue;
    const bool here = found->second == pixels;
    here ? fmt::format_to(out, ",{}", reading.value) : fmt::format_to(out, ",");
    if (!with_sigma_) continue;
    here&& reading.sigma > 0 ? fmt::format_to(out, ",{}", reading.sigma) : fmt::format_to(out, ",");
  }
  row.push_back('\n');
  file_.write({row.data(), row.size()});
}

}  // namespace alidade
