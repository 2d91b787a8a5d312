// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <ceres/ceres.h>
#include <fmt/format.h>

#include "app/experiments/body_experiment.h"
#include "datasets/body_scene.h"
#include "estimation/line_bound.h"
#include "geometry/plane_pose.h"
#include "geometry/rotation.h"
#include "marker1d/paper_pose.h"
#include "marker1d/paper_rotation.h"

namespace alidade {
namespace {

constexpr double kStep = 1e-5;  // of central differences
constexpr double kStart_m = 0.01, kStart_rad = 0.05;

// One moment of the scene, as planes.
struct Problem {
  Eigen::Isometry3d truth, start;
  std::vector<MarkerPlane> planes;
};

std::vector<Problem> make_problems(const BodySceneOptions& options, const std::vector<LineDetector>& detectors,
                                   const RigidBody& body) {
  BodyScene scene(options);
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> normal;
  std::vector<Problem> problems;
  while (const auto frame = scene.next()) {
    Problem problem{pose_in_scene(0, frame->time), {}, {}};
    problem.planes = marker_planes(detectors, body, frame->readings, problem.truth);
    Vector6d off;
    for (int i = 0; i < 6; ++i) off[i] = (i < 3 ? kStart_m : kStart_rad) / std::sqrt(3.0) * normal(random);
    problem.start = problem.truth * perturbation(off);
    problems.push_back(std::move(problem));
  }
  return problems;
}

PaperCost cost_of(const RigidBody& body, const Problem& problem) {
  PaperSums sums(body, problem.start.translation());
  for (const MarkerPlane& plane : problem.planes) sums.add(plane, plane.weight);
  return eliminate_translation(sums).value();
}

std::optional<Eigen::Isometry3d> solve_by_paper(const RigidBody& body, const Problem& problem) {
  const auto pose = solve_paper_pose(cost_of(body, problem), problem.start.linear());
  if (!pose) return std::nullopt;
  return pose->T_world_body;
}

// Sums about the start's place: near the body, their digits go into the pose.
std::optional<Eigen::Isometry3d> solve_by_sums(const RigidBody& body, const Problem& problem) {
  const Eigen::Vector3d origin = problem.start.translation();
  PlaneSums sums;
  for (const MarkerPlane& p : problem.planes) {
    sums.add({body.markers[static_cast<std::size_t>(p.marker)].p_body,
              {p.plane_world.normal, p.plane_world.offset - p.plane_world.normal.dot(origin)},
              p.weight});
  }
  Eigen::Isometry3d start = problem.start;
  start.translation().setZero();
  auto T = newton_pose(sums, start);
  if (T) T->translation() += origin;
  return T;
}

struct PlaneDistance {
  Eigen::Vector3d p_body, normal;
  double offset, root_weight;

  template <class T>
  bool operator()(const T* pose, T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q(pose);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> t(pose + 4);
    residual[0] = ((q * p_body.cast<T>() + t).dot(normal.cast<T>()) - offset) * root_weight;
    return true;
  }
};

Eigen::Isometry3d solve_by_ceres(const RigidBody& body, const Problem& problem) {
  double pose[7];
  Eigen::Map<Eigen::Quaterniond>(pose).coeffs() = Eigen::Quaterniond(problem.start.linear()).coeffs();
  const Eigen::Vector3d origin = problem.start.translation();
  Eigen::Map<Eigen::Vector3d>(pose + 4).setZero();
  ceres::Problem ceres_problem;
  for (const MarkerPlane& p : problem.planes) {
    ceres_problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PlaneDistance, 1, 7>(new PlaneDistance{
                                       body.markers[static_cast<std::size_t>(p.marker)].p_body, p.plane_world.normal,
                                       p.plane_world.offset - p.plane_world.normal.dot(origin), std::sqrt(p.weight)}),
                                   nullptr, pose);
  }
  ceres_problem.SetManifold(pose,
                            new ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>{});
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-16;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Map<Eigen::Quaterniond>(pose).normalized().toRotationMatrix();
  T.translation() = Eigen::Map<Eigen::Vector3d>(pose + 4) + origin;
  return T;
}

double apart_m(const std::optional<Eigen::Isometry3d>& a, const std::optional<Eigen::Isometry3d>& b) {
  if (!a || !b) return std::numeric_limits<double>::infinity();
  return difference(*a, *b).norm();  // m and rad alike
}

// The largest difference from central differences, as a share of the largest entry.
template <typename Derived, typename Function>
double derivative_error(const Eigen::MatrixBase<Derived>& J, const Function& f) {
  double worst = 0;
  for (int i = 0; i < J.cols(); ++i) {
    const Eigen::VectorXd column = (f(i, kStep) - f(i, -kStep)) / (2 * kStep);
    worst = std::max(worst, (J.col(i) - column).cwiseAbs().maxCoeff());
  }
  return worst / J.cwiseAbs().maxCoeff();
}

struct DerivativeErrors {
  double rotation = 0, rotation_second = 0, equations = 0, readings = 0;
};

void check_rotation(const Eigen::Vector3d& P, DerivativeErrors& errors) {
  const PaperRotation at = differentiate_paper_rotation(P);
  const auto moved = [&](int i, double h) { return Eigen::Vector3d(P + h * Eigen::Vector3d::Unit(i)); };
  Eigen::MatrixXd first(9, 3), second(27, 3);
  for (int j = 0; j < 3; ++j) {
    first.col(j) = at.A_j[static_cast<std::size_t>(j)].reshaped();
    for (int k = 0; k < 3; ++k) {
      second.col(j).segment<9>(9 * k) = at.A_jk[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)].reshaped();
    }
  }
  errors.rotation = std::max(errors.rotation, derivative_error(first, [&](int i, double h) {
                               return Eigen::VectorXd(paper_rotation(moved(i, h)).reshaped());
                             }));
  errors.rotation_second = std::max(errors.rotation_second, derivative_error(second, [&](int i, double h) {
                                      const PaperRotation there = differentiate_paper_rotation(moved(i, h));
                                      Eigen::VectorXd all(27);
                                      for (int k = 0; k < 3; ++k) {
                                        all.segment<9>(9 * k) = there.A_j[static_cast<std::size_t>(k)].reshaped();
                                      }
                                      return all;
                                    }));
}

