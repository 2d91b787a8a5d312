// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/receiver_checks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "calib/receivers/resection.h"

namespace alidade {
namespace {

using Readings = std::vector<ReceiverReading>;

constexpr double kWorthwhile = 0.9;      // of the residuals' median: below it an explanation is better than another
constexpr double kExplained_rad = 0.01;  // what a pose and a clock leave where nothing is wrong is a tenth of it

struct Examined {
  const Receiver* given = nullptr;
  Readings readings;
  std::optional<ResectedReceiver> as_given;   // only the clock found anew
  std::optional<ResectedReceiver> posed;      // pose and clock
  std::optional<ResectedReceiver> refocused;  // where it is said to stand, focal lengths found
  bool is_told = false;

  Eigen::Vector3d given_place() const { return given->T_world_receiver.translation(); }
  Eigen::Vector3d found_place() const { return posed->receiver.T_world_receiver.translation(); }
  double off_m() const { return posed ? (found_place() - given_place()).norm() : 0.0; }
  double off_sigma_m() const { return posed->sigma.head<3>().norm(); }
};

Examined examine(const Receiver& given, std::span<const ReceiverReading> readings, const KnownTrack& track,
                 const ReceiverCheckOptions& options) {
  Examined e;
  e.given = &given;
  for (const ReceiverReading& reading : readings) {
    if (reading.receiver == given.id) e.readings.push_back(reading);
  }
  e.as_given = resect_receiver(given, e.readings, track,
                               {.keep_pose = true, .find_place = false, .find_turn = false, .find_readout = false});
  e.posed = resect_receiver(given, e.readings, track, {.search_s = options.search_s, .find_readout = false});
  e.refocused = resect_receiver(given, e.readings, track,
                                {.keep_pose = true, .find_place = false, .find_readout = false, .find_focal = true});
  return e;
}

bool is_misplaced(const Examined& e, const ReceiverCheckOptions& options) {
  return e.posed && e.off_m() > options.least_place_m + options.sigmas * e.off_sigma_m();
}

// Each resected nearer to where the other is said to stand than to its own place by far.
bool are_swapped(const Examined& a, const Examined& b) {
  constexpr double kFar = 0.2;
  const double apart = (a.given_place() - b.given_place()).norm();
  return (a.found_place() - b.given_place()).norm() < kFar * apart &&
         (b.found_place() - a.given_place()).norm() < kFar * apart;
}

void find_swaps(std::vector<Examined>& all, const ReceiverCheckOptions& options, std::vector<ReceiverFinding>& found) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      if (!is_misplaced(all[i], options) || !is_misplaced(all[j], options) || !are_swapped(all[i], all[j])) continue;
      found.push_back(
          {ReceiverFault::SwappedPlaces, all[i].given->id, all[j].given->id, all[i].off_m(), all[i].off_sigma_m()});
      all[i].is_told = all[j].is_told = true;
    }
  }
}

// The resection that leaves the least; the simplest where they are alike; null where none succeeded: of a camera that
// looks away from the track with the pose given, only a new pose does.
const ResectedReceiver* best_of(const Examined& e) {
  const ResectedReceiver* best = nullptr;
  for (const auto* one : {&e.as_given, &e.refocused, &e.posed}) {
    if (*one && (!best || (*one)->median_px < kWorthwhile * best->median_px)) best = &**one;
  }
  return best;
}

std::optional<ReceiverFinding> find_uneven_clock(const Examined& e, const KnownTrack& track,
                                                 const ReceiverCheckOptions& options) {
  std::optional<ReceiverFinding> worst;
  for (const ClockBlock& block : clock_blocks(best_of(e)->receiver, e.readings, track, options.blocks)) {
    const double late_s = std::abs(block.late_s);
    if (late_s < options.least_uneven_s + options.sigmas * block.sigma_s) continue;
    if (!worst || late_s > worst->size) {
      worst = ReceiverFinding{ReceiverFault::UnevenClock, e.given->id, -1, late_s, block.sigma_s};
    }
  }
  return worst;
}

std::optional<ReceiverFinding> find_wrong_focal(const Examined& e, const ReceiverCheckOptions& options) {
  if (!e.refocused || best_of(e) != &*e.refocused) return std::nullopt;
  const double scale = e.refocused->focal_scale, sigma = e.refocused->sigma[kFocal];
  if (std::abs(std::log(scale)) < options.least_focal + options.sigmas * sigma) return std::nullopt;
  return ReceiverFinding{ReceiverFault::WrongFocal, e.given->id, -1, scale, sigma};
}

std::optional<ReceiverFinding> find_fault_of(const Examined& e, const KnownTrack& track,
                                             const ReceiverCheckOptions& options) {
  const double left_rad = best_of(e)->median_px / e.given->camera->fx;
  if (auto focal = find_wrong_focal(e, options)) return focal;
  if (auto clock = find_uneven_clock(e, track, options)) return clock;
  if (is_misplaced(e, options)) {
    return ReceiverFinding{ReceiverFault::WrongPlace, e.given->id, -1, e.off_m(), e.off_sigma_m()};
  }
  if (left_rad > kExplained_rad) {
    return ReceiverFinding{ReceiverFault::Unexplained, e.given->id, -1, best_of(e)->median_px, 0.0};
  }
  return std::nullopt;
}

}  // namespace

std::string describe(const ReceiverFinding& f) {
  switch (f.fault) {
    case ReceiverFault::SwappedPlaces:
      return fmt::format("receivers {} and {}: each stands where the other is said to stand", f.receiver, f.other);
    case ReceiverFault::WrongPlace:
      return fmt::format("receiver {}: stands {:.1f} m from where it is said to stand", f.receiver, f.size);
    case ReceiverFault::WrongFocal:
      return fmt::format("receiver {}: its focal lengths are to be multiplied by {:.3f}", f.receiver, f.size);
    case ReceiverFault::UnevenClock:
      return fmt::format(
          "receiver {}: its clock is off by up to {:.2f} s from an even one: frames were dropped, or "
          "their rate varies",
          f.receiver, f.size);
    case ReceiverFault::Unexplained:
      return fmt::format("receiver {}: no pose and clock explain its readings, half are off by {:.0f} px or more",
                         f.receiver, f.size);
  }
  throw std::invalid_argument("describe: no such fault");
}

void validate(const ReceiverCheckOptions& options) {
  const auto need = [](double value, const char* name) {
    if (!(value > 0.0)) throw std::invalid_argument(fmt::format("{} must be > 0, got {}", name, value));
  };
  need(options.least_place_m, "least_place_m");
  need(options.least_focal, "least_focal");
  need(options.least_uneven_s, "least_uneven_s");
  need(options.sigmas, "sigmas");
  need(options.search_s, "search_s");
}

std::vector<ReceiverFinding> check_receivers(std::span<const Receiver> receivers,
                                             std::span<const ReceiverReading> readings, const KnownTrack& track,
                                             const ReceiverCheckOptions& options) {
  validate(options);
  std::vector<Examined> all;
  for (const Receiver& receiver : receivers) {
    if (!receiver.camera) throw std::invalid_argument("check_receivers: a receiver has no camera");
    Examined e = examine(receiver, readings, track, options);
    if (best_of(e)) all.push_back(std::move(e));
  }
  std::vector<ReceiverFinding> found;
  find_swaps(all, options, found);
  for (const Examined& e : all) {
    if (e.is_told) continue;
    if (const auto fault = find_fault_of(e, track, options)) found.push_back(*fault);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.receiver < b.receiver; });
  return found;
}

}  // namespace alidade
