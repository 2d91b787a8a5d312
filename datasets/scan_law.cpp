// SPDX-License-Identifier: Apache-2.0
#include "datasets/scan_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alidade {
namespace {

using Eigen::Vector3d;

double delay_of(const TargetSceneOptions& options, std::size_t receiver) {
  return options.delays_s[receiver % options.delays_s.size()];
}

Vector3d sight(const Receiver& receiver, const TargetPath& path, Timestamp time) {
  return position_at(path, time) - receiver.T_world_receiver.translation();
}

// The fan beam stands at azimuth 0 at the receiver's delay; the target is met where it has moved to meanwhile.
std::optional<Timestamp> met_by_beam(const TargetSceneOptions& options, const Receiver& receiver,
                                     const TargetPath& path, Timestamp begin) {
  constexpr int kSteps = 30;  // a target turns about the receiver far more slowly than the beam
  const double delay = delay_of(options, static_cast<std::size_t>(receiver.id));
  double t = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d d = sight(receiver, path, begin + from_seconds(t));
    const double turns = std::atan2(d.y(), d.x()) / (2.0 * std::numbers::pi);
    const double next = delay + options.period_s * turns;
    t = next - options.period_s * std::floor(next / options.period_s);
  }
  const Vector3d d = sight(receiver, path, begin + from_seconds(t));
  const double turns = std::atan2(d.y(), d.x()) / (2.0 * std::numbers::pi) - (t - delay) / options.period_s;
  constexpr double kClosed = 1e-6;  // of a turn; else it crosses the period's border
  if (std::abs(turns - std::round(turns)) > kClosed) return std::nullopt;
  return begin + from_seconds(t);
}

// From each target to the nearest that was not looked at yet, from straight ahead on.
std::vector<std::optional<Timestamp>> steered(const TargetSceneOptions& options, const Receiver& receiver,
                                              std::span<const TargetPath> paths, Timestamp begin) {
  std::vector<std::optional<Timestamp>> times(paths.size());
  Timestamp now = begin + from_seconds(delay_of(options, static_cast<std::size_t>(receiver.id)));
  Vector3d beam = receiver.T_world_receiver.linear().col(2);
  for (std::size_t visited = 0; visited < paths.size(); ++visited) {
    double nearest = std::numbers::pi;
    std::size_t next = paths.size();
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const double angle = std::acos(std::clamp(beam.dot(sight(receiver, paths[i], now).normalized()), -1.0, 1.0));
      if (!times[i] && angle <= nearest) nearest = angle, next = i;
    }
    if (next == paths.size()) break;
    now += from_seconds(nearest / options.slew_rad_s);
    if (now >= begin + from_seconds(options.period_s)) break;
    times[next] = now;
    beam = sight(receiver, paths[next], now).normalized();
  }
  return times;
}

}  // namespace

std::vector<std::optional<Timestamp>> scan_times(const TargetSceneOptions& options, const Receiver& receiver,
                                                 std::span<const TargetPath> paths, Timestamp begin) {
  if (options.scan_law == ScanLaw::Cued && receiver.id > 0) return steered(options, receiver, paths, begin);
  std::vector<std::optional<Timestamp>> times;
  for (const TargetPath& path : paths) {
    times.push_back(options.scan_law == ScanLaw::Rotating
                        ? met_by_beam(options, receiver, path, begin)
                        : begin + from_seconds(delay_of(options, static_cast<std::size_t>(receiver.id))));
  }
  return times;
}

std::vector<Timestamp> scan_ends(const TargetSceneOptions& options, Timestamp begin) {
  std::vector<Timestamp> ends;
  for (int k = 0; k < options.receivers; ++k) {
    const bool is_at_once = options.scan_law == ScanLaw::Delays || (options.scan_law == ScanLaw::Cued && k == 0);
    const double end_s = is_at_once ? delay_of(options, static_cast<std::size_t>(k)) : options.period_s;
    ends.push_back(begin + from_seconds(end_s));
  }
  return ends;
}

}  // namespace alidade
