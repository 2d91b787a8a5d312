// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>

#include "calib/bundle/board_bundle.h"

// Why not Ceres: there are at most some dozens of shared parameters and six per frame, and the equations are wanted
// again for the covariances. Eliminating the frames by hand takes a tenth of Ceres' time.
namespace alidade {
namespace {

struct BundleStep {
  Eigen::VectorXd shared;
  std::vector<Vector6d> frames;
  double predicted = 0;  // by how much the cost should fall
};

// The step of (H + lambda diag H) x = -g.
std::optional<BundleStep> damped_step(const BundleEquations& e, double lambda) {
  const std::size_t frames = e.H_frame.size();
  Eigen::MatrixXd S = e.H;
  S.diagonal() += lambda * e.H.diagonal();
  Eigen::VectorXd b = -e.g;
  std::vector<Eigen::LLT<Matrix6d>> factors(frames);
  for (std::size_t f = 0; f < frames; ++f) {
    Matrix6d H = e.H_frame[f];
    if (H.diagonal().maxCoeff() == 0) H.setIdentity();  // a frame that no view sees stays
    H.diagonal() += lambda * H.diagonal();
    factors[f].compute(H);
    if (factors[f].info() != Eigen::Success) return std::nullopt;
    const Eigen::Matrix<double, 6, Eigen::Dynamic> X = factors[f].solve(e.H_frame_shared[f]);
    S.noalias() -= e.H_frame_shared[f].transpose() * X;
    b.noalias() += X.transpose() * e.g_frame[f];
  }
  BundleStep step;
  step.shared = b;
  if (S.rows() > 0) {
    // Scaled to a unit diagonal: the coefficients of a lens and its focal length differ by many orders of magnitude.
    const Eigen::VectorXd scale = S.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * S * scale.asDiagonal());
    if (factor.info() != Eigen::Success) return std::nullopt;
    step.shared = scale.asDiagonal() * factor.solve(scale.asDiagonal() * b);
  }
  step.predicted = -2.0 * e.g.dot(step.shared) - step.shared.dot(e.H * step.shared);
  for (std::size_t f = 0; f < frames; ++f) {
    const Vector6d cross = e.H_frame_shared[f] * step.shared;
    const Vector6d x = factors[f].solve(-e.g_frame[f] - cross);
    step.predicted -= 2.0 * e.g_frame[f].dot(x) + x.dot(e.H_frame[f] * x) + 2.0 * x.dot(cross);
    step.frames.push_back(x);
  }
  return step;
}

BoardBundle moved(BoardBundle bundle, const BundleLayout& layout, const BundleStep& step) {
  for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
    const int camera = static_cast<int>(i);
    Intrinsics values = intrinsics(bundle.cameras[i].camera);
    for (std::size_t j = 0; j < layout.intrinsics[i].size(); ++j) {
      values[layout.intrinsics[i][j]] += step.shared[layout.intrinsics_at(camera) + static_cast<int>(j)];
    }
    bundle.cameras[i].camera = with_intrinsics(bundle.cameras[i].camera, values);
    if (layout.camera_poses && camera > 0) {
      auto& T = bundle.cameras[i].T_rig_camera;
      T = T * perturbation(step.shared.segment<6>(layout.pose_at(camera)));
    }
  }
  if (layout.warp) {
    bundle.warp.x_m += step.shared[layout.warp_at];
    bundle.warp.y_m += step.shared[layout.warp_at + 1];
  }
  for (std::size_t i = 0; layout.corners && i < bundle.warp.offsets_m.size(); ++i) {
    bundle.warp.offsets_m[i] += step.shared.segment<3>(layout.corners_at + 3 * static_cast<Eigen::Index>(i));
  }
  for (std::size_t f = 0; f < bundle.T_rig_board.size(); ++f) {
    bundle.T_rig_board[f] = bundle.T_rig_board[f] * perturbation(step.frames[f]);
  }
  return bundle;
}

}  // namespace

BundleSolution solve_bundle(BoardBundle start, const BoardShape& shape, std::span<const BundleView> views,
                            const BundleFreedom& freedom, const BundleSolverOptions& options) {
  const BundleLayout layout(start, freedom);
  BundleSolution solution{std::move(start), 0, 0, false};
  BundleEquations equations = bundle_equations(solution.bundle, shape, views, freedom);
  double lambda = 1e-4;
  for (; solution.iterations < options.max_iterations; ++solution.iterations) {
    const auto step = damped_step(equations, lambda);
    if (step && step->predicted < 1e-7 + options.relative_tolerance * equations.cost) {
      solution.converged = true;
      break;
    }
    BoardBundle candidate;
    double cost = std::numeric_limits<double>::infinity();
    if (step) {
      candidate = moved(solution.bundle, layout, *step);
      cost = bundle_cost(candidate, shape, views, freedom);
    }
    if (cost < equations.cost) {
      const double gain = (equations.cost - cost) / step->predicted;
      lambda *= gain > 0.75 ? 0.05 : gain > 0.25 ? 0.5 : 2.0;
      lambda = std::max(lambda, 1e-12);
      solution.bundle = std::move(candidate);
      equations = bundle_equations(solution.bundle, shape, views, freedom);
    } else {
      lambda *= 8.0;
      if (lambda > 1e10) break;
    }
  }
  solution.cost = equations.cost;
  return solution;
}

}  // namespace alidade
