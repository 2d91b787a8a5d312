// SPDX-License-Identifier: Apache-2.0
#include "marker1d/line_peaks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "marker1d/spot_fit.h"

namespace alidade {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kReach = 3.5;              // a fit's pixels, in spot widths beyond the outermost spot
constexpr std::size_t kMostSpots = 4;       // that are fitted together
constexpr double kLeastHeightRatio = 0.05;  // of a spot beside a higher one; below it is that one's halo

// Each pixel's excess in standard deviations of its noise, all channels together.
ArrayXd whitened(const LineRow& row) {
  return (row.signal / row.variance.sqrt()).rowwise().sum() / std::sqrt(static_cast<double>(row.signal.cols()));
}

// Response of the filter matched to a spot, in standard deviations.
ArrayXd matched(const ArrayXd& z, double spot_sigma_px) {
  const Index reach = static_cast<Index>(std::ceil(3.0 * spot_sigma_px));
  ArrayXd kernel(2 * reach + 1);
  for (Index k = -reach; k <= reach; ++k) {
    kernel(k + reach) = std::exp(-0.5 * std::pow(static_cast<double>(k) / spot_sigma_px, 2));
  }
  ArrayXd response(z.size());
  for (Index i = 0; i < z.size(); ++i) {
    const Index first = std::max<Index>(0, i - reach), last = std::min(z.size() - 1, i + reach);
    const auto part = kernel.segment(first - i + reach, last - first + 1);
    response(i) = (part * z.segment(first, last - first + 1)).sum() / std::sqrt(part.square().sum());
  }
  return response;
}

// Where a spot may be: a local maximum of the response, or the run of saturated pixels about it.
struct Candidate {
  double position = 0.0;
  double half_width = 0.0;  // of the saturated run; 0 without
  double response = 0.0;
};

Candidate candidate_at(const LineRow& row, const ArrayXd& response, Index i) {
  Candidate candidate{static_cast<double>(i), 0.0, response(i)};
  Index first = i, last = i;
  for (Index k = std::max<Index>(0, i - 1); k <= std::min(response.size() - 1, i + 1); ++k) {
    if (row.is_saturated(k)) first = last = k;
  }
  if (!row.is_saturated(first)) return candidate;
  while (first > 0 && row.is_saturated(first - 1)) --first;
  while (last + 1 < response.size() && row.is_saturated(last + 1)) ++last;
  candidate.position = 0.5 * static_cast<double>(first + last);
  candidate.half_width = 0.5 * static_cast<double>(last - first + 1);
  return candidate;
}

bool is_halo(const Candidate& candidate, const std::vector<Candidate>& all, double spot_sigma_px) {
  return std::any_of(all.begin(), all.end(), [&](const Candidate& other) {
    const double reach = 2.0 * kReach * spot_sigma_px + other.half_width;
    return std::abs(other.position - candidate.position) < reach &&
           candidate.response < kLeastHeightRatio * other.response;
  });
}

std::vector<Candidate> find_candidates(const LineRow& row, const LinePeakOptions& options) {
  const ArrayXd response = matched(whitened(row), options.spot_sigma_px);
  std::vector<Candidate> all;
  for (Index i = 0; i < response.size(); ++i) {
    const bool rises = i == 0 || response(i) > response(i - 1);
    const bool falls = i + 1 == response.size() || response(i) >= response(i + 1);
    if (!rises || !falls || !(response(i) > options.threshold)) continue;
    const Candidate candidate = candidate_at(row, response, i);
    const bool is_same_run = !all.empty() && candidate.half_width > 0 && all.back().position == candidate.position;
    if (!is_same_run) all.push_back(candidate);
  }
  std::vector<Candidate> kept;
  std::copy_if(all.begin(), all.end(), std::back_inserter(kept),
               [&](const Candidate& candidate) { return !is_halo(candidate, all, options.spot_sigma_px); });
  return kept;
}

using Group = std::span<const Candidate>;

// Candidates whose spots overlap, at most kMostSpots: a longer chain is cut where it is widest.
void append_groups(Group chain, std::vector<Group>& groups) {
  if (chain.size() <= kMostSpots) return groups.push_back(chain);
  std::size_t cut = 1;
  for (std::size_t i = 2; i < chain.size(); ++i) {
    if (chain[i].position - chain[i - 1].position > chain[cut].position - chain[cut - 1].position) cut = i;
  }
  append_groups(chain.first(cut), groups);
  append_groups(chain.subspan(cut), groups);
}

std::vector<Group> grouped(Group candidates, double spot_sigma_px) {
  std::vector<Group> groups;
  for (std::size_t first = 0, next = 1; first < candidates.size(); first = next++) {
    const auto gap = [&](std::size_t i) {
      return candidates[i].position - candidates[i].half_width - candidates[i - 1].position -
             candidates[i - 1].half_width;
    };
    while (next < candidates.size() && gap(next) < 2.0 * kReach * spot_sigma_px) ++next;
    append_groups(candidates.subspan(first, next - first), groups);
  }
  return groups;
}

PixelRange range_of(const LineRow& row, Group group, double spot_sigma_px) {
  double low = group.front().position, high = low;
  for (const Candidate& candidate : group) {
    low = std::min(low, candidate.position - candidate.half_width);
    high = std::max(high, candidate.position + candidate.half_width);
  }
  const double reach = kReach * spot_sigma_px;
  return {std::max(0, static_cast<int>(std::floor(low - reach))),
          std::min(static_cast<int>(row.signal.rows()) - 1, static_cast<int>(std::ceil(high + reach)))};
}

// Whether the scatter about a fit is beyond what its noise explains.
bool is_poor(const SpotFit& fit) {
  const double dof = fit.degrees_of_freedom;
  return fit.chi2 > dof + 2.5 * std::sqrt(2.0 * dof);
}

double height(const Spot& spot) {
  return spot.amplitude.sum();
}

// The fit with one spot more, two in place of one, where that explains the pixels much better and both are real: a spot
// that is a little wider than believed would become two of half its height, side by side.
std::optional<SpotFit> split(const LineRow& row, PixelRange range, const SpotFit& fit, double spot_sigma_px) {
  constexpr double kLeastGain = 30.0, kLeastRatio = 0.2, kLeastDistance = 0.7;
  std::optional<SpotFit> best;
  for (std::size_t j = 0; j < fit.spots.size(); ++j) {
    std::vector<double> starts;
    for (const Spot& spot : fit.spots) starts.push_back(spot.position_px);
    starts[j] -= 0.8 * spot_sigma_px;
    starts.insert(starts.begin() + static_cast<std::ptrdiff_t>(j) + 1, starts[j] + 1.6 * spot_sigma_px);
    const auto trial = fit_spots(row, range, starts, spot_sigma_px);
    if (!trial || (best && trial->chi2 > best->chi2)) continue;
    // An F test: what scatter the two leave, too, says how large the noise is where it is not known well.
    const double scatter = std::max(1.0, trial->chi2 / std::max(1, trial->degrees_of_freedom));
    if (fit.chi2 - trial->chi2 < kLeastGain * scatter) continue;
    const Spot &a = trial->spots[j], &b = trial->spots[j + 1];
    const double low = std::min(height(a), height(b)), high = std::max(height(a), height(b));
    if (low < kLeastRatio * high || b.position_px - a.position_px < kLeastDistance * spot_sigma_px) continue;
    best = trial;
  }
  return best;
}

std::optional<SpotFit> fit_group(const LineRow& row, Group group, double spot_sigma_px) {
  const PixelRange range = range_of(row, group, spot_sigma_px);
  std::vector<double> starts;
  for (const Candidate& candidate : group) starts.push_back(candidate.position);
  auto fit = fit_spots(row, range, starts, spot_sigma_px);
  while (fit && is_poor(*fit) && fit->spots.size() < kMostSpots) {
    const auto better = split(row, range, *fit, spot_sigma_px);
    if (!better) break;
    fit = better;
  }
  return fit;
}

// What is said of a spot whose flanks do not determine it: the run of saturated pixels, anywhere in it alike.
LinePeak unfitted(const LineRow& row, const Candidate& candidate, double spot_sigma_px) {
  LinePeak peak;
  const auto i = static_cast<Index>(std::lround(candidate.position));
  const Index channels = row.signal.cols();
  peak.position_px = candidate.position;
  peak.sigma_px = std::hypot(2.0 * candidate.half_width / std::sqrt(12.0), spot_sigma_px);
  peak.amplitude.head(channels) = row.signal.row(i).transpose();
  peak.channel_sigma.head(channels) = row.variance.row(i).sqrt().transpose() + row.signal.row(i).abs().transpose();
  peak.snr = candidate.response;
  peak.is_saturated = candidate.half_width > 0;
  peak.is_overlapped = !peak.is_saturated;
  return peak;
}

// Noise of the channels' sum where the spot is highest.
double noise_at(const LineRow& row, const Spot& spot) {
  const auto i = std::clamp<Index>(std::lround(spot.position_px), 0, row.signal.rows() - 1);
  return std::sqrt(row.variance.row(i).sum() + row.shot * height(spot));
}

std::vector<LinePeak> peaks_of(const LineRow& row, Group group, double spot_sigma_px) {
  std::vector<LinePeak> peaks;
  const auto fit = fit_group(row, group, spot_sigma_px);
  if (!fit) {
    for (const Candidate& candidate : group) peaks.push_back(unfitted(row, candidate, spot_sigma_px));
    return peaks;
  }
  const bool is_saturated =
      std::any_of(group.begin(), group.end(), [](const Candidate& candidate) { return candidate.half_width > 0; });
  const double excess = is_poor(*fit) ? std::sqrt(fit->chi2 / fit->degrees_of_freedom) : 1.0;
  for (const Spot& spot : fit->spots) {
    LinePeak peak;
    peak.position_px = spot.position_px;
    peak.sigma_px = spot.sigma_px * excess;
    peak.amplitude = spot.amplitude;
    peak.channel_sigma = spot.channel_sigma * excess;
    peak.snr = height(spot) / noise_at(row, spot);
    peak.is_saturated = is_saturated;
    peak.is_overlapped = fit->spots.size() > 1 || excess > 1.0;
    peaks.push_back(peak);
  }
  return peaks;
}

std::vector<LinePeak> find_peaks(const LineRow& row, const LinePeakOptions& options) {
  const auto candidates = find_candidates(row, options);
  std::vector<LinePeak> peaks;
  for (const Group group : grouped(candidates, options.spot_sigma_px)) {
    const auto found = peaks_of(row, group, options.spot_sigma_px);
    peaks.insert(peaks.end(), found.begin(), found.end());
  }
  std::sort(peaks.begin(), peaks.end(),
            [](const LinePeak& a, const LinePeak& b) { return a.position_px < b.position_px; });
  return peaks;
}

// A spot that stands alone, for the estimate of its width.
struct SingleSpot {
  const LineRow* row;
  PixelRange range;
  double position;
};

std::vector<SingleSpot> single_spots(const std::vector<LineRow>& rows, const LinePeakOptions& options) {
  constexpr double kClearing_px = 24.0, kReach_px = 12.0, kClear = 10.0;
  std::vector<SingleSpot> spots;
  for (const LineRow& row : rows) {
    const auto candidates = find_candidates(row, options);
    for (const Candidate& candidate : candidates) {
      const bool is_alone = std::all_of(candidates.begin(), candidates.end(), [&](const Candidate& other) {
        return &other == &candidate || std::abs(other.position - candidate.position) > kClearing_px;
      });
      const double last = static_cast<double>(row.signal.rows()) - 1.0;
      const bool is_inside = candidate.position >= kReach_px && candidate.position <= last - kReach_px;
      if (!is_alone || !is_inside || candidate.half_width > 0 || candidate.response < kClear) continue;
      const int centre = static_cast<int>(candidate.position), reach = static_cast<int>(kReach_px);
      spots.push_back({&row, {centre - reach, centre + reach}, candidate.position});
    }
  }
  return spots;
}

double chi2_at(std::span<const SingleSpot> spots, double spot_sigma_px) {
  double sum = 0.0;
  for (const SingleSpot& spot : spots) {
    const auto fit = fit_spots(*spot.row, spot.range, {&spot.position, 1}, spot_sigma_px);
    sum += fit ? fit->chi2 : spot.row->signal.middleRows(spot.range.first, 25).square().sum();
  }
  return sum;
}

}  // namespace

