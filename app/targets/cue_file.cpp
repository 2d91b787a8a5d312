// SPDX-License-Identifier: Apache-2.0
#include "app/targets/cue_file.h"

#include <array>
#include <string_view>

namespace alidade {
namespace {

constexpr std::array<std::string_view, 11> kColumns{"told_ns",  "target",      "receiver",      "t_ns",
                                                    "own_t_ns", "azimuth_rad", "elevation_rad", "c_az_az",
                                                    "c_az_el",  "c_el_el",     "range_m"};

std::int64_t nanoseconds(Timestamp time) {
  return time.time_since_epoch().count();
}

}  // namespace

std::vector<AddressedCue> cues_for(std::span<const Receiver> receivers, std::span<const TargetEstimate> targets,
                                   Timestamp told, const CueOptions& options, const TargetMotion& motion) {
  std::vector<AddressedCue> cues;
  for (const TargetEstimate& target : targets) {
    if (target.status == TargetStatus::Tentative) continue;
    for (const Receiver& receiver : receivers) {
      const SteeredReceiver steered{receiver, options.slew_rad_s, options.settle_s, std::nullopt};
      if (const auto cue = cue_for(steered, target.state, told, motion)) {
        cues.push_back({told, target.id, receiver.id, *cue});
      }
    }
  }
  return cues;
}

CueFileWriter::CueFileWriter(const std::filesystem::path& path) : table_(path, kColumns) {}

void CueFileWriter::write(const AddressedCue& addressed) {
  const Cue& cue = addressed.cue;
  table_.write_row({nanoseconds(addressed.told), std::int64_t{addressed.target}, std::int64_t{addressed.receiver},
                    nanoseconds(cue.time), nanoseconds(cue.own_time), cue.azimuth_elevation[0],
                    cue.azimuth_elevation[1], cue.covariance(0, 0), cue.covariance(0, 1), cue.covariance(1, 1),
                    cue.range_m});
}

}  // namespace alidade
