// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/bundle_adjustment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>
#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

// Ceres writes what it thinks of a step to stderr through glog, whatever its own logging_type; the summary tells us.
void keep_ceres_quiet() {
  FLAGS_minloglevel = google::GLOG_FATAL;
}

// A pose as Ceres sees it: quaternion x y z w of R_world_camera, then the centre.
using PoseBlock = std::array<double, 7>;

PoseBlock to_block(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  return {q.x(), q.y(), q.z(), q.w(), T.translation().x(), T.translation().y(), T.translation().z()};
}

Eigen::Isometry3d to_pose(const double* block) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(block[3], block[0], block[1], block[2]).normalized().toRotationMatrix();
  T.translation() = Eigen::Vector3d(block[4], block[5], block[6]);
  return T;
}

// T ⊞ xi = T * perturbation(xi). Costs give their Jacobian with respect to xi in the first six ambient columns, and
// PlusJacobian picks exactly those: only the product of the two enters the normal equations.
class PoseManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }

  bool Plus(const double* x, const double* delta, double* moved) const override {
    const Eigen::Isometry3d T = to_pose(x) * perturbation(Eigen::Map<const Vector6d>(delta));
    const PoseBlock block = to_block(T);
    std::copy(block.begin(), block.end(), moved);
    return true;
  }

  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.topRows<6>().setIdentity();
    return true;
  }

  bool Minus(const double* y, const double* x, double* delta) const override {
    Eigen::Map<Vector6d> xi(delta);
    xi = difference(to_pose(x), to_pose(y));
    return true;
  }

  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.leftCols<6>().setIdentity();
    return true;
  }
};

// (h(pose, point, focal factor) - pixel) / sigma.
class SightingCost : public ceres::SizedCostFunction<2, 7, 3, 1> {
 public:
  SightingCost(const Camera& camera, const Sighting& sighting) : camera_(camera), sighting_(sighting) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Isometry3d T = to_pose(parameters[0]);
    const Eigen::Map<const Eigen::Vector3d> p_world(parameters[1]);
    Camera camera = camera_;
    camera.fx *= parameters[2][0];
    camera.fy *= parameters[2][0];
    const Eigen::Vector3d p_camera = T.linear().transpose() * (p_world - T.translation());
    const auto projection = project(camera, p_camera);
    Eigen::Map<Eigen::Vector2d> r(residuals);
    if (!projection) {  // behind the camera: a step that goes there must look bad
      r.setConstant(1e3);
      if (jacobians) clear(jacobians);
      return true;
    }
    r = (projection->pixel - sighting_.pixel) / sighting_.sigma_px;
    if (jacobians) differentiate(camera, *projection, T, p_camera, parameters[2][0], jacobians);
    return true;
  }

 private:
  void differentiate(const Camera& camera, const Projection& projection, const Eigen::Isometry3d& T,
                     const Eigen::Vector3d& p_camera, double factor, double** jacobians) const {
    const Eigen::Matrix<double, 2, 3> J = projection.J_pixel_point / sighting_.sigma_px;
    if (jacobians[0]) {
      Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> J_pose(jacobians[0]);
      J_pose << -J, J * skew(p_camera), Eigen::Vector2d::Zero();
    }
    if (jacobians[1]) {
      Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>> J_point(jacobians[1]);
      J_point = J * T.linear().transpose();
    }
    if (jacobians[2]) {
      Eigen::Map<Eigen::Vector2d> J_factor(jacobians[2]);
      J_factor = (projection.pixel - Eigen::Vector2d(camera.cx, camera.cy)) / (factor * sighting_.sigma_px);
    }
  }

  static void clear(double** jacobians) {
    constexpr std::array<int, 3> kSizes{14, 6, 2};
    for (std::size_t i = 0; i < kSizes.size(); ++i) {
      if (jacobians[i]) std::fill_n(jacobians[i], kSizes[i], 0.0);
    }
  }

  Camera camera_;
  Sighting sighting_;
};

// The blocks that Ceres moves, kept in vectors so that their addresses, by which it orders them, follow their indices.
struct Blocks {
  std::vector<PoseBlock> poses;
  std::vector<std::array<double, 3>> points;
  double focal_factor = 1.0;
};

Blocks gather_blocks(const PointMap& map) {
  Blocks blocks;
  for (const Keyframe& keyframe : map.keyframes) blocks.poses.push_back(to_block(keyframe.T_world_camera));
  for (const MapPoint& point : map.points) {
    blocks.points.push_back({point.p_world.x(), point.p_world.y(), point.p_world.z()});
  }
  return blocks;
}

