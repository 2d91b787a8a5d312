// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "camera/marker_sign.h"
#include "marker1d/line_peaks.h"

namespace alidade {

/// How probable each hypothesis of MarkerHypotheses is, the last one being "none of the markers"; sums to 1.
using IdentityBelief = Eigen::ArrayXd;

struct IdentityOptions {
  double seen_when_lit = 0.95;   ///< probability; not 1: spots that merge, or are hidden
  double seen_when_dark = 0.02;  ///< probability that a foreign light is taken for the dark marker
  /// Probability per row that what is followed became another marker unnoticed, so that belief can recover.
  double exchange = 1e-6;
  /// Probability that a new spot is none of the markers: a lamp, a reflection.
  double foreign = 0.01;
  /// Standard deviation of a colour's share about the given one, beside the pixels' noise.
  double colour_tolerance = 0.05;
};

/// Which marker a followed spot may be, and which row of its code it shows: one hypothesis per marker and phase (one
/// where the phase is known), and that it is none of them. A spot is identified by its belief, moved by what each row
/// shows of it.
class MarkerHypotheses {
 public:
  /// Throws std::invalid_argument where find_fault(signs) has something to say.
  explicit MarkerHypotheses(std::vector<MarkerSign> signs, const IdentityOptions& options = {});

  /// Each marker as probable as any other.
  IdentityBelief unknown() const;

  /// Probability that the spot is lit in `row`.
  double lit_probability(const IdentityBelief& belief, std::int64_t row) const;

  /// The belief after the spot was seen in `row`, which also tells its colour, or was not.
  IdentityBelief after_seen(const IdentityBelief& belief, std::int64_t row, const LinePeak& peak) const;
  IdentityBelief after_dark(const IdentityBelief& belief, std::int64_t row) const;

  struct Answer {
    int marker = 0;            ///< MarkerSign::id
    double probability = 0.0;  ///< of all its phases together
  };
  Answer most_likely(const IdentityBelief& belief) const;

 private:
  struct Hypothesis {
    std::size_t sign;
    std::size_t shift;  // row 0 shows code[shift]
  };

  bool is_lit(const Hypothesis& hypothesis, std::int64_t row) const;
  double seen_probability(std::size_t hypothesis, std::int64_t row) const;
  double colour_likelihood(const MarkerSign& sign, const LinePeak& peak) const;
  IdentityBelief normalised(IdentityBelief belief) const;

  std::vector<MarkerSign> signs_;
  IdentityOptions options_;
  std::vector<Hypothesis> hypotheses_;
  IdentityBelief unknown_;
};

}  // namespace alidade
