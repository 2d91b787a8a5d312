// SPDX-License-Identifier: Apache-2.0
#include "tracking/unscented_filter.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

namespace alidade {
namespace {

constexpr int kSize = 6;
constexpr int kPairs = 2 * kSize;  // sigma points besides the mean
constexpr int kColumns = kPairs + 1;

using SigmaPixels = Eigen::Matrix<double, 2, kPairs>;

struct SigmaPoses {
  Eigen::Isometry3d T_camera_world;  // of the mean
  std::vector<Eigen::Isometry3d> T_sigma_world;
};

// The pixels of the sigma points less the mean's, which is given besides.
struct PixelSpread {
  Eigen::Vector2d of_mean;
  SigmaPixels off;
};

std::optional<PixelSpread> pixel_spread(const Camera& camera, const SigmaPoses& poses, const Eigen::Vector3d& p_world) {
  const auto centre = project(camera, poses.T_camera_world * p_world);
  if (!centre) return std::nullopt;
  PixelSpread spread{centre->pixel, {}};
  for (Eigen::Index i = 0; i < kPairs; ++i) {
    const auto projection = project(camera, poses.T_sigma_world[static_cast<std::size_t>(i)] * p_world);
    if (!projection) return std::nullopt;
    spread.off.col(i) = projection->pixel - centre->pixel;
  }
  return spread;
}

}  // namespace

PoseLikelihood unscented_likelihood(const Camera& camera, const MotionState& predicted,
                                    std::span<const PointObservation> observations, const UnscentedOptions& options) {
  if (!(options.alpha > 0 && options.alpha * options.alpha <= options.beta)) {
    throw std::invalid_argument(fmt::format("alpha must be in (0, sqrt(beta)], got {}", options.alpha));
  }
  const Matrix6d P = covariance_in_map(predicted);
  const double spread = options.alpha * std::sqrt(static_cast<double>(kSize));
  const double weight = 0.5 / (spread * spread);
  const double shift_weight = options.beta - options.alpha * options.alpha;
  Eigen::Matrix<double, kSize, kPairs> xi;
  xi << spread * Matrix6d(P.llt().matrixL()), -spread * Matrix6d(P.llt().matrixL());
  SigmaPoses poses{predicted.T_world_body.inverse(), {}};
  for (const auto& x : xi.colwise()) {
    poses.T_sigma_world.push_back((predicted.T_world_body * perturbation(x)).inverse());
  }
  // Sums about the mean's own pixel, so that no weight is negative: with D the pixels' differences from it, w their
  // weight and s = w Σ D the mean's shift, P_zz = w D Dᵀ + (beta - alpha²) s sᵀ + R = Z Zᵀ + R. With P = X Xᵀ and
  // P_xz = X Zᵀ the push-through identity leaves 13×13 of 2n×2n: K = X M⁻¹ Zᵀ R⁻¹ and P - K P_zz Kᵀ = X M⁻¹ Xᵀ with
  // M = I + Zᵀ R⁻¹ Z.
  Eigen::Matrix<double, kColumns, kColumns> M = Eigen::Matrix<double, kColumns, kColumns>::Identity();
  Eigen::Matrix<double, kColumns, 1> innovation = Eigen::Matrix<double, kColumns, 1>::Zero();
  for (const PointObservation& o : observations) {
    const auto pixels = pixel_spread(camera, poses, o.p_world);
    if (!pixels) continue;
    const Eigen::Vector2d shift = weight * pixels->off.rowwise().sum();
    Eigen::Matrix<double, 2, kColumns> Z;
    Z << std::sqrt(weight) * pixels->off, std::sqrt(shift_weight) * shift;
    Z /= o.sigma_px;
    M += Z.transpose() * Z;
    innovation += Z.transpose() * (o.pixel - pixels->of_mean - shift) / o.sigma_px;
  }
  Eigen::Matrix<double, kSize, kColumns> X;
  X << std::sqrt(weight) * xi, Vector6d::Zero();
  const auto factor = M.ldlt();
  const Matrix6d information = Matrix6d(X * factor.solve(X.transpose())).ldlt().solve(Matrix6d::Identity());
  PoseLikelihood likelihood;
  likelihood.T_world_body = predicted.T_world_body;
  likelihood.gradient = information * (X * factor.solve(innovation));
  likelihood.information = information - P.ldlt().solve(Matrix6d::Identity());
  likelihood.information = 0.5 * (likelihood.information + likelihood.information.transpose()).eval();
  return likelihood;
}

MotionState update_unscented_filter(const Camera& camera, const MotionState& predicted,
                                    std::span<const PointObservation> observations, const UnscentedOptions& options) {
  return absorb(predicted, unscented_likelihood(camera, predicted, observations, options));
}

}  // namespace alidade
