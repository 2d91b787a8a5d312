// SPDX-License-Identifier: Apache-2.0
#include "marker1d/blink_tracker.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "estimation/joint_assignment.h"

namespace alidade {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kGate = 5.0;            // standard deviations
constexpr double kStrayPerPx = 1e-3;     // new and false spots
constexpr double kBroken_px = 15.0;      // a track whose position is less certain has no neighbourhood left
constexpr double kSameSpot = 0.98;       // least probability by which what comes tells who it was before
constexpr double kModelError_px = 0.03;  // of positions, beside their noise: spots are not quite Gaussian

double normal_density(double difference, double variance) {
  return std::exp(-0.5 * difference * difference / variance) / std::sqrt(2.0 * std::numbers::pi * variance);
}

}  // namespace

void validate(const BlinkTrackerOptions& options) {
  const auto require = [](bool holds, const char* field, double value, const char* bound) {
    if (holds) return;
    throw std::invalid_argument(fmt::format("BlinkTrackerOptions.{} must be {}, got {}", field, bound, value));
  };
  const auto is_share = [](double value) { return value > 0 && value < 1; };
  require(is_share(options.identity.seen_when_lit), "identity.seen_when_lit", options.identity.seen_when_lit, "0 to 1");
  require(is_share(options.identity.seen_when_dark), "identity.seen_when_dark", options.identity.seen_when_dark,
          "0 to 1");
  require(is_share(options.identity.foreign), "identity.foreign", options.identity.foreign, "0 to 1");
  require(options.speed_px > 0 && std::isfinite(options.speed_px), "speed_px", options.speed_px, "> 0");
  require(options.acceleration_px > 0 && std::isfinite(options.acceleration_px), "acceleration_px",
          options.acceleration_px, "> 0");
  require(options.certainty > 0.5 && options.certainty < 1, "certainty", options.certainty, "0.5 to 1");
  require(options.clear_choice > 0.5 && options.clear_choice < 1, "clear_choice", options.clear_choice, "0.5 to 1");
  require(options.merging_px >= 0, "merging_px", options.merging_px, ">= 0");
  require(options.most_unseen > 0, "most_unseen", options.most_unseen, "> 0");
  require(options.most_delay_rows >= 1, "most_delay_rows", options.most_delay_rows, ">= 1");
}

BlinkTracker::BlinkTracker(std::vector<MarkerSign> signs, const BlinkTrackerOptions& options)
    : hypotheses_(std::move(signs), options.identity), options_(options) {
  validate(options);
}

std::vector<IdentifiedPeak> BlinkTracker::advance(std::int64_t row, std::span<const LinePeak> peaks) {
  if (has_begun_ && row <= row_) {
    throw std::invalid_argument(fmt::format("rows must increase, got {} after {}", row, row_));
  }
  predict(row);
  const MatrixXd assigned = assign(peaks);
  std::vector<IdentityBelief> beliefs;
  for (const Track& track : tracks_) beliefs.push_back(track.belief);
  for (std::size_t i = 0; i < tracks_.size(); ++i) update(i, peaks, assigned, beliefs);
  begin_tracks(peaks, assigned);
  end_tracks();
  seen_ += static_cast<std::int64_t>(peaks.size());
  return report();
}

void BlinkTracker::predict(std::int64_t row) {
  constexpr std::int64_t kForgotten = 1000;  // rows, after which nothing is left of a position
  const double dt = has_begun_ ? static_cast<double>(std::min(row - row_, kForgotten)) : 0.0;
  row_ = row;
  has_begun_ = true;
  Eigen::Matrix2d F;
  F << 1.0, dt, 0.0, 1.0;
  const Eigen::Vector2d pushed(0.5 * dt * dt, dt);
  const Eigen::Matrix2d Q = options_.acceleration_px * options_.acceleration_px * pushed * pushed.transpose();
  for (Track& track : tracks_) {
    track.state = F * track.state;
    track.covariance = F * track.covariance * F.transpose() + Q;
    track.lit_probability = hypotheses_.lit_probability(track.belief, row);
  }
}

// How probable each peak (columns; the last: none) is to be each track's.
MatrixXd BlinkTracker::assign(std::span<const LinePeak> peaks) const {
  const auto tracks = static_cast<Index>(tracks_.size()), count = static_cast<Index>(peaks.size());
  MatrixXd likelihood = MatrixXd::Zero(tracks, count);
  VectorXd miss(tracks);
  const IdentityOptions& identity = options_.identity;
  for (Index i = 0; i < tracks; ++i) {
    const Track& track = tracks_[static_cast<std::size_t>(i)];
    const double seen =
        track.lit_probability * identity.seen_when_lit + (1.0 - track.lit_probability) * identity.seen_when_dark;
    miss(i) = 1.0 - seen;
    for (Index j = 0; j < count; ++j) {
      const LinePeak& peak = peaks[static_cast<std::size_t>(j)];
      const double variance = track.covariance(0, 0) + peak.sigma_px * peak.sigma_px + kModelError_px * kModelError_px;
      const double difference = peak.position_px - track.state(0);
      if (difference * difference > kGate * kGate * variance) continue;
      likelihood(i, j) = seen * normal_density(difference, variance) / kStrayPerPx;
    }
  }
  return joint_assignment(likelihood, miss);
}

