// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/motion_start.h"

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

// How far all readings of a detector may be off together while its station is not calibrated, in their sigmas: the
// body's attitude then comes from how its markers' readings differ.
constexpr double kCommonOffset = 100.0;

struct Linearised {
  std::size_t detector = 0;
  double sigmas = 0.0;  // residual
  Eigen::Matrix<double, 1, 6> J;
};

std::vector<Linearised> linearise(const DetectorScene& scene, std::span<const PlacedReading> readings,
                                  const Isometry3d& T) {
  std::vector<Linearised> rows;
  for (const PlacedReading& reading : readings) {
    const LineDetector& detector = scene.detectors[reading.detector];
    const Vector3d& p_body = scene.markers[reading.marker];
    const auto projection = project(detector, Vector3d(T * p_body));
    if (!projection) continue;
    const Eigen::RowVector3d J = projection->J_value_point * T.linear() / reading.sigma;
    Linearised row;
    row.detector = reading.detector;
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

// The rows without what the median reading of their detector is off by, shrunk by its prior.
std::vector<Linearised> without_common_offsets(const DetectorScene& scene, std::vector<Linearised> rows) {
  for (std::size_t d = 0; d < scene.detectors.size(); ++d) {
    std::vector<double> sigmas;
    for (const Linearised& row : rows) {
      if (row.detector == d) sigmas.push_back(row.sigmas);
    }
    if (sigmas.empty()) continue;
    const double information = static_cast<double>(sigmas.size());
    const double offset = median_of(sigmas) * information / (information + 1.0 / (kCommonOffset * kCommonOffset));
    for (Linearised& row : rows) row.sigmas -= row.detector == d ? offset : 0.0;
  }
  return rows;
}

// Gauss–Newton's system for the pose, one offset per detector eliminated.
struct PoseSystem {
  Matrix6d H;
  Vector6d g;
};

PoseSystem build_system(const DetectorScene& scene, const std::vector<Linearised>& rows, const Vector6d& prior,
                        const Vector6d& to_prior) {
  const auto residuals = without_common_offsets(scene, rows);
  const double scale = std::max(3.0, 3.0 * median_sigmas(residuals));
  std::vector<double> weight(scene.detectors.size(), 1.0 / (kCommonOffset * kCommonOffset)), sum(weight.size(), 0.0);
  std::vector<Eigen::Matrix<double, 1, 6>> slope(weight.size(), Eigen::Matrix<double, 1, 6>::Zero());
  PoseSystem system{prior.asDiagonal(), prior.cwiseProduct(to_prior)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double w = 1.0 / (1.0 + residuals[i].sigmas * residuals[i].sigmas / (scale * scale));
    const std::size_t d = rows[i].detector;
    system.H += w * rows[i].J.transpose() * rows[i].J;
    system.g += w * rows[i].J.transpose() * rows[i].sigmas;
    weight[d] += w;
    sum[d] += w * rows[i].sigmas;
    slope[d] += w * rows[i].J;
  }
  for (std::size_t d = 0; d < weight.size(); ++d) {
    system.H -= slope[d].transpose() * slope[d] / weight[d];
    system.g -= slope[d].transpose() * (sum[d] / weight[d]);
  }
  return system;
}

// Where the planes of all readings come nearest to meeting, the body taken as a point; Cauchy weights.
std::optional<Vector3d> find_position(const DetectorScene& scene, std::span<const PlacedReading> readings) {
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

std::optional<RoughPose> refine_pose(const DetectorScene& scene, std::span<const PlacedReading> readings,
                                     const Isometry3d& guess, double prior_m, double prior_rad) {
  Isometry3d T = guess;
  Vector6d prior;
  prior << Vector3d::Constant(1.0 / (prior_m * prior_m)), Vector3d::Constant(1.0 / (prior_rad * prior_rad));
  for (int iteration = 0; iteration < 15; ++iteration) {
    const auto rows = linearise(scene, readings, T);
    if (rows.empty()) return std::nullopt;
    const PoseSystem system = build_system(scene, rows, prior, difference(T, guess));
    const Vector6d step = system.H.ldlt().solve(system.g);
    if (!step.allFinite()) return std::nullopt;
    const double longest = std::max(step.head<3>().norm() / 0.5, step.tail<3>().norm() / 0.7);
    T = T * perturbation(longest > 1 ? Vector6d(step / longest) : step);
    if (step.norm() < 1e-7) break;
  }
  const auto rows = linearise(scene, readings, T);
  if (rows.size() * 2 < readings.size() || rows.empty()) return std::nullopt;
  return RoughPose{T, median_sigmas(without_common_offsets(scene, rows))};
}

std::optional<RoughPose> find_pose(const DetectorScene& scene, std::span<const PlacedReading> readings) {
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

std::optional<std::vector<MotionKnot>> start_motion(const DetectorScene& scene, std::span<const PlacedReading> readings,
                                                    std::span<const double> times_s, double window_s,
                                                    const std::stop_token& stop) {
  std::vector<MotionKnot> knots;
  std::optional<RoughPose> pose;
  double usual = 0.0;  // median residual of the poses so far
  for (const double time : times_s) {
    if (stop.stop_requested()) return std::nullopt;
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
