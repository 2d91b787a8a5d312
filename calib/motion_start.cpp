// SPDX-License-Identifier: Apache-2.0
#include "calib/motion_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "geometry/pose.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Linearised {
  double sigmas = 0.0;  // residual
  Eigen::Matrix<double, 1, 6> J;
};

std::vector<Linearised> linearise(const Scene& scene, std::span<const PlacedReading> readings, const Isometry3d& T) {
  std::vector<Linearised> rows;
  for (const PlacedReading& reading : readings) {
    const LineDetector& detector = scene.detectors[reading.detector];
    const Vector3d& p_body = scene.markers[reading.marker];
    const auto projection = project(detector, Vector3d(T * p_body));
    if (!projection) continue;
    const Eigen::RowVector3d J = projection->J_value_point * T.linear() / reading.sigma;
    Linearised row;
    row.sigmas = residual(detector.model, reading.value, projection->value) / reading.sigma;
    row.J << J, -J * skew(p_body);
    rows.push_back(row);
  }
  return rows;
}

double median_sigmas(const std::vector<Linearised>& rows) {
  std::vector<double> absolute;
  for (const Linearised& row : rows) absolute.push_back(std::abs(row.sigmas));
  return median_of(absolute);
}

// Where the planes of all readings come nearest to meeting, the body taken as a point; Cauchy weights.
std::optional<Vector3d> find_position(const Scene& scene, std::span<const PlacedReading> readings) {
  Vector3d p = Vector3d::Zero();
  for (int iteration = 0; iteration < 15; ++iteration) {
    Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
    Vector3d s = Vector3d::Zero();
    for (const PlacedReading& reading : readings) {
      const auto plane = plane_of(scene.detectors[reading.detector], reading.value);
      if (!plane) continue;
      const double off = iteration == 0 ? 0.0 : distance(*plane, p) / 0.2;
      const double w = 1.0 / (1.0 + off * off);
      M += w * plane->normal * plane->normal.transpose();
      s += w * plane->offset * plane->normal;
    }
    const Eigen::LDLT<Eigen::Matrix3d> factor(M);
    if (!(factor.vectorD().minCoeff() > 1e-9 * factor.vectorD().maxCoeff())) return std::nullopt;
    p = factor.solve(s);
  }
  return p;
}

// The 24 rotations that take a cube into itself.
std::vector<Eigen::Matrix3d> cube_rotations() {
  std::vector<Eigen::Matrix3d> rotations;
  const Vector3d axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const Vector3d& x : axes) {
    for (const Vector3d& y : axes) {
      if (x.dot(y) != 0) continue;
      Eigen::Matrix3d R;
      R << x, y, x.cross(y);
      rotations.push_back(R);
    }
  }
  return rotations;
}

}  // namespace

std::optional<RoughPose> refine_pose(const Scene& scene, std::span<const PlacedReading> readings,
                                     const Isometry3d& guess, double prior_m, double prior_rad) {
  Isometry3d T = guess;
  Vector6d prior;
  prior << Vector3d::Constant(1.0 / (prior_m * prior_m)), Vector3d::Constant(1.0 / (prior_rad * prior_rad));
  for (int iteration = 0; iteration < 12; ++iteration) {
    const auto rows = linearise(scene, readings, T);
    if (rows.empty()) return std::nullopt;
    const double scale = std::max(3.0, 3.0 * median_sigmas(rows));
    Matrix6d H = prior.asDiagonal();
    Vector6d g = prior.cwiseProduct(difference(T, guess));
    for (const Linearised& row : rows) {
      const double w = 1.0 / (1.0 + row.sigmas * row.sigmas / (scale * scale));
      H += w * row.J.transpose() * row.J;
      g += w * row.J.transpose() * row.sigmas;
    }
    const Vector6d step = H.ldlt().solve(g);
    if (!step.allFinite()) return std::nullopt;
    const double longest = std::max(step.head<3>().norm() / 0.5, step.tail<3>().norm() / 0.7);
    T = T * perturbation(longest > 1 ? Vector6d(step / longest) : step);
    if (step.norm() < 1e-7) break;
  }
  const auto rows = linearise(scene, readings, T);
  if (rows.size() * 2 < readings.size() || rows.empty()) return std::nullopt;
  return RoughPose{T, median_sigmas(rows)};
}

std::optional<RoughPose> find_pose(const Scene& scene, std::span<const PlacedReading> readings) {
  const auto position = find_position(scene, readings);
  if (!position) return std::nullopt;
  std::optional<RoughPose> best;
  for (const Eigen::Matrix3d& R : cube_rotations()) {
    Isometry3d guess = Isometry3d::Identity();
    guess.linear() = R;
    guess.translation() = *position;
    auto pose = refine_pose(scene, readings, guess, 1.0, 3.0);
    if (pose) pose = refine_pose(scene, readings, pose->T_world_body, 1.0, 3.0);
    if (pose && (!best || pose->median_sigmas < best->median_sigmas)) best = pose;
  }
  return best;
}

std::optional<std::vector<MotionKnot>> start_motion(const Scene& scene, std::span<const PlacedReading> readings,
                                                    std::span<const double> times_s, double window_s) {
  std::vector<MotionKnot> knots;
  std::optional<RoughPose> pose;
  double usual = 0.0;  // median residual of the poses so far
  for (const double time : times_s) {
    const auto earlier = [](const PlacedReading& r, double t) { return r.time_s < t; };
    const auto begin = std::lower_bound(readings.begin(), readings.end(), time - window_s, earlier);
    const auto end = std::lower_bound(begin, readings.end(), time + window_s, earlier);
    const std::span<const PlacedReading> window(begin, end);
    if (window.size() >= 6) {
      const auto next = pose ? refine_pose(scene, window, pose->T_world_body, 0.1, 0.5) : find_pose(scene, window);
      if (next) pose = next;
      const bool is_lost = pose && usual > 0 && pose->median_sigmas > 5 * usual + 5;
      if (is_lost) {
        const auto found = find_pose(scene, window);
        if (found && found->median_sigmas < 0.5 * pose->median_sigmas) pose = found;
      }
      if (pose) usual = usual == 0 ? pose->median_sigmas : 0.95 * usual + 0.05 * pose->median_sigmas;
    }
    MotionKnot knot;
    if (pose) {
      knot.p_world = pose->T_world_body.translation();
      knot.R_world_body = pose->T_world_body.linear();
    }
    knots.push_back(knot);
  }
  if (!pose) return std::nullopt;
  // Knots before the first answer stand where it does.
  for (std::size_t i = knots.size(); i-- > 1;) {
    if (knots[i - 1].p_world.isZero()) knots[i - 1] = knots[i];
  }
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
    const double span = times_s[i + 1] - times_s[i - 1];
    knots[i].v_world = (knots[i + 1].p_world - knots[i - 1].p_world) / span;
    knots[i].omega_body = log_so3(knots[i - 1].R_world_body.transpose() * knots[i + 1].R_world_body) / span;
  }
  return knots;
}

}  // namespace alidade
