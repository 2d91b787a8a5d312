// SPDX-License-Identifier: Apache-2.0
#include "uav/video/short_tracks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

// A sighting that a track reaches, and how far it is from where the track leads.
struct Link {
  double distance_px;
  std::size_t track, sighting;
};

}  // namespace

void validate(const ShortTrackOptions& o) {
  const auto require = [](bool is_so, const char* what, double value) {
    if (!is_so) throw std::invalid_argument(fmt::format("{}, got {}", what, value));
  };
  require(o.least_response >= 0.0, "least_response must be >= 0", o.least_response);
  require(o.least_frames >= 1, "least_frames must be >= 1", o.least_frames);
  require(o.least_evidence >= 0.0, "least_evidence must be >= 0", o.least_evidence);
  require(o.most_missed >= 0, "most_missed must be >= 0", o.most_missed);
  require(o.top_speed_px_s > 0.0, "top_speed_px_s must be > 0 px/s", o.top_speed_px_s);
  require(o.gate_px > 0.0, "gate_px must be > 0 px", o.gate_px);
  require(o.least_travel_px >= 0.0, "least_travel_px must be >= 0 px", o.least_travel_px);
}

ShortTracks::ShortTracks(const ShortTrackOptions& options) : options_(options) {
  validate(options);
}

bool ShortTracks::reaches(const Track& track, const SeenDot& sighting, double since_s) const {
  if (sighting.response * track.response < 0.0) return false;
  if (!track.is_confirmed && std::abs(sighting.response) < options_.least_response) return false;
  const double distance_px = (sighting.pixel - track.last - since_s * track.velocity_px_s).norm();
  if (track.seen == 1) return distance_px <= options_.gate_px + options_.top_speed_px_s * since_s;
  return distance_px <= options_.gate_px * (1.0 + track.missed);
}

void ShortTracks::extend(Track& track, const SeenDot& sighting, Timestamp time) const {
  constexpr double kGain = 0.5;  // of the velocity by one more sighting
  const double since_s = to_seconds(time - track.time);
  const Eigen::Vector2d velocity = (sighting.pixel - track.last) / since_s;
  track.velocity_px_s += (track.seen == 1 ? 1.0 : kGain) * (velocity - track.velocity_px_s);
  track.last = sighting.pixel;
  track.response = sighting.response;
  track.evidence2 += sighting.response * sighting.response;
  track.time = time;
  track.missed = 0;
  ++track.seen;
  const bool has_moved = (sighting.pixel - track.first).norm() >= options_.least_travel_px;
  const bool is_evident = track.evidence2 >= options_.least_evidence * options_.least_evidence;
  track.is_confirmed = track.is_confirmed || (track.seen >= options_.least_frames && is_evident && has_moved);
}

std::vector<bool> ShortTracks::confirm(std::span<const SeenDot> sightings, Timestamp time) {
  std::vector<Link> links;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const double since_s = to_seconds(time - tracks_[i].time);
    if (!(since_s > 0.0)) throw std::invalid_argument("ShortTracks: times must increase");
    for (std::size_t j = 0; j < sightings.size(); ++j) {
      if (!reaches(tracks_[i], sightings[j], since_s)) continue;
      const double distance_px = (sightings[j].pixel - tracks_[i].last - since_s * tracks_[i].velocity_px_s).norm();
      // What is known longer chooses first.
      links.push_back({distance_px + (tracks_[i].is_confirmed ? 0.0 : 1e3) + (tracks_[i].seen == 1 ? 1e3 : 0.0), i, j});
    }
  }
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.distance_px < b.distance_px; });
  std::vector<bool> is_confirmed(sightings.size(), false), is_taken(sightings.size(), false);
  std::vector<bool> is_extended(tracks_.size(), false);
  for (const Link& link : links) {
    if (is_extended[link.track] || is_taken[link.sighting]) continue;
    is_extended[link.track] = is_taken[link.sighting] = true;
    extend(tracks_[link.track], sightings[link.sighting], time);
    is_confirmed[link.sighting] = tracks_[link.track].is_confirmed;
  }
  for (std::size_t i = 0; i < is_extended.size(); ++i) tracks_[i].missed += is_extended[i] ? 0 : 1;
  std::erase_if(tracks_, [&](const Track& track) { return track.missed > options_.most_missed; });
  for (std::size_t j = 0; j < sightings.size(); ++j) {
    if (is_taken[j] || std::abs(sightings[j].response) < options_.least_response) continue;
    const auto& [pixel, response] = sightings[j];
    tracks_.push_back({pixel, pixel, Eigen::Vector2d::Zero(), time, response, response * response});
  }
  return is_confirmed;
}

}  // namespace alidade
