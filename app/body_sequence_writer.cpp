// SPDX-License-Identifier: Apache-2.0
#include "app/body_sequence_writer.h"

#include "io/body_file.h"
#include "io/detector_file.h"

namespace alidade {

std::string truth_file(const std::vector<RigidBody>& bodies, std::size_t body) {
  return bodies.size() == 1 ? "truth.tum" : "truth_" + bodies[body].name + ".tum";
}

BodySequenceWriter::BodySequenceWriter(const ResultDirectory& directory, const std::vector<LineDetector>& detectors,
                                       const std::vector<RigidBody>& bodies)
    : readings_(directory.path("observations.csv"), detectors) {
  write_bodies(directory.path("body.csv"), bodies);
  write_detector_rig(directory.path("detectors.yaml"), {detectors, {}});
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    truth_.push_back(std::make_unique<TumWriter>(directory.path(truth_file(bodies, i)), "body"));
  }
}

void BodySequenceWriter::add(const BodySceneFrame& frame, const std::vector<Eigen::Isometry3d>& T_world_body) {
  for (const LineReading& reading : frame.readings) readings_.write(reading);
  for (std::size_t i = 0; i < truth_.size(); ++i) truth_[i]->write({frame.time, T_world_body.at(i), std::nullopt});
}

void BodySequenceWriter::finish() {
  readings_.commit();
  for (const auto& truth : truth_) truth->commit();
}

}  // namespace alidade
