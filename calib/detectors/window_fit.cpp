// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/window_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "calib/detectors/placed_readings.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Vector18d = Eigen::Matrix<double, 18, 1>;
using Matrix18d = Eigen::Matrix<double, 18, 18>;
using Row18d = Eigen::Matrix<double, 1, 18>;

constexpr int kIterations = 40;
constexpr double kFirstLoss = 16.0;  // times the wanted loss
constexpr auto kLongestGap = std::chrono::milliseconds(100);

// Directions that few readings leave open end where a body cannot be: m/s, rad/s, m/s², rad/s².
Vector18d ignorance() {
  Vector18d information = Vector18d::Zero();
  information.segment<3>(6).setConstant(std::pow(20.0, -2));
  information.segment<3>(9).setConstant(std::pow(100.0, -2));
  information.segment<3>(12).setConstant(std::pow(1e3, -2));
  information.segment<3>(15).setConstant(std::pow(1e4, -2));
  return information;
}

Vector18d rates_of(const WindowMotion& m) {
  Vector18d rates = Vector18d::Zero();
  rates.tail<12>() << m.knot.v_world, m.knot.omega_body, m.a_world, m.alpha_body;
  return rates;
}

Vector3d turn_after(const WindowMotion& m, double tau) {
  return m.knot.omega_body * tau + m.alpha_body * (0.5 * tau * tau);
}

// A reading's residual in sigmas, expected minus read by the motion's parameters; empty where it is not seen.
std::optional<double> residual_of(const DetectorScene& scene, const PlacedReading& reading, const WindowMotion& m,
                                  Row18d* J) {
  const double tau = reading.time_s - m.time_s;
  const Vector3d& p_body = scene.markers[reading.marker];
  const Isometry3d T = pose_after(m, tau);
  const LineDetector& detector = scene.detectors[reading.detector];
  const auto projection = project(detector, Vector3d(T * p_body));
  if (!projection) return std::nullopt;
  if (J) {
    const Eigen::RowVector3d by_point = projection->J_value_point / reading.sigma;
    const Vector3d phi = turn_after(m, tau);
    const Eigen::RowVector3d by_turn = -by_point * T.linear() * skew(p_body);
    const Eigen::RowVector3d by_phi = by_turn * right_jacobian_so3(phi);
    *J << by_point, by_turn * exp_so3(phi).transpose(), tau * by_point, tau * by_phi, 0.5 * tau * tau * by_point,
        0.5 * tau * tau * by_phi;
  }
  return residual(detector.model, reading.value, projection->value) / reading.sigma;
}

struct Fit {
  double cost = 0.0;
  int seen = 0;
  Matrix18d H = Matrix18d::Zero();
  Vector18d g = Vector18d::Zero();
};

Fit evaluate(const DetectorScene& scene, std::span<const PlacedReading> readings, const WindowMotion& m, double loss,
             bool with_derivatives) {
  Fit fit;
  const double c2 = loss * loss;
  Row18d J;
  for (const PlacedReading& reading : readings) {
    const auto r = residual_of(scene, reading, m, with_derivatives ? &J : nullptr);
    fit.seen += r.has_value();
    const double root = r ? c2 / (c2 + *r * *r) : 0.0;
    fit.cost += r ? 0.5 * root * *r * *r : 0.5 * c2;
    if (!r || !with_derivatives) continue;
    fit.H.noalias() += root * root * J.transpose() * J;
    fit.g.noalias() += root * root * *r * J.transpose();
  }
  const Vector18d information = ignorance(), rates = rates_of(m);
  fit.cost += 0.5 * rates.dot(information.cwiseProduct(rates));
  fit.H.diagonal() += information;
  fit.g -= information.cwiseProduct(rates);
  return fit;
}

WindowMotion moved(const WindowMotion& m, const Vector18d& step) {
  WindowMotion result = m;
  result.knot.p_world += step.segment<3>(0);
  result.knot.R_world_body = m.knot.R_world_body * exp_so3(step.segment<3>(3));
  result.knot.v_world += step.segment<3>(6);
  result.knot.omega_body += step.segment<3>(9);
  result.a_world += step.segment<3>(12);
  result.alpha_body += step.segment<3>(15);
  return result;
}

