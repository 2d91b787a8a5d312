// SPDX-License-Identifier: Apache-2.0
#include "estimation/pose_update.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "geometry/rotation.h"

namespace alidade {
namespace {

// One observation linearised about a pose: residual = pixel - h(pose), and its Jacobian with respect to xi.
struct Linearised {
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 6> J;
  Eigen::Matrix2d R_inverse;

  double chi2() const { return residual.dot(R_inverse * residual); }
};

class PoseProblem {
 public:
  PoseProblem(const Camera& camera, const PosePrior& prior, std::span<const PointObservation> observations,
              const PoseUpdateOptions& options)
      : camera_(camera), prior_(prior), observations_(observations), options_(options) {}

  std::optional<Linearised> linearise(const Eigen::Isometry3d& T_world_camera, std::size_t i) const {
    const PointObservation& o = observations_[i];
    const Eigen::Vector3d p_camera = T_world_camera.inverse() * o.p_world;
    const auto projection = project(camera_, p_camera);
    if (!projection) return std::nullopt;
    Linearised l;
    l.residual = o.pixel - projection->pixel;
    // p_camera' = exp(-θ)(p_camera - δ): minus identity and skew(p_camera).
    l.J.leftCols<3>() = -projection->J_pixel_point;
    l.J.rightCols<3>() = projection->J_pixel_point * skew(p_camera);
    Eigen::Matrix2d R = o.sigma_px * o.sigma_px * Eigen::Matrix2d::Identity();
    if (options_.map_covariance) {
      const Eigen::Matrix<double, 2, 3> J_X = projection->J_pixel_point * T_world_camera.linear().transpose();
      R += J_X * o.covariance_world * J_X.transpose();
    }
    l.R_inverse = R.inverse();
    return l;
  }

  std::size_t size() const { return observations_.size(); }

  // Which observations may belong to the prior's pose: the χ² gate with the innovation covariance J P Jᵀ + R.
  std::vector<bool> gate_about_prior() const {
    const Matrix6d P = prior_covariance();
    std::vector<bool> passes(size(), false);
    for (std::size_t i = 0; i < size(); ++i) {
      const auto l = linearise(prior_.T_world_camera, i);
      if (!l) continue;
      const Eigen::Matrix2d S = l->J * P * l->J.transpose() + l->R_inverse.inverse();
      const double wide = std::max(options_.gate_chi2, 16.0);  // the robust phase decides; the gate only trims
      passes[i] = l->residual.dot(S.inverse() * l->residual) <= wide &&
                  l->residual.norm() <= options_.loosest_gate_px + 4.0 * observations_[i].sigma_px;
    }
    return passes;
  }

  // Gauss–Newton on the active observations. `mu` is the scale of the Geman–McClure weight in units of the gate;
  // infinite: plain least squares. Returns the pose; `information` is that of the last step.
  Eigen::Isometry3d descend(Eigen::Isometry3d T, const std::vector<bool>& active, double mu, int steps,
                            Matrix6d& information) const {
    for (int step = 0; step < steps; ++step) {
      const Vector6d from_prior = difference(prior_.T_world_camera, T);
      const Matrix6d J_prior = prior_jacobian(T, from_prior);
      const Matrix6d JtI = J_prior.transpose() * prior_.information;
      Matrix6d A = JtI * J_prior;
      Vector6d b = -JtI * from_prior;
      for (std::size_t i = 0; i < size(); ++i) {
        if (!active[i]) continue;
        const auto l = linearise(T, i);
        if (!l) continue;
        const double ratio = l->chi2() / (mu * options_.gate_chi2);
        const double weight = 1.0 / ((1.0 + ratio) * (1.0 + ratio));
        const Eigen::Matrix<double, 6, 2> JtW = weight * l->J.transpose() * l->R_inverse;
        A += JtW * l->J;
        b += JtW * l->residual;
      }
      information = A;
      const Vector6d xi = A.ldlt().solve(b);
      if (!xi.allFinite()) break;
      T = T * perturbation(xi);
      T.linear() = exp_so3(log_so3(T.linear()));
      if (xi.dot(A * xi) < 1e-10) break;  // below 1e-5 of a standard deviation
    }
    return T;
  }

