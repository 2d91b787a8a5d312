// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "io/table.h"
#include "uav/tracker/cue.h"
#include "uav/tracker/target_tracker.h"

namespace alidade {

struct CueOptions {
  double slew_rad_s = 1.0;  ///< how fast the receivers turn
  double settle_s = 0.0;    ///< and how long they then take until they can read
};

/// A cue, and whom it is for.
struct AddressedCue {
  Timestamp told{};
  int target = 0;
  int receiver = 0;
  Cue cue;
};

/// Where and when each receiver can see each confirmed target, told at `told`, every receiver as if it looked straight
/// ahead then; targets that it cannot reach in time are left out.
std::vector<AddressedCue> cues_for(std::span<const Receiver> receivers, std::span<const TargetEstimate> targets,
                                   Timestamp told, const CueOptions& options, const TargetMotion& motion);

/// Writes cues as they come: told_ns, target, receiver, t_ns (of the common clock), own_t_ns (of the receiver's),
/// azimuth_rad, elevation_rad (in its axes), their covariance c_az_az, c_az_el, c_el_el (rad²), range_m. Throws
/// DeviceError where the file system refuses.
class CueFileWriter {
 public:
  explicit CueFileWriter(const std::filesystem::path& path);
  void write(const AddressedCue& cue);
  void commit() { table_.commit(); }

 private:
  TableWriter table_;
};

}  // namespace alidade