void require_indices(const PointMap& map, const BundleOptions& options) {
  const auto require = [](int index, std::size_t count, const char* what) {
    if (index >= 0 && static_cast<std::size_t>(index) < count) return;
    throw std::invalid_argument(fmt::format("adjust_bundle: {} {} of {}", what, index, count));
  };
  for (const auto* list : {&options.free_keyframes, &options.fixed_keyframes}) {
    for (int k : *list) {
      require(k, map.keyframes.size(), "keyframe");
      for (const Sighting& s : map.keyframes[static_cast<std::size_t>(k)].sightings) {
        require(s.point, map.points.size(), "point");
      }
    }
  }
}

std::vector<bool> adjustable_points(const PointMap& map, const BundleOptions& options) {
  std::vector<int> seen(map.points.size(), 0);
  std::vector<bool> moves(map.points.size(), false);
  for (const auto* list : {&options.free_keyframes, &options.fixed_keyframes}) {
    for (int k : *list) {
      for (const Sighting& s : map.keyframes[static_cast<std::size_t>(k)].sightings) {
        ++seen[static_cast<std::size_t>(s.point)];
        if (list == &options.free_keyframes) moves[static_cast<std::size_t>(s.point)] = true;
      }
    }
  }
  for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = moves[i] && seen[i] >= 2;
  return moves;
}

// Adds the sightings of `keyframes` to the problem and returns how many there are.
int add_sightings(ceres::Problem& problem, Blocks& blocks, const Camera& camera, const PointMap& map,
                  const std::vector<int>& keyframes, const std::vector<bool>& moves, ceres::LossFunction* loss) {
  int count = 0;
  for (int k : keyframes) {
    for (const Sighting& s : map.keyframes[static_cast<std::size_t>(k)].sightings) {
      if (!moves[static_cast<std::size_t>(s.point)]) continue;
      problem.AddResidualBlock(new SightingCost(camera, s), loss, blocks.poses[static_cast<std::size_t>(k)].data(),
                               blocks.points[static_cast<std::size_t>(s.point)].data(), &blocks.focal_factor);
      ++count;
    }
  }
  return count;
}

ceres::Solver::Options solver_options(const BundleOptions& options, Blocks& blocks, const ceres::Problem& problem) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = options.free_keyframes.size() > 150 ? ceres::SPARSE_SCHUR : ceres::DENSE_SCHUR;
  solver.max_num_iterations = options.max_iterations;
  solver.num_threads = 1;  // sums in one order only: the same input gives the same bits
  solver.logging_type = ceres::SILENT;
  solver.function_tolerance = 1e-7;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (auto& point : blocks.points) {
    if (problem.HasParameterBlock(point.data())) ordering->AddElementToGroup(point.data(), 0);
  }
  for (auto& pose : blocks.poses) {
    if (problem.HasParameterBlock(pose.data())) ordering->AddElementToGroup(pose.data(), 1);
  }
  ordering->AddElementToGroup(&blocks.focal_factor, 1);
  solver.linear_solver_ordering = ordering;
  return solver;
}