  std::vector<bool> inliers_at(const Eigen::Isometry3d& T) const {
    std::vector<bool> inlier(size(), false);
    for (std::size_t i = 0; i < size(); ++i) {
      const auto l = linearise(T, i);
      inlier[i] = l && l->chi2() <= options_.gate_chi2;
    }
    return inlier;
  }

  double chi2_per_dof(const Eigen::Isometry3d& T, const std::vector<bool>& active) const {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      if (!active[i]) continue;
      if (const auto l = linearise(T, i)) {
        sum += l->chi2();
        ++count;
      }
    }
    return count > 3 ? sum / (2.0 * count - 6.0) : 0.0;
  }

 private:
  // How the difference from the prior moves with xi: the pose's axes have turned away from the prior's.
  Matrix6d prior_jacobian(const Eigen::Isometry3d& T, const Vector6d& from_prior) const {
    Matrix6d J = Matrix6d::Zero();
    J.topLeftCorner<3, 3>() = prior_.T_world_camera.linear().transpose() * T.linear();
    J.bottomRightCorner<3, 3>() = right_jacobian_so3(from_prior.tail<3>()).inverse();
    return J;
  }

  Matrix6d prior_covariance() const {
    // A prior that knows nothing gates nothing: a tiny information keeps the inverse finite.
    const Matrix6d I = prior_.information + 1e-9 * Matrix6d::Identity();
    return I.inverse();
  }

  const Camera& camera_;
  const PosePrior& prior_;
  std::span<const PointObservation> observations_;
  const PoseUpdateOptions& options_;
};

}  // namespace

std::optional<PoseUpdate> update_pose(const Camera& camera, const PosePrior& prior,
                                      std::span<const PointObservation> observations,
                                      const PoseUpdateOptions& options) {
  const PoseProblem problem(camera, prior, observations, options);
  const std::vector<bool> gated = problem.gate_about_prior();
  if (std::count(gated.begin(), gated.end(), true) < options.least_inliers) return std::nullopt;

  // Graduated non-convexity: the weight function narrows from far beyond the gate down to it.
  PoseUpdate result;
  Matrix6d information = Matrix6d::Zero();
  Eigen::Isometry3d T = prior.T_world_camera;
  for (double mu : {64.0, 8.0, 1.0}) T = problem.descend(T, gated, mu, options.max_iterations / 3, information);

  constexpr double kPlain = 1e12;
  for (int round = 0; round < 2; ++round) {  // the second round takes back what the first one moved across the gate
    result.is_inlier = problem.inliers_at(T);
    result.inlier_count = static_cast<int>(std::count(result.is_inlier.begin(), result.is_inlier.end(), true));
    if (result.inlier_count < options.least_inliers) return std::nullopt;
    T = problem.descend(T, result.is_inlier, kPlain, options.max_iterations / 3, information);
  }
  const Eigen::LDLT<Matrix6d> factor(information);
  if (!factor.isPositive() || factor.rcond() < 1e-16) return std::nullopt;
  result.T_world_camera = T;
  result.covariance = factor.solve(Matrix6d::Identity());
  result.chi2_per_dof = problem.chi2_per_dof(T, result.is_inlier);
  return result;
}

std::optional<Eigen::Matrix2d> measurement_noise(const Camera& camera, const Eigen::Isometry3d& T_world_camera,
                                                 const PointObservation& observation, bool map_covariance) {
  PosePrior here;
  here.T_world_camera = T_world_camera;
  PoseUpdateOptions options;
  options.map_covariance = map_covariance;
  const auto l = PoseProblem(camera, here, {&observation, 1}, options).linearise(T_world_camera, 0);
  if (!l) return std::nullopt;
  return l->R_inverse.inverse();
}

}  // namespace alidade
