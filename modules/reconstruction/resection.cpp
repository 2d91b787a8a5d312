// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/resection.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <opencv2/calib3d.hpp>

#include "estimation/pose_update.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

// Object points and undistorted pixels of the observations that the model can undistort.
struct Correspondences {
  std::vector<cv::Point3d> object;
  std::vector<cv::Point2d> image;
  std::vector<int> index;
};

Correspondences gather(const Camera& camera, std::span<const PointObservation> observations) {
  Correspondences c;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const auto xy = undistort(camera, observations[i].pixel);
    if (!xy) continue;
    const Eigen::Vector3d& p = observations[i].p_world;
    c.object.emplace_back(p.x(), p.y(), p.z());
    c.image.emplace_back(camera.fx * xy->x() + camera.cx, camera.fy * xy->y() + camera.cy);
    c.index.push_back(static_cast<int>(i));
  }
  return c;
}

cv::Matx33d pinhole(const Camera& c) {
  return {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1};
}

// Points on one line, or in one place, leave a turn open; OpenCV answers nevertheless.
bool lie_on_one_line(const std::vector<cv::Point3d>& points) {
  Eigen::Matrix3Xd p(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    p.col(static_cast<Eigen::Index>(i)) << points[i].x, points[i].y, points[i].z;
  }
  p.colwise() -= p.rowwise().mean().eval();
  const Eigen::Vector3d spread = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(p * p.transpose()).eigenvalues();
  return !(spread(1) > 1e-10 * spread(2));
}

std::optional<Eigen::Isometry3d> as_pose(const cv::Vec3d& rotation, const cv::Vec3d& translation) {
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  T_camera_world.linear() = exp_so3(Eigen::Vector3d(rotation[0], rotation[1], rotation[2]));
  T_camera_world.translation() = Eigen::Vector3d(translation[0], translation[1], translation[2]);
  if (!T_camera_world.matrix().allFinite()) return std::nullopt;
  return T_camera_world.inverse();
}

}  // namespace

std::optional<Eigen::Isometry3d> solve_pnp(const Camera& camera, std::span<const PointObservation> observations,
                                           PnpMethod method) {
  const Correspondences c = gather(camera, observations);
  if (c.object.size() < 6 || lie_on_one_line(c.object)) return std::nullopt;
  cv::Vec3d rotation, translation;
  const int flag = method == PnpMethod::Sqpnp ? cv::SOLVEPNP_SQPNP : cv::SOLVEPNP_EPNP;
  try {
    if (!cv::solvePnP(c.object, c.image, pinhole(camera), cv::noArray(), rotation, translation, false, flag)) {
      return std::nullopt;
    }
    if (method == PnpMethod::EpnpLm) {
      cv::solvePnPRefineLM(c.object, c.image, pinhole(camera), cv::noArray(), rotation, translation);
    }
  } catch (const cv::Exception&) {  // other degenerate sets
    return std::nullopt;
  }
  return as_pose(rotation, translation);
}

std::optional<RansacPose> solve_pnp_ransac(const Camera& camera, std::span<const PointObservation> observations,
                                           const RansacPnpOptions& options) {
  const Correspondences c = gather(camera, observations);
  if (static_cast<int>(c.object.size()) < std::max(6, options.least_inliers)) return std::nullopt;
  cv::Vec3d rotation, translation;
  std::vector<int> inliers;
  try {
    if (!cv::solvePnPRansac(c.object, c.image, pinhole(camera), cv::noArray(), rotation, translation, false,
                            options.iterations, static_cast<float>(options.threshold_px), options.confidence, inliers,
                            options.sample_by_epnp ? cv::SOLVEPNP_EPNP : cv::SOLVEPNP_P3P)) {
      return std::nullopt;
    }
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  const auto T = as_pose(rotation, translation);
  if (!T || static_cast<int>(inliers.size()) < options.least_inliers) return std::nullopt;
  RansacPose result{*T, {}};
  for (int i : inliers) result.inliers.push_back(c.index[static_cast<std::size_t>(i)]);
  return result;
}

std::optional<Eigen::Isometry3d> solve_pnp_ransac_lm(const Camera& camera,
                                                     std::span<const PointObservation> observations, double sigma_px) {
  constexpr double kGateChi2 = PoseUpdateOptions{}.gate_chi2;
  RansacPnpOptions options;
  options.sample_by_epnp = true;
  options.confidence = 0.99;
  options.threshold_px = 3.0 * sigma_px;
  auto pose = solve_pnp_ransac(camera, observations, options);
  if (!pose) return std::nullopt;
  for (int round = 0; round < 2; ++round) {
    const Eigen::Isometry3d T_camera_world = pose->T_world_camera.inverse();
    std::vector<PointObservation> fitting;
    for (const PointObservation& o : observations) {
      const auto projection = project(camera, T_camera_world * o.p_world);
      if (projection && (projection->pixel - o.pixel).squaredNorm() < kGateChi2 * sigma_px * sigma_px) {
        fitting.push_back(o);
      }
    }
    if (const auto T = solve_pnp(camera, fitting, PnpMethod::EpnpLm)) pose->T_world_camera = *T;
  }
  return pose->T_world_camera;
}

std::optional<Matrix6d> resection_covariance(const Camera& camera, const Eigen::Isometry3d& T_world_camera,
                                             std::span<const PointObservation> observations) {
  Matrix6d information = Matrix6d::Zero();
  double chi2 = 0;
  int count = 0;
  for (const PointObservation& o : observations) {
    const Eigen::Vector3d p_camera = T_world_camera.inverse() * o.p_world;
    const auto projection = project(camera, p_camera);
    if (!projection) continue;
    Eigen::Matrix<double, 2, 6> J;
    J << -projection->J_pixel_point, projection->J_pixel_point * skew(p_camera);
    J /= o.sigma_px;
    information += J.transpose() * J;
    chi2 += (o.pixel - projection->pixel).squaredNorm() / (o.sigma_px * o.sigma_px);
    ++count;
  }
  const Eigen::LDLT<Matrix6d> factor(information);
  if (count < 6 || !factor.isPositive() || factor.rcond() < 1e-16) return std::nullopt;
  const double variance = std::max(1.0, chi2 / (2.0 * count - 6.0));
  return Matrix6d(variance * factor.solve(Matrix6d::Identity()));
}

}  // namespace alidade