DerivativeErrors check_derivatives(const std::vector<Problem>& problems, const std::vector<LineDetector>& detectors,
                                   const RigidBody& body, unsigned seed) {
  DerivativeErrors errors;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-0.4, 0.4);
  for (const Problem& problem : problems) {
    const Eigen::Vector3d P(uniform(random), uniform(random), uniform(random));
    check_rotation(P, errors);
    const PaperCost cost = cost_of(body, problem);
    const auto f = [&](int i, double h) {
      return Eigen::VectorXd(paper_equations(cost, P + h * Eigen::Vector3d::Unit(i), problem.start.linear()).f);
    };
    errors.equations =
        std::max(errors.equations, derivative_error(paper_equations(cost, P, problem.start.linear()).J, f));
    for (const LineDetector& detector : detectors) {
      const Eigen::Vector3d& p_body = body.markers.back().p_body;
      const auto J = reading_jacobian(detector, problem.truth, p_body);
      if (!J) continue;
      errors.readings = std::max(errors.readings, derivative_error(*J, [&](int i, double h) {
                                   const Eigen::Isometry3d T = problem.truth * perturbation(h * Vector6d::Unit(i));
                                   return Eigen::VectorXd::Constant(1, project(detector, T * p_body)->value);
                                 }));
    }
  }
  return errors;
}

}  // namespace

ExperimentSection body_solvers(const ExperimentContext& context) {
  ExperimentSection section{
      "solvers",
      "Derivatives, exact recovery, agreement of solvers",
      {"Derivatives against central differences, as a share of the largest. Solvers start 1 cm and 0.05 rad off; "
       "differences are the largest of all frames, m and rad alike."},
      {},
      {},
      {}};
  BodySceneOptions options;
  options.frames = std::min(context.runs, 1000);
  options.seed = context.seed;
  const BodyScene scene(options);
  const auto& detectors = scene.detectors();
  const RigidBody& body = scene.bodies().front();
  const auto noisy = make_problems(options, detectors, body);
  options.sigma_rad = 0;
  const auto exact = make_problems(options, detectors, body);

  double paper_exact = 0, sums_exact = 0, paper_sums = 0, sums_ceres = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    if (context.stop.stop_requested()) return section;
    paper_exact = std::max(paper_exact, apart_m(solve_by_paper(body, exact[i]), exact[i].truth));
    sums_exact = std::max(sums_exact, apart_m(solve_by_sums(body, exact[i]), exact[i].truth));
    const auto by_sums = solve_by_sums(body, noisy[i]);
    paper_sums = std::max(paper_sums, apart_m(solve_by_paper(body, noisy[i]), by_sums));
    sums_ceres = std::max(sums_ceres, apart_m(by_sums, solve_by_ceres(body, noisy[i])));
    if (context.progress && i % 50 == 49) {
      context.progress({"solvers", static_cast<std::int64_t>(i + 1), static_cast<std::int64_t>(noisy.size()), ""});
    }
  }
  const DerivativeErrors derivatives = check_derivatives(noisy, detectors, body, options.seed);
  section.summary = {{"derivatives",
                      {{"rotation", derivatives.rotation},
                       {"rotation_second", derivatives.rotation_second},
                       {"equations", derivatives.equations},
                       {"readings", derivatives.readings}}},
                     {"exact", {{"paper", paper_exact}, {"ours", sums_exact}}},
                     {"agreement", {{"paper_ours", paper_sums}, {"ours_ceres", sums_ceres}}}};
  section.tables.push_back(
      {fmt::format("{} frames", noisy.size()),
       {"what", "largest difference"},
       {{"paper's rotation, first derivatives", fmt::format("{:.1e}", derivatives.rotation)},
        {"paper's rotation, second derivatives", fmt::format("{:.1e}", derivatives.rotation_second)},
        {"paper's equations (Newton's matrix)", fmt::format("{:.1e}", derivatives.equations)},
        {"readings by pose", fmt::format("{:.1e}", derivatives.readings)},
        {"exact planes, paper's solver from the truth", fmt::format("{:.1e}", paper_exact)},
        {"exact planes, ours from the truth", fmt::format("{:.1e}", sums_exact)},
        {"noisy planes, paper's solver from ours", fmt::format("{:.1e}", paper_sums)},
        {"noisy planes, Ceres from ours", fmt::format("{:.1e}", sums_ceres)}}});
  return section;
}

}  // namespace alidade
