// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/target_tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include <Eigen/LU>

namespace alidade {
namespace {

constexpr double kSettleAfterLags = 2.0;  // bearings that nobody asks about are worked off now and then

void require_sense(const Bearing& bearing) {
  const bool is_finite = bearing.origin_world.allFinite() && bearing.covariance.allFinite() &&
                         bearing.direction_world.allFinite() && std::isfinite(bearing.temperature_k.value_or(0.0));
  if (!is_finite) throw std::invalid_argument("TargetTracker: a bearing's value is not finite");
  if (std::abs(bearing.direction_world.squaredNorm() - 1.0) > 1e-6) {
    throw std::invalid_argument("TargetTracker: a bearing's direction is not of unit length");
  }
  if (!(bearing.covariance(0, 0) > 0.0 && bearing.covariance.determinant() > 0.0)) {
    throw std::invalid_argument("TargetTracker: a bearing's covariance is not positive definite");
  }
}

TargetEstimate estimate_of(const TargetTrack& track, Timestamp time, const TargetTrackerOptions& options) {
  TargetEstimate estimate;
  estimate.id = track.id;
  estimate.state = track.state;
  if (track.is_confirmed) {
    estimate.status = is_coasting(track, time, options) ? TargetStatus::Coasting : TargetStatus::Confirmed;
  }
  estimate.sightings = track.sightings;
  estimate.temperature_mean_k = track.temperature.mean_k;
  estimate.temperature_spread_k = track.temperature.spread_k();
  estimate.temperature_readings = static_cast<int>(std::lround(track.temperature.count));
  return estimate;
}

}  // namespace

TargetTracker::TargetTracker(const TargetTrackerOptions& options) : options_(options) {
  validate(options_);
  checkpoints_.push_back({{}, Timestamp::min(), 0, Timestamp::min()});
}

bool TargetTracker::add(const Bearing& bearing) {
  require_sense(bearing);
  advance(has_begun_ ? std::max(now_, bearing.time) : bearing.time);
  if (bearing.time < settled_) {
    ++left_out_;
    return false;
  }
  bearings_.insert(std::upper_bound(bearings_.begin(), bearings_.end(), bearing, comes_before), bearing);
  while (checkpoints_.back().end >= bearing.time) checkpoints_.pop_back();
  return true;
}

void TargetTracker::advance(Timestamp time) {
  if (has_begun_ && time <= now_) return;
  has_begun_ = true;
  now_ = time;
  settled_ = time - from_seconds(options_.lag_s);
  const auto most = from_seconds(kSettleAfterLags * (options_.lag_s + options_.scan_s));
  if (!bearings_.empty() && bearings_.front().time < time - most) {
    catch_up();
    settle();
  }
}

bool TargetTracker::is_in(const Checkpoint& checkpoint, const BearingScan& scan) {
  return std::make_tuple(scan.begin(), scan.receiver) <= std::make_tuple(checkpoint.begin, checkpoint.receiver);
}

TargetTracker::Checkpoint TargetTracker::after(Checkpoint checkpoint, const BearingScan& scan) const {
  checkpoint.book = after_scan(std::move(checkpoint.book), scan, options_);
  checkpoint.begin = scan.begin();
  checkpoint.receiver = scan.receiver;
  checkpoint.end = scan.begin() + from_seconds(options_.scan_s);
  return checkpoint;
}

void TargetTracker::catch_up() {
  for (const BearingScan& scan : scans_of(bearings_, options_.scan_s)) {
    if (!is_in(checkpoints_.back(), scan)) checkpoints_.push_back(after(checkpoints_.back(), scan));
  }
}

// No bearing that may still come touches a checkpoint that ended before settled_; one of these is enough.
void TargetTracker::settle() {
  while (checkpoints_.size() > 1 && checkpoints_[1].end < settled_) checkpoints_.pop_front();
  std::vector<Bearing> pending;
  for (const BearingScan& scan : scans_of(bearings_, options_.scan_s)) {
    if (is_in(checkpoints_.front(), scan)) continue;
    pending.insert(pending.end(), scan.bearings.begin(), scan.bearings.end());
  }
  std::sort(pending.begin(), pending.end(), comes_before);
  bearings_ = std::move(pending);
}

TrackBook TargetTracker::book_at(Timestamp time) const {
  const auto later = std::find_if(checkpoints_.begin() + 1, checkpoints_.end(),
                                  [&](const Checkpoint& checkpoint) { return checkpoint.end > time; });
  Checkpoint checkpoint = *(later - 1);
  const auto end = std::find_if(bearings_.begin(), bearings_.end(), [&](const Bearing& b) { return b.time > time; });
  for (const BearingScan& scan : scans_of(std::span(bearings_.begin(), end), options_.scan_s)) {
    if (!is_in(checkpoint, scan)) checkpoint = after(std::move(checkpoint), scan);
  }
  return std::move(checkpoint.book);
}

std::vector<TargetEstimate> TargetTracker::estimates_at(Timestamp time) {
  catch_up();
  const bool is_newest = bearings_.empty() || time >= bearings_.back().time;
  const TrackBook book = is_newest ? checkpoints_.back().book : book_at(time);
  std::vector<TargetEstimate> estimates;
  for (const TargetTrack& known : book.tracks) {
    const TargetTrack track = without_scans(known, time, options_);
    if (!is_gone(track, time, options_)) estimates.push_back(estimate_of(track, time, options_));
  }
  return estimates;
}

}  // namespace alidade