// Of the first `parameters` alone; the others stand.
Vector18d solve_step(const Fit& fit, int parameters, double damping) {
  Vector18d step = Vector18d::Zero();
  Eigen::MatrixXd H = fit.H.topLeftCorner(parameters, parameters);
  H.diagonal() *= 1.0 + damping;
  step.head(parameters) = H.ldlt().solve(fit.g.head(parameters));
  return step;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Where the search begins: on the motion, else where the planes meet.
std::optional<WindowMotion> start_of(const DetectorScene& scene, std::span<const PlacedReading> readings,
                                     const Trajectory& motion, double time_s) {
  WindowMotion start;
  start.time_s = time_s;
  const Timestamp time(from_seconds(time_s));
  std::optional<Isometry3d> T = pose_at(motion, time, kLongestGap);
  if (!T) {
    const auto found = find_pose(scene, readings);
    if (!found) return std::nullopt;
    T = found->T_world_body;
  }
  start.knot.p_world = T->translation();
  start.knot.R_world_body = T->linear();
  if (const auto twist = twist_at(motion, time, std::chrono::milliseconds(10), kLongestGap)) {
    start.knot.v_world = T->linear() * twist->head<3>();
    start.knot.omega_body = twist->tail<3>();
  }
  return start;
}

int parameters_for(std::size_t readings) {
  return readings >= 36 ? 18 : readings >= 24 ? 12 : 6;
}

// What all windows come to.
struct Tally {
  const DetectorScene& scene;
  const WindowFitOptions& options;
  WindowStatistics statistics;
  std::vector<double> sigmas, rad;

  void add(std::span<const PlacedReading> readings, const Trajectory& motion, double middle_s) {
    if (static_cast<int>(readings.size()) < options.least_readings) return;
    const int parameters = parameters_for(readings.size());
    ++statistics.windows;
    statistics.largest_fit = std::max(statistics.largest_fit, parameters);
    std::optional<WindowMotion> fit = start_of(scene, readings, motion, middle_s);
    if (fit) fit = fit_window(scene, readings, *fit, parameters, options.explained_sigmas);
    std::size_t explained = 0;
    for (const PlacedReading& reading : readings) {
      const auto r = fit ? residual_of(scene, reading, *fit, nullptr) : std::nullopt;
      sigmas.push_back(r ? std::abs(*r) : std::numeric_limits<double>::infinity());
      explained += sigmas.back() < options.explained_sigmas;
      if (!reads_pixels(scene.detectors[reading.detector].model)) rad.push_back(sigmas.back() * reading.sigma);
    }
    const double share = static_cast<double>(explained) / static_cast<double>(readings.size());
    statistics.explained += share > options.explained_share;
  }

  WindowStatistics result() const {
    WindowStatistics all = statistics;
    if (!sigmas.empty()) all.median_sigmas = median_of(sigmas);
    if (!rad.empty()) all.median_rad = median_of(rad);
    return all;
  }
};

}  // namespace

Isometry3d pose_after(const WindowMotion& m, double tau) {
  Isometry3d T = Isometry3d::Identity();
  T.linear() = m.knot.R_world_body * exp_so3(turn_after(m, tau));
  T.translation() = m.knot.p_world + m.knot.v_world * tau + m.a_world * (0.5 * tau * tau);
  return T;
}

std::optional<WindowMotion> fit_window(const DetectorScene& scene, std::span<const PlacedReading> readings,
                                       const WindowMotion& start, int parameters, double loss_sigmas) {
  if (parameters != 6 && parameters != 12 && parameters != 18) {
    throw std::invalid_argument(fmt::format("fit_window: parameters must be 6, 12 or 18, got {}", parameters));
  }
  WindowMotion motion = start;
  double loss = kFirstLoss * loss_sigmas, damping = 1e-6;
  Fit fit = evaluate(scene, readings, motion, loss, true);
  if (fit.seen == 0) return std::nullopt;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const WindowMotion candidate = moved(motion, solve_step(fit, parameters, damping));
    const double gain = fit.cost - evaluate(scene, readings, candidate, loss, false).cost;
    const bool is_better = gain >= 0;  // false for NaN
    damping = is_better ? std::max(1e-9, 0.1 * damping) : 10 * damping;
    if (is_better) motion = candidate;
    const bool has_settled = (is_better && gain <= 1e-4 * fit.cost + 1e-9) || damping > 1e4;
    if (has_settled && loss <= 1.01 * loss_sigmas) break;
    if (has_settled) {
      loss = std::max(loss_sigmas, 0.25 * loss);
      damping = 1e-6;
    }
    if (is_better || has_settled) fit = evaluate(scene, readings, motion, loss, true);
  }
  return motion;
}

void validate(const WindowFitOptions& o) {
  if (!(o.window_s > 0 && o.window_s <= 0.1)) {
    throw std::invalid_argument(fmt::format("window_s must be > 0 s and <= 0.1 s, got {}", o.window_s));
  }
  if (!(o.least_readings >= 6)) {
    throw std::invalid_argument(fmt::format("least_readings must be >= 6, got {}", o.least_readings));
  }
  if (!(o.explained_sigmas > 0)) {
    throw std::invalid_argument(fmt::format("explained_sigmas must be > 0, got {}", o.explained_sigmas));
  }
  if (!(o.explained_share >= 0 && o.explained_share < 1)) {
    throw std::invalid_argument(fmt::format("explained_share must be 0..1 and < 1, got {}", o.explained_share));
  }
}

WindowStatistics fit_windows(std::span<const LineDetector> detectors, const RigidBody& body,
                             std::span<const LineReading> readings, const Trajectory& motion,
                             const WindowFitOptions& options, const std::stop_token& stop) {
  validate(options);
  const DetectorScene scene = scene_of(detectors, body);
  const auto placed = place_readings(detectors, body, readings);
  Tally tally{scene, options, {}, {}, {}};
  for (std::size_t first = 0, end = 0; first < placed.size() && !stop.stop_requested(); first = end) {
    const double window = std::floor(placed[first].time_s / options.window_s);
    while (end < placed.size() && std::floor(placed[end].time_s / options.window_s) == window) ++end;
    tally.add(std::span(placed).subspan(first, end - first), motion, (window + 0.5) * options.window_s);
  }
  return tally.result();
}

}  // namespace alidade
