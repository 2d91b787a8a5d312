// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/time.h"

namespace alidade {

/// Options of ShortTracks.
struct ShortTrackOptions {
  double least_response = 3.5;  ///< of a sighting to begin a track, or to go on with one that does not count yet
  int least_frames = 3;         ///< in which an object was seen before it counts
  /// Root of the sum of the squared responses of an object's sightings, before it counts: three of 5.2, or five of 4.
  /// Noise that passes a threshold of 3.5 needs to meet itself six times in a row for that.
  double least_evidence = 9.0;
  int most_missed = 3;            ///< frames in a row, after which it is forgotten
  double top_speed_px_s = 500.0;  ///< of an object seen once: 30 m/s at 60 m with a focal length of 1000 px
  double gate_px = 3.0;           ///< from where a steady motion leads to; turns and noise are smaller at 10 frames/s
  double least_travel_px = 1.5;   ///< since it was first seen: what flickers in its place is no moving object
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const ShortTrackOptions& options);

/// A place (px) where something stands out by so many standard deviations of the noise.
struct SeenDot {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double response = 0.0;  ///< bright: positive; an object stays what it is
};

/// Tells what moves on from frame to frame like an object from what is seen once, or stays. No track is kept beyond
/// that: who an object is, is found in space.
class ShortTracks {
 public:
  explicit ShortTracks(const ShortTrackOptions& options = {});

  /// Whether each of a frame's sightings continues something that has been seen often enough. Times increase, else
  /// std::invalid_argument.
  std::vector<bool> confirm(std::span<const SeenDot> sightings, Timestamp time);

 private:
  struct Track {
    Eigen::Vector2d first, last, velocity_px_s;
    Timestamp time;
    double response;   // of the latest
    double evidence2;  // sum of squared responses
    int seen = 1, missed = 0;
    bool is_confirmed = false;
  };
  bool reaches(const Track& track, const SeenDot& sighting, double since_s) const;
  void extend(Track& track, const SeenDot& sighting, Timestamp time) const;

  ShortTrackOptions options_;
  std::vector<Track> tracks_;
};

}  // namespace alidade
