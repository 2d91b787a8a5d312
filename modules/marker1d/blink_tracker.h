// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "marker1d/line_peaks.h"
#include "marker1d/marker_identity.h"

namespace alidade {

struct BlinkTrackerOptions {
  IdentityOptions identity;
  double speed_px = 5.0;  ///< per row, standard deviation of a new spot's motion: 2 m/s at 2 m, f 1600 px, 300 Hz
  double acceleration_px = 0.1;  ///< per row², standard deviation: 10 m/s² at the same
  double certainty = 0.999;      ///< least probability of an id; what is less certain is not reported
  double clear_choice = 0.95;    ///< least probability of a spot being where the track goes on
  double merging_px = 3.0;       ///< a lone spot between two tracks nearer than that may be both: not reported
  double most_unseen = 4.0;      ///< rows in which a spot was expected in vain, after which its track ends
  int most_delay_rows = 64;      ///< a row's spot not identified after so many rows never is; >= 2 periods of the codes
};

/// Throws std::invalid_argument naming the field, its value and the bound.
void validate(const BlinkTrackerOptions& options);

/// A spot and whose it is.
struct IdentifiedPeak {
  std::int64_t row = 0;
  int marker = 0;  ///< MarkerSign::id
  LinePeak peak;
};

/// Follows the spots of one detector from row to row and tells, by when they are lit and by their colours, which marker
/// each is. A track moves with constant velocity; peaks are given to tracks jointly, by position and by whether each is
/// expected to be lit, so that once the codes are known the rows in which only one of two crossing markers is lit keep
/// them apart. Where peaks could be either's nothing is reported, and a track that may have been exchanged for another
/// inherits that one's identity in the same measure, until its code decides. What is not certain is not reported.
class BlinkTracker {
 public:
  /// Throws std::invalid_argument for impossible options or signs that cannot be told apart.
  explicit BlinkTracker(std::vector<MarkerSign> signs, const BlinkTrackerOptions& options = {});

  /// The peaks of the next row; rows may be left out (lost exposures), but must increase (std::invalid_argument).
  /// Returns what became certain: spots of this row, and of earlier ones whose track was not identified before. In
  /// order of row.
  std::vector<IdentifiedPeak> advance(std::int64_t row, std::span<const LinePeak> peaks);

  /// Peaks so far, and how many of them were reported.
  std::int64_t seen() const { return seen_; }
  std::int64_t identified() const { return identified_; }

 private:
  struct Seen {
    std::int64_t row;
    LinePeak peak;
  };

  struct Track {
    Eigen::Vector2d state;       // position in px, speed in px/row
    Eigen::Matrix2d covariance;  // of it
    IdentityBelief belief;
    double lit_probability = 1.0;  // in the row at hand
    double unseen = 0.0;           // expected in vain since it was last seen, rows
    std::vector<Seen> waiting;     // not reported yet
  };

  void predict(std::int64_t row);
  Eigen::MatrixXd assign(std::span<const LinePeak> peaks) const;
  void update(std::size_t track, std::span<const LinePeak> peaks, const Eigen::MatrixXd& assigned,
              const std::vector<IdentityBelief>& beliefs);
  void see(Track& track, const LinePeak& peak, bool is_shared);
  bool is_shared(std::size_t track, const LinePeak& peak, const Eigen::MatrixXd& assigned) const;
  void begin_tracks(std::span<const LinePeak> peaks, const Eigen::MatrixXd& assigned);
  void end_tracks();
  std::vector<IdentifiedPeak> report();

  MarkerHypotheses hypotheses_;
  BlinkTrackerOptions options_;
  std::vector<Track> tracks_;
  std::int64_t row_ = 0;
  bool has_begun_ = false;
  std::int64_t seen_ = 0, identified_ = 0;
};

}  // namespace alidade
