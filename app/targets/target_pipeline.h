// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "app/options_yaml.h"
#include "app/targets/cue_file.h"
#include "app/targets/target_record.h"
#include "uav/flight/flight_path.h"
#include "uav/paper/paper_tracker.h"
#include "uav/tracker/target_tracker.h"

namespace alidade {

enum class TargetMethod {
  Ours,    ///< any number of targets, as bearings come
  Flight,  ///< one target, seen all the time: smoothed over the whole flight, receivers' clocks found with it
  PaperAlternative,
  PaperProposed
};

struct TargetTrackOptions {
  TargetMethod method = TargetMethod::Ours;
  double output_s = 0.0;  ///< from one estimate to the next; 0: a period, 0.2 s at least
  double period_s = 0.0;  ///< TargetTrackerOptions::period_s; 0: a frame of the slowest camera, else 1 s
  /// TargetMotion::acceleration_density; below 0: 10 of cameras, whose frames show every manoeuvre of a drone, else
  /// 0.1.
  double acceleration_density = -1.0;
  /// BearingFilterOptions::added_sigma_rad; below 0: as the receivers' pose covariances say, and 3 mrad of cameras
  /// without one, as consumer cameras on tripods are off by.
  double added_sigma_rad = -1.0;
  double scan_s = 0.0;  ///< TargetTrackerOptions::scan_s; 0: 0.4 of a camera's frame, else 0.03 s
  TargetTrackerOptions ours;
  FlightPathOptions flight;
  PaperOptions paper;
  CueOptions cue;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const TargetTrackOptions& options);

/// Binds them to flags and keys of --config. `options` must outlive `fields`.
void bind(OptionFields& fields, TargetTrackOptions& options);

/// The options with nothing left open. Of cameras, whose frames come fast, new tracks take 9 sightings out of 10 frames
/// at least, and are given up after 20 frames at the earliest.
TargetTrackOptions settled(TargetTrackOptions options, std::optional<double> frame_interval_s,
                           std::span<const Receiver> receivers = {});

/// One line of words for the report: how targets are found.
std::string describe(const TargetTrackOptions& options);

/// Estimates as rows of a file.
TargetRow row_of(const TargetEstimate& estimate);
TargetRow row_of(const PaperTarget& target);

/// From bearings to a record of targets. Ours: in memory that does not grow, estimates come out once nothing older than
/// the tracker's lag can change them; a flight, and the paper's, which knows windows of periods alone, at the end.
class TargetPipeline {
 public:
  /// Called with the newest estimates of all targets at every output time, before late bearings may change them; an
  /// empty function is allowed.
  using LiveSink = std::function<void(Timestamp time, const std::vector<TargetEstimate>& targets)>;
  using CueSink = std::function<void(const AddressedCue& cue)>;

  /// Refers to the record. `options`: settled. `cue` is called for every receiver and target at every output time, as
  /// soon as that is known; an empty function is allowed.
  TargetPipeline(const TargetTrackOptions& options, TargetRecord& record, LiveSink live, CueSink cue = {});

  void add(const Bearing& bearing);

  /// What is not written down yet. Once, and last.
  void finish();

  /// The receivers with their clocks as a whole flight showed them to be; of the other methods empty.
  const std::vector<Receiver>& receivers_in_operation() const { return receivers_in_operation_; }

  /// Bearings that came too late to be of use.
  std::size_t left_out() const { return tracker_.left_out(); }

 private:
  void write_flight();
  void write_until(Timestamp time);
  void tell_newest();

  TargetTrackOptions options_;
  TargetRecord& record_;
  LiveSink live_;
  CueSink cue_;
  TargetTracker tracker_;
  std::vector<Bearing> bearings_;  // of the methods that answer at the end
  std::vector<Receiver> receivers_in_operation_;
  std::optional<Timestamp> next_output_, next_live_;
};

}  // namespace alidade