double rms_px(const Camera& camera, const PointMap& map, const BundleOptions& options, const std::vector<bool>& moves) {
  double sum = 0;
  int count = 0;
  for (const auto* list : {&options.free_keyframes, &options.fixed_keyframes}) {
    for (int k : *list) {
      const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(k)];
      const Eigen::Isometry3d T_camera_world = keyframe.T_world_camera.inverse();
      for (const Sighting& s : keyframe.sightings) {
        const auto point = static_cast<std::size_t>(s.point);
        if (!moves[point]) continue;
        const auto projection = project(camera, T_camera_world * map.points[point].p_world);
        if (!projection) continue;
        sum += (projection->pixel - s.pixel).squaredNorm();
        ++count;
      }
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

// The robust cost is half a squared distance in standard deviations: what freeing the focal length has gained tells
// how many of its own it has moved. A scale-free problem has no covariance to ask.
double focal_sigma(double focal_factor, double cost_before, double cost_after) {
  const double gained = 2.0 * (cost_before - cost_after);
  return gained > 0 ? std::abs(focal_factor - 1.0) / std::sqrt(gained) : 0.0;
}

}  // namespace

BundleResult adjust_bundle(const Camera& camera, PointMap map, const BundleOptions& options) {
  require_indices(map, options);
  const std::vector<bool> moves = adjustable_points(map, options);
  BundleResult result;
  result.rms_px_before = rms_px(camera, map, options, moves);

  Blocks blocks = gather_blocks(map);
  ceres::CauchyLoss loss(options.loss_sigmas);
  PoseManifold manifold;
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  result.sighting_count = add_sightings(problem, blocks, camera, map, options.free_keyframes, moves, &loss) +
                          add_sightings(problem, blocks, camera, map, options.fixed_keyframes, moves, &loss);
  if (result.sighting_count == 0) {
    result.map = std::move(map);
    return result;
  }
  for (auto& pose : blocks.poses) {
    if (problem.HasParameterBlock(pose.data())) problem.SetManifold(pose.data(), &manifold);
  }
  for (int k : options.fixed_keyframes) {
    double* pose = blocks.poses[static_cast<std::size_t>(k)].data();
    if (problem.HasParameterBlock(pose)) problem.SetParameterBlockConstant(pose);
  }
  if (!options.refine_focal) problem.SetParameterBlockConstant(&blocks.focal_factor);

  ceres::Solver::Summary summary;
  keep_ceres_quiet();
  ceres::Solve(solver_options(options, blocks, problem), &problem, &summary);
  result.iterations = static_cast<int>(summary.iterations.size());
  result.seconds = summary.total_time_in_seconds;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.focal_factor = blocks.focal_factor;
  if (options.refine_focal) {
    result.focal_factor_sigma = focal_sigma(blocks.focal_factor, summary.initial_cost, summary.final_cost);
  }

  for (int k : options.free_keyframes) {
    const auto i = static_cast<std::size_t>(k);
    map.keyframes[i].T_world_camera = to_pose(blocks.poses[i].data());
  }
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    if (moves[i]) map.points[i].p_world = Eigen::Map<const Eigen::Vector3d>(blocks.points[i].data());
  }
  Camera adjusted = camera;
  adjusted.fx *= result.focal_factor;
  adjusted.fy *= result.focal_factor;
  result.rms_px_after = rms_px(adjusted, map, options, moves);
  result.map = std::move(map);
  return result;
}

BundleOptions global_bundle_options(const PointMap& map, int fixed_count) {
  BundleOptions options;
  for (int k = 0; k < static_cast<int>(map.keyframes.size()); ++k) {
    (k < fixed_count ? options.fixed_keyframes : options.free_keyframes).push_back(k);
  }
  return options;
}

SightingCut remove_outlying_sightings(const Camera& camera, PointMap map, double most_sigmas) {
  std::vector<int> left(map.points.size(), 0);
  SightingCut cut;
  for (Keyframe& keyframe : map.keyframes) {
    const Eigen::Isometry3d T_camera_world = keyframe.T_world_camera.inverse();
    cut.removed += static_cast<int>(std::erase_if(keyframe.sightings, [&](const Sighting& s) {
      const auto projection = project(camera, T_camera_world * map.points[static_cast<std::size_t>(s.point)].p_world);
      const bool fits = projection && (projection->pixel - s.pixel).norm() <= most_sigmas * s.sigma_px;
      if (fits) ++left[static_cast<std::size_t>(s.point)];
      return !fits;
    }));
  }
  for (Keyframe& keyframe : map.keyframes) {
    cut.removed += static_cast<int>(std::erase_if(
        keyframe.sightings, [&](const Sighting& s) { return left[static_cast<std::size_t>(s.point)] < 2; }));
  }
  cut.map = std::move(map);
  return cut;
}

double reprojection_sigma(const Camera& camera, const PointMap& map) {
  std::vector<double> lengths;
  for (const Keyframe& keyframe : map.keyframes) {
    const Eigen::Isometry3d T_camera_world = keyframe.T_world_camera.inverse();
    for (const Sighting& s : keyframe.sightings) {
      const auto projection = project(camera, T_camera_world * map.points[static_cast<std::size_t>(s.point)].p_world);
      if (projection) lengths.push_back((projection->pixel - s.pixel).norm() / s.sigma_px);
    }
  }
  if (lengths.empty()) return 1.0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle / 1.1774;  // the median of a Rayleigh distribution
}

double reprojection_rms_px(const Camera& camera, const PointMap& map) {
  return rms_px(camera, map, global_bundle_options(map, 0), std::vector<bool>(map.points.size(), true));
}

}  // namespace alidade
