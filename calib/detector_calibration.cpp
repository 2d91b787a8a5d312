// SPDX-License-Identifier: Apache-2.0
#include "calib/detector_calibration.h"

#include <algorithm>
#include <cmath>

#include "calib/calibration_problem.h"
#include "geometry/alignment.h"

namespace alidade {
namespace {

double median_absolute(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return 0;
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Minimum {
  CalibrationState state;
  Eigen::MatrixXd border_covariance;
  double cost = 0;
  int iterations = 0;
  bool solved = false;
};

// Levenberg–Marquardt. The loss tightens from what the first residuals need to what is wanted.
Minimum minimise(const CalibrationProblem& problem, CalibrationState state, double loss_sigmas, int max_iterations) {
  Minimum minimum{std::move(state), {}, 0, 0, false};
  double damping = 1e-6;
  double loss = std::max(loss_sigmas, 5.0 * median_absolute(problem.residuals(minimum.state)));
  double cost = problem.evaluate(minimum.state, loss, nullptr);
  while (minimum.iterations < max_iterations) {
    ++minimum.iterations;
    BorderedSystem system(minimum.state.knots.size(), problem.border_size());
    problem.evaluate(minimum.state, loss, &system);
    const auto step = solve(system, damping);
    double gain = -1;
    if (step) {
      const CalibrationState candidate = problem.moved(minimum.state, *step);
      const double moved_cost = problem.evaluate(candidate, loss, nullptr);
      gain = cost - moved_cost;
      if (gain >= 0) {
        minimum.state = candidate;
        cost = moved_cost;
        damping = std::max(1e-9, damping * 0.1);
        minimum.border_covariance = step->border_covariance;
        minimum.solved = true;
      }
    }
    if (gain < 0) damping = std::max(1e-6, damping) * 10;
    if (damping > 1e6) break;
    if (gain >= 0 && gain < 1e-4 * cost) {
      const double wanted = std::max(loss_sigmas, 3.0 * median_absolute(problem.residuals(minimum.state)));
      if (loss <= wanted * 1.01 && gain < 1e-6 * cost) break;
      loss = std::min(loss, std::max(wanted, 0.5 * loss));
      cost = problem.evaluate(minimum.state, loss, nullptr);
    }
  }
  minimum.cost = cost;
  return minimum;
}

std::vector<PlacedReading> place_readings(std::span<const LineDetector> detectors, const RigidBody& body,
                                          std::span<const LineReading> readings) {
  std::map<int, std::size_t> detector_of, marker_of;
  for (std::size_t i = 0; i < detectors.size(); ++i) detector_of[detectors[i].id] = i;
  for (std::size_t i = 0; i < body.markers.size(); ++i) marker_of[body.markers[i].id] = i;
  std::vector<PlacedReading> placed;
  for (const LineReading& reading : readings) {
    const auto d = detector_of.find(reading.detector);
    const auto m = marker_of.find(reading.marker);
    if (d == detector_of.end() || m == marker_of.end()) continue;
    placed.push_back({d->second, m->second, to_seconds(reading.time.time_since_epoch()), reading.value,
                      reading.sigma > 0 ? reading.sigma : detectors[d->second].sigma});
  }
  return placed;
}

ReadingStatistics summarise(const std::vector<double>& residuals, double loss_sigmas, double sigma) {
  ReadingStatistics s;
  s.count = static_cast<int>(residuals.size());
  s.median = median_absolute(residuals) * sigma;
  double sum = 0;
  for (const double r : residuals) {
    if (!(std::abs(r) <= loss_sigmas)) continue;
    ++s.inlier_count;
    sum += r * r;
  }
  if (s.inlier_count > 0) s.rms = std::sqrt(sum / s.inlier_count) * sigma;
  return s;
}

}  // namespace

DetectorCalibration calibrate_detectors(std::span<const LineDetector> detectors, const RigidBody& body,
                                        std::span<const LineReading> readings,
                                        const DetectorCalibrationOptions& options, const MotionReference* reference) {
  DetectorCalibration result;
  result.body = body;
  result.rig.detectors.assign(detectors.begin(), detectors.end());
  CalibrationState start;
  start.scene.detectors = result.rig.detectors;
  for (const BodyMarker& marker : body.markers) start.scene.markers.push_back(marker.p_body);
  auto placed = place_readings(detectors, body, readings);
  if (placed.size() < 24) {
    result.outcome = CalibrationOutcome::TooFewReadings;
    return result;
  }
  DetectorCalibrationOptions held = options;
  held.hold_stations = true;
  held.marker_sigma_m = 0;
  const CalibrationProblem motion_alone(start, placed, held, nullptr);
  auto knots = start_motion(start.scene, placed, motion_alone.knot_times(), 1.5 * options.knot_interval_s);
  if (!knots) {
    result.outcome = CalibrationOutcome::NoStart;
    return result;
  }
  start.knots = *knots;
  start.knots = minimise(motion_alone, start, options.loss_sigmas, 15).state.knots;
  if (reference) {
    std::vector<Eigen::Vector3d> from, to;
    for (const auto& position : reference->positions) {
      const double t = to_seconds(position.time.time_since_epoch());
      if (t < motion_alone.knot_times().front() || t > motion_alone.knot_times().back()) continue;
      from.push_back(motion_alone.pose_at(start, t).translation());
      to.push_back(position.p_reference);
    }
    if (const auto fit = align_points(from, to, AlignmentKind::Rigid)) start.T_reference_world = fit->T_target_source;
  }
  const CalibrationProblem problem(start, placed, options, reference);
  const Minimum minimum = minimise(problem, start, options.loss_sigmas, options.max_iterations);
  if (!minimum.solved) {
    result.outcome = CalibrationOutcome::Undetermined;
    return result;
  }
  result.iterations = minimum.iterations;
  result.cost = minimum.cost;
  result.rig.detectors = minimum.state.scene.detectors;
  for (const LineDetector& d : result.rig.detectors) {
    const Eigen::Index c = problem.station_column(d.station);
    if (c >= 0) result.rig.station_covariance[d.station] = minimum.border_covariance.block<6, 6>(c, c);
  }
  for (std::size_t i = 0; i < body.markers.size(); ++i) result.body.markers[i].p_body = minimum.state.scene.markers[i];
  result.T_reference_world = minimum.state.T_reference_world;
  result.p_body_reference = minimum.state.p_body_reference;
  const auto residuals = problem.residuals(minimum.state);
  std::map<int, std::vector<double>> by_detector, by_marker;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    by_detector[detectors[placed[i].detector].id].push_back(residuals[i]);
    by_marker[body.markers[placed[i].marker].id].push_back(residuals[i]);
  }
  for (const LineDetector& d : detectors) {
    result.by_detector[d.id] = summarise(by_detector[d.id], options.loss_sigmas, d.sigma);
  }
  for (const BodyMarker& m : body.markers) {
    result.by_marker[m.id] = summarise(by_marker[m.id], options.loss_sigmas, detectors.front().sigma);
  }
  double last = -1;
  for (const double t : problem.knot_times()) {
    if (t <= last) continue;
    last = t;
    StampedPose pose;
    pose.time = Timestamp(from_seconds(t));
    pose.T_world_camera = problem.pose_at(minimum.state, t);
    result.motion.push_back(pose);
  }
  return result;
}

}  // namespace alidade
