// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/target_tracker_options.h"

#include <stdexcept>

#include <fmt/format.h>

namespace alidade {

void validate(const TargetTrackerOptions& o) {
  const auto require = [](bool holds, const char* field, double value, const char* bound) {
    if (!holds) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
  };
  validate(o.filter);
  require(o.period_s > 0.0, "period_s", o.period_s, "> 0 s");
  require(o.scan_s >= 0.0 && o.scan_s < o.period_s, "scan_s", o.scan_s, ">= 0 s and below period_s");
  require(o.lag_s >= 0.0, "lag_s", o.lag_s, ">= 0 s");
  require(o.detection_probability > 0.0 && o.detection_probability < 1.0, "detection_probability",
          o.detection_probability, "above 0 and below 1");
  require(o.false_bearings_per_sr > 0.0, "false_bearings_per_sr", o.false_bearings_per_sr, "> 0 /sr");
  require(o.gate_chi2 > 0.0, "gate_chi2", o.gate_chi2, "> 0");
  require(o.top_speed_m_s > 0.0, "top_speed_m_s", o.top_speed_m_s, "> 0 m/s");
  require(o.acceleration_sigma_m_s2 > 0.0, "acceleration_sigma_m_s2", o.acceleration_sigma_m_s2, "> 0 m/s^2");
  require(o.window_periods >= 1.0, "window_periods", o.window_periods, ">= 1");
  require(o.least_sightings >= 5, "least_sightings", o.least_sightings, ">= 5");
  require(o.greatest_misfit > 1.0, "greatest_misfit", o.greatest_misfit, "> 1");
  require(o.confirm_log_ratio >= o.start_log_ratio, "confirm_log_ratio", o.confirm_log_ratio, ">= start_log_ratio");
  require(o.greatest_log_ratio > 0.0, "greatest_log_ratio", o.greatest_log_ratio, "> 0");
  require(o.patience_periods > 1.5, "patience_periods", o.patience_periods, "> 1.5");
  require(o.temperature_sigma_k >= 0.0, "temperature_sigma_k", o.temperature_sigma_k, ">= 0 K");
  require(o.temperature_span_k > 0.0, "temperature_span_k", o.temperature_span_k, "> 0 K");
}

}  // namespace alidade
