// SPDX-License-Identifier: Apache-2.0
#include "tests/tracking/simulated_motion.h"

#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace alidade::test {

Eigen::VectorXd drawn(RandomGeometry& random, const Eigen::MatrixXd& P) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(P);
  Eigen::VectorXd along(P.rows());
  for (double& value : along) value = random.normal();
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt().cwiseProduct(along);
}

MotionState SimulatedCamera::next(const MotionState& state, RandomGeometry& random) const {
  return driven(jumped(state, drawn(random, noise.jump)), dt, drawn(random, noise.acceleration),
                drawn(random, noise.jerk));
}

SimulatedFrame SimulatedCamera::frame(const MotionState& truth, RandomGeometry& random) const {
  SimulatedFrame frame{truth, {}};
  for (const Sighting& s : sightings_from(camera, points, truth.T_world_body, noise_px, random)) {
    PointObservation o;
    o.pixel = s.pixel;
    o.sigma_px = s.sigma_px;
    o.p_world = points[static_cast<std::size_t>(s.point)].p_world;
    frame.observations.push_back(o);
  }
  return frame;
}

std::vector<SimulatedFrame> SimulatedCamera::recording(MotionState start, int frames, RandomGeometry& random) const {
  std::vector<SimulatedFrame> recorded;
  for (int k = 0; k < frames; ++k) recorded.push_back(frame(start = next(start, random), random));
  return recorded;
}

SimulatedCamera simulated_camera(RandomGeometry& random, int points) {
  SimulatedCamera simulated;
  simulated.points = make_map(simulated.camera, points, 1, 0.0, random).points;
  return simulated;
}

MotionState belief_before_points(double acceleration_sigma) {
  MotionState state;
  state.T_world_body = looking_at({6, 0, 0.5}, {0, 0, 0});
  state.v_world = {0.1, 0.3, -0.1};
  state.omega_body = {0.02, -0.05, 0.03};
  Vector18d sigmas;
  sigmas << Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.005), Eigen::Vector3d::Constant(0.1),
      Eigen::Vector3d::Constant(0.05), Vector6d::Constant(acceleration_sigma);
  state.covariance = sigmas.cwiseAbs2().asDiagonal();
  return state;
}

std::vector<MotionStep> filtered(const SimulatedCamera& simulated, MotionState state,
                                 const std::vector<SimulatedFrame>& frames, const CameraFilterOptions& options) {
  std::vector<MotionStep> steps;
  SightingNoise noise;
  for (const SimulatedFrame& frame : frames) {
    auto step = filter_step(simulated.camera, state, noise, frame.truth.time, frame.observations, options);
    if (!step) break;
    state = step->motion.state;
    noise = step->noise;
    steps.push_back(std::move(step->motion));
  }
  return steps;
}

CameraFilterOptions options_as_simulated(const MotionNoise& noise) {
  CameraFilterOptions options;
  options.motion = {{noise, 1.0}};
  options.learn_sighting_noise = false;
  options.update.gate_chi2 = 30;  // a gate at 99.9 % would trim what is measured
  return options;
}

double nees(const MotionState& state, const MotionState& truth) {
  const Eigen::VectorXd error = error_between(state, truth);
  const Eigen::MatrixXd covariance = state.covariance;
  return error.dot(covariance.ldlt().solve(error));
}

}  // namespace alidade::test
