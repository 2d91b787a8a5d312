// SPDX-License-Identifier: Apache-2.0
#include "app/reading_residuals.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {

ReadingResiduals::ReadingResiduals(const std::vector<LineDetector>& detectors, const std::vector<RigidBody>& bodies) {
  for (const LineDetector& d : detectors) {
    detectors_[d.id] = {d.station, reads_pixels(d.model)};
    by_detector_[{d.id, reads_pixels(d.model)}];  // one that never reads has a row, too
  }
  for (const RigidBody& body : bodies) {
    for (const BodyMarker& marker : body.markers) markers_[marker.id] = body.name;
  }
}

void ReadingResiduals::add(std::span<const LineReading> readings,
                           std::span<const std::optional<ReadingResidual>> residuals,
                           const std::vector<bool>& is_inlier) {
  if (readings.size() != residuals.size() || readings.size() != is_inlier.size()) {
    throw std::invalid_argument(fmt::format("ReadingResiduals::add: {} readings, {} residuals, {} inlier marks",
                                            readings.size(), residuals.size(), is_inlier.size()));
  }
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const bool pixels = detectors_.at(readings[i].detector).second;
    for (Tally* tally : {&by_detector_[{readings[i].detector, pixels}], &by_marker_[{readings[i].marker, pixels}]}) {
      ++tally->readings;
      if (!is_inlier[i] || !residuals[i]) continue;
      const double whitened = residuals[i]->value / residuals[i]->sigma;
      tally->whitened_sum += whitened;
      tally->whitened_sum_of_squares += whitened * whitened;
      tally->inliers.add(residuals[i]->value);
    }
  }
}

std::vector<ResidualRow> ReadingResiduals::rows() const {
  std::vector<ResidualRow> rows;
  const auto append = [&rows](const char* of, const std::string& name, const Key& key, const Tally& tally) {
    const auto count = static_cast<double>(std::max<std::int64_t>(1, tally.inliers.count()));
    rows.push_back({of, key.first, name, key.second ? "px" : "rad", tally.readings, tally.inliers.count(),
                    std::sqrt(tally.whitened_sum_of_squares / count), tally.whitened_sum / count, tally.inliers.rms(),
                    tally.inliers.median_magnitude()});
  };
  for (const auto& [key, tally] : by_detector_) append("detector", detectors_.at(key.first).first, key, tally);
  for (const auto& [key, tally] : by_marker_) append("marker", markers_.at(key.first), key, tally);
  return rows;
}

std::vector<std::string> doubts_about(const std::vector<ResidualRow>& rows) {
  constexpr std::int64_t kEnough = 100;  // readings before anything is said
  constexpr double kLargeRms = 3.0;
  std::vector<std::string> doubts;
  for (const ResidualRow& row : rows) {
    const std::string who = fmt::format("{} {} ({})", row.of, row.id, row.name);
    if (row.of == "detector" && row.readings == 0) {
      doubts.push_back(who + " has no reading while the body is tracked");
    } else if (row.readings >= kEnough && 2 * row.inliers < row.readings) {
      const double share = 100.0 * static_cast<double>(row.inliers) / static_cast<double>(row.readings);
      doubts.push_back(fmt::format("{}: only {:.0f} % of its readings are explained: check its {}", who, share,
                                   row.of == "detector" ? "pose and model" : "place on the body and its identity"));
    } else if (row.inliers >= kEnough && row.rms_sigma > kLargeRms) {
      doubts.push_back(fmt::format("{}: residuals are {:.1f} times its sigma: calibrate it, or state a larger sigma",
                                   who, row.rms_sigma));
    }
  }
  return doubts;
}

}  // namespace alidade
