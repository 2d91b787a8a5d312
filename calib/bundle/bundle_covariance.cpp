// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/bundle_covariance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "calib/bundle/projection_uncertainty.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

using Rows6 = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// How the frames' mean motion follows one frame's own, xi_frame: u + w × p is R rho + (R phi) × (p - t).
Matrix6d motion_of_frame(const Eigen::Isometry3d& T_rig_board) {
  Matrix6d M = Matrix6d::Zero();
  M.topLeftCorner<3, 3>() = T_rig_board.linear();
  M.topRightCorner<3, 3>() = skew(T_rig_board.translation()) * T_rig_board.linear();
  M.bottomRightCorner<3, 3>() = T_rig_board.linear();
  return M;
}

// The equations with the frames eliminated.
struct ReducedEquations {
  Eigen::MatrixXd S;
  std::vector<Eigen::MatrixXd> S_frame;      // each frame's part of it
  std::vector<Eigen::VectorXd> score_frame;  // each frame's part of the gradient
  Rows6 B;                                   // the mean motion that goes with the shared parameters, negative
  Matrix6d own_motion;                       // covariance of the mean motion for shared parameters that stand
};

ReducedEquations reduce(const BundleFit& fit, const BoardShape& shape, const BundleFreedom& freedom) {
  const BundleLayout layout(fit.bundle, freedom);
  const std::size_t frames = fit.bundle.T_rig_board.size();
  const BundleEquations priors = bundle_equations(fit.bundle, shape, {}, freedom);
  ReducedEquations reduced{priors.H, {}, {}, Rows6::Zero(6, layout.size), Matrix6d::Zero()};
  std::vector<std::vector<BundleView>> by_frame(frames);
  for (const BundleView& view : fit.views) by_frame[static_cast<std::size_t>(view.frame)].push_back(view);
  int seen = 0;
  for (std::size_t f = 0; f < frames; ++f) {
    const BundleEquations e = bundle_equations(fit.bundle, shape, by_frame[f], freedom);
    const Eigen::LLT<Matrix6d> factor(e.H_frame[f]);
    if (factor.info() != Eigen::Success || !(e.H_frame[f].diagonal().minCoeff() > 0)) continue;
    ++seen;
    const Rows6 X = factor.solve(e.H_frame_shared[f]);
    const Matrix6d M = motion_of_frame(fit.bundle.T_rig_board[f]);
    reduced.S_frame.push_back(e.H - priors.H - e.H_frame_shared[f].transpose() * X);
    reduced.score_frame.push_back(e.g - priors.g - X.transpose() * e.g_frame[f]);
    reduced.S += reduced.S_frame.back();
    reduced.B += M * X;
    reduced.own_motion += M * factor.solve(M.transpose());
  }
  if (seen > 0) {
    reduced.B /= seen;
    reduced.own_motion /= static_cast<double>(seen) * seen;
  }
  return reduced;
}

// Scaled to a unit diagonal before it is inverted; empty where the matrix is not positive definite.
std::optional<Eigen::MatrixXd> inverse(const Eigen::MatrixXd& S) {
  if (S.rows() == 0) return S;
  if (!(S.diagonal().minCoeff() > 0)) return std::nullopt;
  const Eigen::VectorXd scale = S.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * S * scale.asDiagonal());
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd solved = factor.solve(Eigen::MatrixXd::Identity(S.rows(), S.rows()));
  return scale.asDiagonal() * solved * scale.asDiagonal();
}

// `parameters`: those of all frames that a view shows and the shared ones.
// Of one coordinate in units of the corners' sigma_px, each by its weight.
double residual_sigma(const BundleFit& fit, const BoardShape& shape, int parameters) {
  double sum = 0;
  int count = 0;
  for (const BundleView& view : fit.views) {
    const auto residuals = residuals_px(fit.bundle, shape, view);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (view.weights[i] <= 0) continue;
      sum += view.weights[i] * residuals[i].squaredNorm() / std::pow(view.corners[i].sigma_px, 2);
      count += 2;
    }
  }
  return std::sqrt(sum / std::max(1, count - parameters));
}

// The jackknife's variance of pixels, frame by frame left out, in units of the variance that independent errors have:
// the median over the image, since at its corners a single frame may decide. Source: Efron and Stein 1981, with the
// influence of a frame in closed form.
double variance_ratio(const BundleFit& fit, const BundleFreedom& freedom, const ReducedEquations& reduced,
                      const Eigen::MatrixXd& C, double sigma) {
  const std::size_t frames = reduced.S_frame.size();
  if (frames < 4) return 1;
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(C.rows(), C.cols());
  for (std::size_t f = 0; f < frames; ++f) {
    const auto without = inverse(reduced.S - reduced.S_frame[f]);
    if (!without) return 1;
    const Eigen::VectorXd influence = *without * reduced.score_frame[f];
    spread += influence * influence.transpose();
  }
  spread *= (static_cast<double>(frames) - 1.0) / static_cast<double>(frames);
  std::vector<double> ratios;
  for (const Eigen::MatrixXd& J : pixel_jacobians(fit, freedom)) {
    const Eigen::MatrixXd J_shared = J.leftCols(C.cols()) - J.rightCols<6>() * reduced.B;
    const double independent = sigma * sigma * (J_shared * C * J_shared.transpose()).trace();
    if (independent > 0) ratios.push_back((J_shared * spread * J_shared.transpose()).trace() / independent);
  }
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

}  // namespace

std::optional<BundleCovariance> bundle_covariance(const BundleFit& fit, const BoardShape& shape,
                                                  const BundleFreedom& freedom) {
  const ReducedEquations reduced = reduce(fit, shape, freedom);
  const auto C = inverse(reduced.S);
  if (!C || !C->allFinite()) return std::nullopt;
  const Eigen::Index n = C->rows();
  BundleCovariance covariance;
  covariance.sigma = residual_sigma(fit, shape, static_cast<int>(n) + 6 * static_cast<int>(reduced.S_frame.size()));
  // With a dozen frames the jackknife itself scatters by a third: only what is plainly more counts.
  const double ratio = variance_ratio(fit, freedom, reduced, *C, covariance.sigma);
  if (ratio > 2.0) covariance.within_views = ratio;
  covariance.shared_and_motion = Eigen::MatrixXd(n + 6, n + 6);
  covariance.shared_and_motion.topLeftCorner(n, n) = *C;
  covariance.shared_and_motion.bottomLeftCorner(6, n) = -reduced.B * *C;
  covariance.shared_and_motion.topRightCorner(n, 6) = -*C * reduced.B.transpose();
  covariance.shared_and_motion.bottomRightCorner<6, 6>() = reduced.own_motion + reduced.B * *C * reduced.B.transpose();
  covariance.shared_and_motion *= covariance.sigma * covariance.sigma * covariance.within_views;
  return covariance;
}

Eigen::VectorXd intrinsics_sigma(const BundleCovariance& covariance, const BundleLayout& layout, int camera) {
  return covariance.shared_and_motion.diagonal()
      .segment(layout.intrinsics_at(camera), static_cast<Eigen::Index>(layout.free_of(camera).size()))
      .cwiseSqrt();
}

Eigen::MatrixXd intrinsics_covariance(const BundleCovariance& covariance, const BundleLayout& layout,
                                      const Camera& camera, int index) {
  const Eigen::Index n = intrinsics(camera).size();
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  const int at = layout.intrinsics_at(index);
  const std::vector<int>& free = layout.free_of(index);
  const auto size = static_cast<Eigen::Index>(free.size());
  C(free, free) = covariance.shared_and_motion.block(at, at, size, size);
  return C;
}

}  // namespace alidade
