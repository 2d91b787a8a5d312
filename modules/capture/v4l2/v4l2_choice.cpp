// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alidade {
namespace {

constexpr double kUsualRateHz = 30;
constexpr double kNearEnough = 0.99;  // 29.97 Hz are 30 Hz to those who ask

double fastest(const V4l2Candidate& candidate) {
  if (candidate.periods.values.empty()) return std::numeric_limits<double>::infinity();
  double rate = 0;
  for (const v4l2_fract& period : candidate.periods.values) rate = std::max(rate, rate_of(period));
  return rate;
}

}  // namespace

const V4l2Candidate* preferred(std::span<const V4l2Candidate> candidates, std::optional<double> fps_hz) {
  double reachable = 0;
  for (const V4l2Candidate& candidate : candidates) reachable = std::max(reachable, fastest(candidate));
  const double wanted = std::min(fps_hz.value_or(kUsualRateHz), reachable);
  for (const V4l2Format& format : v4l2_formats()) {
    for (const V4l2Candidate& candidate : candidates) {
      if (candidate.format == &format && fastest(candidate) >= kNearEnough * wanted) return &candidate;
    }
  }
  return nullptr;
}

v4l2_fract nearest_period(const V4l2Periods& offered, double fps_hz) {
  const v4l2_fract exact{1000, static_cast<std::uint32_t>(std::lround(fps_hz * 1000))};
  if (offered.is_range || offered.values.empty()) return exact;
  const auto error = [&](const v4l2_fract& period) { return std::abs(rate_of(period) - fps_hz); };
  return *std::min_element(offered.values.begin(), offered.values.end(),
                           [&](const auto& a, const auto& b) { return error(a) < error(b); });
}

}  // namespace alidade
