// SPDX-License-Identifier: Apache-2.0
#include "app/body_sequence_writer.h"

#include "io/body_file.h"
#include "io/detector_file.h"

namespace alidade {

std::string truth_file(const BodyScene& scene, std::size_t body) {
  return scene.bodies().size() == 1 ? "truth.tum" : "truth_" + scene.bodies()[body].name + ".tum";
}

BodySequenceWriter::BodySequenceWriter(const ResultDirectory& directory, const BodyScene& scene)
    : readings_(directory.path("observations.csv"), scene.detectors()) {
  write_bodies(directory.path("body.csv"), scene.bodies());
  write_detector_rig(directory.path("detectors.yaml"), {scene.detectors(), {}});
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    truth_.push_back(std::make_unique<TumWriter>(directory.path(truth_file(scene, i)), "body"));
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
