// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/known_track.h"

#include <algorithm>
#include <stdexcept>

namespace alidade {

KnownTrack::KnownTrack(std::vector<TimedPosition> positions) {
  if (positions.size() < 4) throw std::invalid_argument("KnownTrack: four positions or more are wanted");
  for (const TimedPosition& position : positions) {
    const double t = to_seconds(position.time - Timestamp{});
    if (!times_s_.empty() && !(t > times_s_.back())) throw std::invalid_argument("KnownTrack: time does not increase");
    times_s_.push_back(t);
    positions_.push_back(position.p);
  }
}

std::optional<TrackPoint> KnownTrack::at(double t_s, double longest_gap_s) const {
  if (!(t_s >= begin_s()) || !(t_s <= end_s())) return std::nullopt;
  const auto next = std::upper_bound(times_s_.begin() + 2, times_s_.end() - 2, t_s);
  const auto i = static_cast<std::size_t>(next - times_s_.begin()) - 1;
  if (times_s_[i + 2] - times_s_[i - 1] > 3.0 * longest_gap_s) return std::nullopt;
  const double h = times_s_[i + 1] - times_s_[i], u = (t_s - times_s_[i]) / h;
  const auto slope = [&](std::size_t k) -> Eigen::Vector3d {
    return (positions_[k + 1] - positions_[k - 1]) / (times_s_[k + 1] - times_s_[k - 1]);
  };
  const Eigen::Vector3d a = positions_[i], b = positions_[i + 1], sa = h * slope(i), sb = h * slope(i + 1);
  const Eigen::Vector3d c2 = 3.0 * (b - a) - 2.0 * sa - sb, c3 = 2.0 * (a - b) + sa + sb;
  return TrackPoint{a + u * (sa + u * (c2 + u * c3)), (sa + u * (2.0 * c2 + 3.0 * u * c3)) / h};
}

}  // namespace alidade
