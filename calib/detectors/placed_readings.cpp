// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/placed_readings.h"

#include <map>

namespace alidade {

DetectorScene scene_of(std::span<const LineDetector> detectors, const RigidBody& body) {
  DetectorScene scene{{detectors.begin(), detectors.end()}, {}};
  for (const BodyMarker& marker : body.markers) scene.markers.push_back(marker.p_body);
  return scene;
}

std::vector<PlacedReading> place_readings(std::span<const LineDetector> detectors, const RigidBody& body,
                                          std::span<const LineReading> readings) {
  std::map<int, std::size_t> detector_of, marker_of;
  for (std::size_t i = 0; i < detectors.size(); ++i) detector_of[detectors[i].id] = i;
  for (std::size_t i = 0; i < body.markers.size(); ++i) marker_of[body.markers[i].id] = i;
  std::vector<PlacedReading> placed;
  for (const LineReading& reading : readings) {
    const auto d = detector_of.find(reading.detector);
    const auto m = marker_of.find(reading.marker);
    if (d == detector_of.end() || m == marker_of.end()) continue;
    placed.push_back({d->second, m->second, to_seconds(reading.time.time_since_epoch()), reading.value,
                      reading.sigma > 0 ? reading.sigma : detectors[d->second].sigma});
  }
  return placed;
}

}  // namespace alidade
