// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/spline_path.h"

#include <algorithm>
#include <cmath>

namespace alidade {

Eigen::Vector4d spline_weights(double u) {
  const double u2 = u * u, u3 = u2 * u;
  return Eigen::Vector4d(1.0 - 3.0 * u + 3.0 * u2 - u3, 4.0 - 6.0 * u2 + 3.0 * u3, 1.0 + 3.0 * u + 3.0 * u2 - 3.0 * u3,
                         u3) /
         6.0;
}

Eigen::Vector4d spline_slopes(double u) {
  const double u2 = u * u;
  return Eigen::Vector4d(-1.0 + 2.0 * u - u2, -4.0 * u + 3.0 * u2, 1.0 + 2.0 * u - 3.0 * u2, u2) / 2.0;
}

int SplinePath::interval_at(double t_s) const {
  const int last = static_cast<int>(control_m.size()) - 4;
  return std::clamp(static_cast<int>(std::floor((t_s - begin_s) / interval_s)), 0, last);
}

std::optional<TrackPoint> SplinePath::at(double t_s) const {
  if (control_m.size() < 4 || !(t_s >= begin_s) || !(t_s <= end_s())) return std::nullopt;
  const int i = interval_at(t_s);
  const double u = (t_s - begin_s) / interval_s - i;
  const Eigen::Vector4d w = spline_weights(u), s = spline_slopes(u) / interval_s;
  TrackPoint point;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d& c = control_m[static_cast<std::size_t>(i + k)];
    point.p_world += w[k] * c;
    point.v_world += s[k] * c;
  }
  return point;
}

SplinePath spline_through(double begin_s, double interval_s, std::vector<Eigen::Vector3d> p_at_knots) {
  SplinePath path{begin_s, interval_s, p_at_knots};
  // The path at a knot is (c₋ + 4 c + c₊) / 6: a few rounds of c += what is missing there come near enough.
  for (int round = 0; round < 10; ++round) {
    std::vector<Eigen::Vector3d> next = path.control_m;
    for (std::size_t k = 1; k + 1 < next.size(); ++k) {
      next[k] += p_at_knots[k] - (path.control_m[k - 1] + 4.0 * path.control_m[k] + path.control_m[k + 1]) / 6.0;
    }
    path.control_m = std::move(next);
  }
  return path;
}

}  // namespace alidade
