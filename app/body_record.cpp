// SPDX-License-Identifier: Apache-2.0
#include "app/body_record.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

void write_residuals(const std::filesystem::path& path, const std::vector<ResidualRow>& rows) {
  constexpr std::array<std::string_view, 10> kColumns{"of",      "id",        "name",       "unit", "readings",
                                                      "inliers", "rms_sigma", "mean_sigma", "rms",  "median_magnitude"};
  TableWriter table(path, kColumns);
  for (const ResidualRow& row : rows) {
    table.write_row({row.of, std::int64_t{row.id}, row.name, row.unit, row.readings, row.inliers, row.rms_sigma,
                     row.mean_sigma, row.rms, row.median_magnitude});
  }
  table.commit();
}

void keep_fullest(BodyTally& tally, const BodyEstimate& estimate, std::span<const LineReading> readings) {
  const auto inliers = static_cast<std::size_t>(estimate.inlier_count);
  if (tally.fullest && tally.fullest->readings.size() >= inliers) return;
  tally.fullest = BodySnapshot{estimate.state, {}};
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (estimate.is_inlier[i]) tally.fullest->readings.push_back(readings[i]);
  }
}

}  // namespace

bool BodyRun::has_answer() const {
  return std::any_of(tallies.begin(), tallies.end(), [](const BodyTally& tally) { return tally.tracked > 0; });
}

BodyRecord::BodyRecord(const ResultDirectory& directory, std::vector<LineDetector> detectors,
                       std::vector<RigidBody> bodies, PoseDetail detail)
    : directory_(directory), detectors_(detectors), files_(directory, bodies, detail), residuals_(detectors, bodies) {
  if (bodies.empty()) throw std::invalid_argument("BodyRecord: at least one body");
  pending_.resize(bodies.size());
  run_.tallies.resize(bodies.size());
  run_.detail = detail;
  run_.detectors = std::move(detectors);
  run_.bodies = std::move(bodies);
}

void BodyRecord::observe(std::size_t body, const BodyEstimate& estimate, std::span<const LineReading> readings) {
  if (run_.batches == 0) run_.first = estimate.time;
  if (run_.batches == 0 || estimate.time != run_.last) ++run_.batches;
  run_.last = estimate.time;
  pending_.at(body).push_back({estimate.time, readings.size()});
  BodyTally& tally = run_.tallies[body];
  // A start is made of readings before this batch, too: which of them fit is not told one by one.
  if (estimate.status != BodyStatus::Lost && estimate.is_inlier.size() != readings.size()) return;
  tally.readings += static_cast<std::int64_t>(readings.size());
  if (estimate.status != BodyStatus::Tracked) return;
  tally.explained += estimate.inlier_count;
  residuals_.add(readings, residuals_of(detectors_, run_.bodies[body], readings, estimate.state), estimate.is_inlier);
  keep_fullest(tally, estimate, readings);
}

void BodyRecord::add(std::size_t body, const BodyEstimate& estimate) {
  auto& pending = pending_.at(body);
  if (pending.empty() || pending.front().time != estimate.time) {
    throw std::invalid_argument(fmt::format("BodyRecord::add: the batch at {} s was not observed, or out of order",
                                            format_seconds(estimate.time)));
  }
  const std::size_t readings = pending.front().readings;
  pending.pop_front();
  files_.add(body, estimate, readings);
  BodyTally& tally = run_.tallies[body];
  BodySample sample{estimate.time, estimate.status, estimate.state.T_world_body,
                    estimate.state.covariance.topLeftCorner<6, 6>(), std::nullopt};
  const bool is_told = estimate.status == BodyStatus::Lost || estimate.is_inlier.size() == readings;
  if (readings > 0 && is_told)
    sample.inlier_share = static_cast<double>(estimate.inlier_count) / static_cast<double>(readings);
  ++(estimate.status == BodyStatus::Tracked     ? tally.tracked
     : estimate.status == BodyStatus::Ambiguous ? tally.ambiguous
                                                : tally.lost);
  if (estimate.status == BodyStatus::Tracked) {
    tally.position_sigma_sum_m += std::sqrt(sample.covariance.topLeftCorner<3, 3>().trace());
    tally.rotation_sigma_sum_rad += std::sqrt(sample.covariance.bottomRightCorner<3, 3>().trace());
  }
  tally.samples.add(std::move(sample));
}

BodyRun BodyRecord::commit() {
  run_.residuals = residuals_.rows();
  if (run_.has_answer()) run_.warnings = doubts_about(run_.residuals);
  write_residuals(directory_.path("residuals.csv"), run_.residuals);
  files_.commit();
  return std::move(run_);
}

}  // namespace alidade