void BlinkTracker::update(std::size_t index, std::span<const LinePeak> peaks, const MatrixXd& assigned,
                          const std::vector<IdentityBelief>& beliefs) {
  Track& track = tracks_[index];
  const auto i = static_cast<Index>(index);
  Index choice = 0;
  const double probability = assigned.row(i).maxCoeff(&choice);
  if (probability < options_.clear_choice) {
    track.unseen += 0.25 * track.lit_probability;  // it may well be there
    return;
  }
  if (choice + 1 == assigned.cols()) {
    track.unseen += track.lit_probability;
    track.belief = hypotheses_.after_dark(track.belief, row_);
    return;
  }
  // The peak may be another's after all: then this track is that one from now on.
  IdentityBelief belief = assigned(i, choice) * track.belief;
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    if (k != index) belief += assigned(static_cast<Index>(k), choice) * beliefs[k];
  }
  const LinePeak& peak = peaks[static_cast<std::size_t>(choice)];
  track.belief = hypotheses_.after_seen(belief / belief.sum(), row_, peak);
  if (probability < kSameSpot) track.waiting.clear();  // what comes may be of another marker
  see(track, peak, is_shared(index, peak, assigned));
}

void BlinkTracker::see(Track& track, const LinePeak& peak, bool is_shared) {
  track.unseen = 0.0;
  const double noise = is_shared ? options_.merging_px : std::hypot(peak.sigma_px, kModelError_px);
  const Eigen::Vector2d gain = track.covariance.col(0) / (track.covariance(0, 0) + noise * noise);
  track.state += gain * (peak.position_px - track.state(0));
  const Eigen::RowVector2d row = track.covariance.row(0);
  track.covariance -= gain * row;
  if (!is_shared) track.waiting.push_back({row_, peak});
}

// Whether another track that may be lit has no peak of its own so near that this one may be the light of both.
bool BlinkTracker::is_shared(std::size_t index, const LinePeak& peak, const MatrixXd& assigned) const {
  constexpr double kLit = 0.3, kOwn = 0.5;
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    if (k == index || tracks_[k].lit_probability < kLit) continue;
    const auto row = assigned.row(static_cast<Index>(k));
    const bool has_own = row.head(assigned.cols() - 1).sum() > kOwn;
    const double reach = options_.merging_px + 2.0 * std::sqrt(tracks_[k].covariance(0, 0));
    if (!has_own && std::abs(tracks_[k].state(0) - peak.position_px) < reach) return true;
  }
  return false;
}

void BlinkTracker::begin_tracks(std::span<const LinePeak> peaks, const MatrixXd& assigned) {
  constexpr double kClaimed = 0.1;
  for (std::size_t j = 0; j < peaks.size(); ++j) {
    if (assigned.rows() > 0 && assigned.col(static_cast<Index>(j)).sum() > kClaimed) continue;
    Track track;
    track.state << peaks[j].position_px, 0.0;
    track.covariance = Eigen::Vector2d(std::pow(peaks[j].sigma_px, 2) + kModelError_px * kModelError_px,
                                       options_.speed_px * options_.speed_px)
                           .asDiagonal();
    track.belief = hypotheses_.after_seen(hypotheses_.unknown(), row_, peaks[j]);
    track.waiting.push_back({row_, peaks[j]});
    tracks_.push_back(std::move(track));
  }
}

void BlinkTracker::end_tracks() {
  std::erase_if(tracks_, [&](const Track& track) {
    return track.unseen > options_.most_unseen || track.covariance(0, 0) > kBroken_px * kBroken_px;
  });
  for (Track& track : tracks_) {
    std::erase_if(track.waiting, [&](const Seen& seen) { return row_ - seen.row > options_.most_delay_rows; });
  }
}

// What is certain; of two tracks that are both certainly the same marker (a reflection blinks alike) neither.
std::vector<IdentifiedPeak> BlinkTracker::report() {
  std::map<int, int> claims;
  for (const Track& track : tracks_) {
    const auto answer = hypotheses_.most_likely(track.belief);
    if (answer.probability >= options_.certainty) ++claims[answer.marker];
  }
  std::vector<IdentifiedPeak> reported;
  for (Track& track : tracks_) {
    const auto answer = hypotheses_.most_likely(track.belief);
    if (answer.probability < options_.certainty || claims[answer.marker] > 1) continue;
    for (const Seen& seen : track.waiting) reported.push_back({seen.row, answer.marker, seen.peak});
    track.waiting.clear();
  }
  identified_ += static_cast<std::int64_t>(reported.size());
  std::stable_sort(reported.begin(), reported.end(),
                   [](const IdentifiedPeak& a, const IdentifiedPeak& b) { return a.row < b.row; });
  return reported;
}

}  // namespace alidade