void validate(const LinePeakOptions& options) {
  const auto require = [](bool holds, const char* field, double value, const char* bound) {
    if (!holds) throw std::invalid_argument(fmt::format("LinePeakOptions.{} must be {}, got {}", field, bound, value));
  };
  require(options.spot_sigma_px >= 0.4 && options.spot_sigma_px <= 20, "spot_sigma_px", options.spot_sigma_px,
          "0.4 to 20 px (a narrower spot has no sub-pixel position)");
  require(options.threshold >= 3 && options.threshold < 1e3, "threshold", options.threshold, "3 to 1000");
  require(options.saturation >= 0, "saturation", options.saturation, ">= 0");
}

std::vector<LinePeak> find_peaks(const cv::Mat& row, const LinePeakOptions& options) {
  validate(options);
  return find_peaks(prepare_row(row, options.noise, options.saturation), options);
}

std::vector<LinePeak> find_peaks(std::span<const float> row, const LinePeakOptions& options) {
  validate(options);
  return find_peaks(prepare_row(row, options.noise, options.saturation), options);
}

std::optional<double> estimate_spot_sigma(const cv::Mat& rows, const LinePeakOptions& options) {
  constexpr int kRows = 64;
  constexpr double kNarrowest_px = 0.5, kWidest_px = 4.0, kStep = 1.12;
  validate(options);
  std::vector<LineRow> prepared;
  const int count = std::min(rows.rows, kRows);
  for (int k = 0; k < count; ++k) {
    const int index = static_cast<int>(static_cast<std::int64_t>(k) * rows.rows / count);
    prepared.push_back(prepare_row(rows.row(index), options.noise, options.saturation));
  }
  const auto spots = single_spots(prepared, options);
  if (spots.size() < 3) return std::nullopt;
  std::array<double, 3> chi2{chi2_at(spots, kNarrowest_px), chi2_at(spots, kNarrowest_px * kStep), 0.0};
  for (double width = kNarrowest_px * kStep; width < kWidest_px; width *= kStep) {
    chi2[2] = chi2_at(spots, width * kStep);
    if (chi2[1] <= chi2[0] && chi2[1] <= chi2[2]) {  // the vertex of the parabola over the width's logarithm
      const double bend = chi2[0] - 2.0 * chi2[1] + chi2[2];
      return width * std::pow(kStep, bend > 0 ? 0.5 * (chi2[0] - chi2[2]) / bend : 0.0);
    }
    chi2[0] = chi2[1];
    chi2[1] = chi2[2];
  }
  return std::nullopt;
}

}  // namespace alidade
