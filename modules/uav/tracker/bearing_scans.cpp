// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/bearing_scans.h"

#include <algorithm>
#include <tuple>

namespace alidade {
namespace {

auto place_in_order(const Bearing& b) {
  const Eigen::Vector3d &d = b.direction_world, &o = b.origin_world;
  return std::make_tuple(b.time, b.receiver, d.x(), d.y(), d.z(), b.temperature_k.value_or(0.0), o.x(), o.y(), o.z(),
                         b.covariance(0, 0), b.covariance(1, 1), b.covariance(0, 1));
}

}  // namespace

bool comes_before(const Bearing& a, const Bearing& b) {
  if (a.time != b.time) return a.time < b.time;
  return place_in_order(a) < place_in_order(b);
}

std::vector<BearingScan> scans_of(std::span<const Bearing> in_order, double scan_s) {
  const auto length = from_seconds(scan_s);
  std::vector<BearingScan> scans;
  for (const Bearing& bearing : in_order) {
    const auto same = std::find_if(scans.rbegin(), scans.rend(),
                                   [&](const BearingScan& scan) { return scan.receiver == bearing.receiver; });
    if (same != scans.rend() && bearing.time <= same->begin() + length) {
      same->bearings.push_back(bearing);
    } else {
      scans.push_back({bearing.receiver, {bearing}});
    }
  }
  return scans;  // bearings are in order, so are the begins of scans
}

}  // namespace alidade
