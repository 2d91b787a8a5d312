// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/detector_calibration.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "calib/detectors/calibration_problem.h"
#include "calib/detectors/placed_readings.h"
#include "geometry/alignment.h"

namespace alidade {
namespace {

constexpr int kFewestReadings = 24;      // four markers seen six times
constexpr double kFirstLoss = 16.0;      // times the wanted loss: how generously the readings are judged at first
constexpr double kMostDamping = 1e4;     // a step so short gains nothing any more
constexpr int kMotionIterations = 15;    // of the motion alone, before the stations move
constexpr double kWorstPosition = 0.25;  // m; a station less certain is not determined
constexpr double kWorstRotation = 0.1;   // rad

// Without NaN; 0 for none.
double median_absolute(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return 0.0;
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Minimum {
  CalibrationState state;
  int iterations = 0;
  bool is_solved = false;
  bool is_settled = false;
};

// How far to go, and who is told.
struct Effort {
  double loss_sigmas = 3.0;
  int max_iterations = 1;
  const char* stage = "";
  const CalibrationContext& context;
};

// Levenberg–Marquardt under a loss that tightens, each time the cost has settled, down to the one wanted or to what the
// bulk of the residuals allows.
Minimum minimise(const CalibrationProblem& problem, CalibrationState start, const Effort& effort) {
  Minimum minimum{std::move(start)};
  const auto wanted_loss = [&] {
    return std::max(effort.loss_sigmas, 3.0 * median_absolute(problem.residuals(minimum.state)));
  };
  double damping = 1e-6, loss = std::max(kFirstLoss * effort.loss_sigmas, 2.0 * wanted_loss());
  double cost = problem.evaluate(minimum.state, loss, nullptr);
  for (; minimum.iterations < effort.max_iterations && !effort.context.stop.stop_requested(); ++minimum.iterations) {
    if (effort.context.progress) {
      effort.context.progress({effort.stage, minimum.iterations, effort.max_iterations, ""});
    }
    BorderedSystem system(minimum.state.knots.size(), problem.border_size());
    problem.evaluate(minimum.state, loss, &system);
    const auto step = solve(std::move(system), damping);
    CalibrationState candidate = step ? problem.moved(minimum.state, *step) : minimum.state;
    const double gain = step ? cost - problem.evaluate(candidate, loss, nullptr) : -1.0;
    if (gain >= 0) {
      minimum.state = std::move(candidate);
      minimum.is_solved = true;
      cost -= gain;
      damping = std::max(1e-9, damping * 0.1);
    } else {
      damping = std::max(1e-7, damping) * 10;
    }
    const bool is_last = loss <= effort.loss_sigmas * 1.01;
    const bool is_stuck = damping >= kMostDamping;
    if (!is_stuck && !(gain >= 0 && gain <= (is_last ? 1e-6 : 1e-3) * cost)) continue;
    const double wanted = wanted_loss();
    minimum.is_settled = minimum.is_solved && loss <= wanted * 1.01;
    if (minimum.is_settled || is_stuck) break;
    loss = std::max(wanted, 0.5 * loss);
    cost = problem.evaluate(minimum.state, loss, nullptr);
  }
  if (effort.context.progress) {
    effort.context.progress({effort.stage, effort.max_iterations, effort.max_iterations, ""});
  }
  return minimum;
}

bool has_enough(std::span<const LineDetector> detectors, const std::vector<PlacedReading>& readings) {
  std::map<std::string, int> count;
  for (const LineDetector& detector : detectors) count[detector.station] = 0;
  for (const PlacedReading& reading : readings) ++count[detectors[reading.detector].station];
  return std::all_of(count.begin(), count.end(), [](const auto& c) { return c.second >= kFewestReadings; });
}

ReadingStatistics summarise(const std::vector<double>& residuals, double loss_sigmas) {
  ReadingStatistics s;
  s.count = static_cast<int>(residuals.size());
  s.median_sigmas = median_absolute(residuals);
  double sum = 0;
  for (const double r : residuals) {
    if (!(std::abs(r) <= loss_sigmas)) continue;
    ++s.inlier_count;
    sum += r * r;
  }
  if (s.inlier_count > 0) s.rms_sigmas = std::sqrt(sum / s.inlier_count);
  return s;
}

// The reference's frame as the motion so far has it.
Eigen::Isometry3d align_reference(const CalibrationProblem& problem, const CalibrationState& state,
                                  const MotionReference& reference) {
  std::vector<Eigen::Vector3d> from, to;
  for (const TimedPosition& position : reference.positions) {
    const auto pose = problem.pose_at(state, to_seconds(position.time.time_since_epoch()));
    if (!pose) continue;
    from.push_back(pose->translation());
    to.push_back(position.p);
  }
  const auto fit = align_points(from, to, AlignmentKind::Rigid);
  return fit ? fit->T_target_source : Eigen::Isometry3d::Identity();
}

// The covariances of the stations that move; empty where one of them is not determined.
std::optional<std::map<std::string, Matrix6d>> station_covariances(const CalibrationProblem& problem,
                                                                   const CalibrationState& state, double loss) {
  std::map<std::string, Matrix6d> covariances;
  BorderedSystem system(state.knots.size(), problem.border_size());
  problem.evaluate(state, loss, &system);
  const auto solution = solve(std::move(system), 0.0);
  if (!solution) return std::nullopt;
  for (const LineDetector& detector : state.scene.detectors) {
    const Eigen::Index column = problem.station_column(detector.station);
    if (column < 0) continue;
    const Matrix6d C = solution->border_covariance.block<6, 6>(column, column);
    const bool is_known = C.topLeftCorner<3, 3>().trace() < kWorstPosition * kWorstPosition &&
                          C.bottomRightCorner<3, 3>().trace() < kWorstRotation * kWorstRotation;
    if (!is_known) return std::nullopt;
    covariances[detector.station] = C;
  }
  return covariances;
}

void add_statistics(const CalibrationProblem& problem, const CalibrationState& state, double loss,
                    DetectorCalibration& result) {
  const auto residuals = problem.residuals(state);
  std::map<int, std::vector<double>> by_detector, by_marker;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const PlacedReading& reading = problem.readings()[i];
    by_detector[state.scene.detectors[reading.detector].id].push_back(residuals[i]);
    by_marker[result.body.markers[reading.marker].id].push_back(residuals[i]);
  }
  for (const auto& [id, values] : by_detector) result.by_detector[id] = summarise(values, loss);
  for (const auto& [id, values] : by_marker) result.by_marker[id] = summarise(values, loss);
}

Trajectory motion_of(const CalibrationProblem& problem, const CalibrationState& state) {
  Trajectory motion;
  for (const double t : problem.knot_times()) {
    const auto pose = problem.pose_at(state, t);
    const Timestamp time(from_seconds(t));
    if (pose && (motion.empty() || time > motion.back().time)) motion.push_back({time, *pose, std::nullopt});
  }
  return motion;
}

void require_inputs(std::span<const LineDetector> detectors, const RigidBody& body, const std::string& held) {
  if (detectors.empty()) throw std::invalid_argument("calibrate_detectors: no detectors");
  if (body.markers.empty()) throw std::invalid_argument("calibrate_detectors: the body has no markers");
  const auto is_held = [&](const LineDetector& detector) { return detector.station == held; };
  if (held.empty() || std::any_of(detectors.begin(), detectors.end(), is_held)) return;
  throw std::invalid_argument(fmt::format("calibrate_detectors: no detector is of the held station '{}'", held));
}

}  // namespace

void validate(const DetectorCalibrationOptions& o) {
  const auto require_positive = [](double value, const char* name) {
    if (value > 0 && std::isfinite(value)) return;
    throw std::invalid_argument(fmt::format("DetectorCalibrationOptions: {} must be > 0, got {}", name, value));
  };
  require_positive(o.knot_interval_s, "knot_interval_s");
  require_positive(o.density.acceleration, "density.acceleration");
  require_positive(o.density.turn, "density.turn");
  require_positive(o.longest_gap_s, "longest_gap_s");
  require_positive(o.loss_sigmas, "loss_sigmas");
  require_positive(o.body_size_sigma, "body_size_sigma");
  require_positive(o.max_iterations, "max_iterations");
}

DetectorCalibration calibrate_detectors(std::span<const LineDetector> detectors, const RigidBody& body,
                                        std::span<const LineReading> readings,
                                        const DetectorCalibrationOptions& options, const CalibrationContext& context) {
  validate(options);
  require_inputs(detectors, body, options.held_station);
  DetectorCalibration result;
  result.body = body;
  result.rig.detectors.assign(detectors.begin(), detectors.end());
  const auto refuse = [&](CalibrationOutcome outcome) {
    result.outcome = outcome;
    return result;
  };
  CalibrationState state;
  state.scene = scene_of(detectors, body);
  const auto placed = place_readings(detectors, body, readings);
  if (!has_enough(detectors, placed)) return refuse(CalibrationOutcome::TooFewReadings);

  DetectorCalibrationOptions held = options;
  held.hold_detectors = true;
  const CalibrationProblem motion_alone(state, placed, held, nullptr);
  auto knots =
      start_motion(state.scene, placed, motion_alone.knot_times(), 1.5 * options.knot_interval_s, context.stop);
  if (context.stop.stop_requested()) return refuse(CalibrationOutcome::Stopped);
  if (!knots) return refuse(CalibrationOutcome::NoStart);
  state.knots = std::move(*knots);
  const int motion_iterations = options.hold_detectors ? options.max_iterations : kMotionIterations;
  const Minimum motion =
      minimise(motion_alone, state, {options.loss_sigmas, motion_iterations, "following the body", context});
  if (context.stop.stop_requested()) return refuse(CalibrationOutcome::Stopped);
  state = motion.state;
  result.iterations = motion.iterations;
  result.is_converged = motion.is_settled;
  if (context.reference) state.T_reference_world = align_reference(motion_alone, state, *context.reference);

  const CalibrationProblem problem(state, placed, options, context.reference);
  if (!options.hold_detectors) {
    const Minimum minimum =
        minimise(problem, state, {options.loss_sigmas, options.max_iterations, "moving the stations", context});
    if (!minimum.is_solved && context.stop.stop_requested()) return refuse(CalibrationOutcome::Stopped);
    auto covariances = station_covariances(problem, minimum.state, options.loss_sigmas);
    if (!minimum.is_solved || !covariances) return refuse(CalibrationOutcome::Undetermined);
    state = minimum.state;
    result.iterations = minimum.iterations;
    result.is_converged = minimum.is_settled;
    result.rig = {state.scene.detectors, std::move(*covariances)};
  }
  for (std::size_t i = 0; i < body.markers.size(); ++i) result.body.markers[i].p_body = state.scene.markers[i];
  result.T_reference_world = state.T_reference_world;
  result.p_body_reference = state.p_body_reference;
  result.motion = motion_of(problem, state);
  add_statistics(problem, state, options.loss_sigmas, result);
  return result;
}

}  // namespace alidade
