// SPDX-License-Identifier: Apache-2.0
#include "marker1d/marker_identity.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "marker1d/blink_code.h"

namespace alidade {
namespace {

// A light that is none of the markers: how often it is seen, whenever that is, and how well its colour fits.
constexpr double kForeignSeen = 0.8, kForeignColour = 0.03;

}  // namespace

using Eigen::Index;

MarkerHypotheses::MarkerHypotheses(std::vector<MarkerSign> signs, const IdentityOptions& options)
    : signs_(std::move(signs)), options_(options) {
  if (const auto fault = find_fault(signs_)) throw std::invalid_argument(*fault);
  std::vector<double> shares;
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    const std::size_t length = signs_[s].code.size();
    const std::size_t first = signs_[s].phase ? static_cast<std::size_t>(*signs_[s].phase) : 0;
    const std::size_t phases = signs_[s].phase ? 1 : length;
    for (std::size_t k = 0; k < phases; ++k) {
      hypotheses_.push_back({s, (first + k) % length});
      shares.push_back((1.0 - options_.foreign) / static_cast<double>(signs_.size() * phases));
    }
  }
  shares.push_back(options_.foreign);
  unknown_ = Eigen::Map<const Eigen::ArrayXd>(shares.data(), static_cast<Index>(shares.size()));
}

IdentityBelief MarkerHypotheses::unknown() const {
  return unknown_;
}

bool MarkerHypotheses::is_lit(const Hypothesis& hypothesis, std::int64_t row) const {
  const std::string& code = signs_[hypothesis.sign].code;
  const auto length = static_cast<std::int64_t>(code.size());
  const std::int64_t step = (row % length + length + static_cast<std::int64_t>(hypothesis.shift)) % length;
  return code[static_cast<std::size_t>(step)] == '1';
}

double MarkerHypotheses::seen_probability(std::size_t hypothesis, std::int64_t row) const {
  if (hypothesis == hypotheses_.size()) return kForeignSeen;
  return is_lit(hypotheses_[hypothesis], row) ? options_.seen_when_lit : options_.seen_when_dark;
}

double MarkerHypotheses::lit_probability(const IdentityBelief& belief, std::int64_t row) const {
  double sum = kForeignSeen * belief(belief.size() - 1);
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    if (is_lit(hypotheses_[h], row)) sum += belief(static_cast<Index>(h));
  }
  return sum;
}

IdentityBelief MarkerHypotheses::after_seen(const IdentityBelief& belief, std::int64_t row,
                                            const LinePeak& peak) const {
  std::vector<double> colour;
  for (const MarkerSign& sign : signs_) colour.push_back(colour_likelihood(sign, peak));
  const bool has_colour = std::any_of(signs_.begin(), signs_.end(), [](const auto& sign) { return sign.colour; });
  IdentityBelief next = belief;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    next(static_cast<Index>(h)) *= seen_probability(h, row) * colour[hypotheses_[h].sign];
  }
  next(next.size() - 1) *= kForeignSeen * (has_colour ? kForeignColour : 1.0);
  return normalised(std::move(next));
}

IdentityBelief MarkerHypotheses::after_dark(const IdentityBelief& belief, std::int64_t row) const {
  IdentityBelief next = belief;
  for (std::size_t h = 0; h <= hypotheses_.size(); ++h) {
    next(static_cast<Index>(h)) *= 1.0 - seen_probability(h, row);
  }
  return normalised(std::move(next));
}

// The peak's distance from the colour's ray, which brightness does not move.
double MarkerHypotheses::colour_likelihood(const MarkerSign& sign, const LinePeak& peak) const {
  constexpr double kForeign = 1e-3;  // a reflection, a second light behind: never more certain than this
  const bool has_colour = sign.colour && peak.channel_sigma.minCoeff() > 0;
  if (!has_colour) return 1.0;
  const Eigen::Array3d colour = Eigen::Map<const Eigen::Array3d>(sign.colour->data());
  const Eigen::Array3d sigma2 =
      peak.channel_sigma.square() + std::pow(options_.colour_tolerance, 2) * peak.amplitude.square().sum();
  const double scale = (peak.amplitude * colour / sigma2).sum() / (colour.square() / sigma2).sum();
  const double chi2 = ((peak.amplitude - std::max(0.0, scale) * colour).square() / sigma2).sum();
  return std::exp(-0.5 * chi2) + kForeign;
}

IdentityBelief MarkerHypotheses::normalised(IdentityBelief belief) const {
  const double sum = belief.sum();
  if (!(sum > 0)) return unknown_;
  return (1.0 - options_.exchange) * belief / sum + options_.exchange * unknown_;
}

MarkerHypotheses::Answer MarkerHypotheses::most_likely(const IdentityBelief& belief) const {
  std::vector<double> probability(signs_.size(), 0.0);
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    probability[hypotheses_[h].sign] += belief(static_cast<Index>(h));
  }
  const auto best = std::max_element(probability.begin(), probability.end());
  return {signs_[static_cast<std::size_t>(best - probability.begin())].id, *best};
}

}  // namespace alidade
