// SPDX-License-Identifier: Apache-2.0
// A rigid transform from planes: Newton on sums over planes beside the ways that visit every plane in every step. One
// thread; four markers, 64 problems in turn, from a start as far off as an extrapolated pose (1 mm, 1 mrad).

#include <vector>

#include <Eigen/Cholesky>
#include <benchmark/benchmark.h>
#include <ceres/ceres.h>

#include "geometry/plane_pose.h"
#include "geometry/plane_pose_minima.h"
#include "geometry/plane_pose_search.h"
#include "geometry/robust_plane_pose.h"
#include "geometry/rotation_descent.h"
#include "tests/geometry/random_planes.h"

namespace alidade {
namespace {

constexpr std::size_t kProblems = 64;
constexpr double kSigma_m = 3e-4;

struct Problem {
  std::vector<PlaneConstraint> constraints;
  Eigen::Isometry3d start;
};

// `wrong`: share of planes that go through a place 0.1 m off.
std::vector<Problem> make_problems(int planes, double wrong = 0.0) {
  test::RandomGeometry random(31);
  const std::vector<int> planes_of_marker(4, planes / 4);
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < kProblems; ++i) {
    const Eigen::Isometry3d truth = random.pose();
    Vector6d off;
    off << random.vector(1e-3), random.vector(1e-3);
    problems.push_back({test::random_planes(random, truth, planes_of_marker, kSigma_m), truth * perturbation(off)});
    for (PlaneConstraint& c : problems.back().constraints) {
      if (random.uniform(0, 1) < wrong) c.plane_world.offset += random.normal(0.1);
    }
  }
  return problems;
}

// Sums over planes, elimination of the translation, Newton.
void newton(benchmark::State& run) {
  const auto problems = make_problems(static_cast<int>(run.range(0)));
  std::size_t i = 0;
  for (auto _ : run) {
    const Problem& problem = problems[i++ % kProblems];
    benchmark::DoNotOptimize(newton_pose(sum_planes(problem.constraints), problem.start));
  }
}
BENCHMARK(newton)->Arg(12)->Arg(32)->Arg(96);

// The same from sums that exist already.
void newton_solve(benchmark::State& run) {
  const auto problems = make_problems(32);
  std::vector<PlaneSums> sums;
  for (const Problem& problem : problems) sums.push_back(sum_planes(problem.constraints));
  std::size_t i = 0;
  for (auto _ : run) {
    benchmark::DoNotOptimize(newton_pose(sums[i % kProblems], problems[i % kProblems].start));
    ++i;
  }
  run.SetItemsProcessed(run.iterations());
}
BENCHMARK(newton_solve);

// Gauss–Newton in six unknowns, one row per plane, until a step is below what newton_pose stops at.
Eigen::Isometry3d gauss_newton(std::span<const PlaneConstraint> constraints, Eigen::Isometry3d T) {
  for (int step = 0; step < 20; ++step) {
    Eigen::Matrix<double, 7, 7> sum = Eigen::Matrix<double, 7, 7>::Zero();
    const Eigen::Matrix3d R = T.linear();
    const Eigen::Vector3d t = T.translation();
    for (const PlaneConstraint& c : constraints) {
      const Eigen::Vector3d arm = R * c.p_body;
      const Eigen::Vector3d& n = c.plane_world.normal;
      Eigen::Matrix<double, 7, 1> row;
      row << n, arm.cross(n), n.dot(arm + t) - c.plane_world.offset;
      for (int i = 0; i < 7; ++i) sum.col(i).tail(7 - i) += (c.weight * row(i)) * row.tail(7 - i);
    }
    const Eigen::LLT<Matrix6d> factor(sum.topLeftCorner<6, 6>());
    const Vector6d xi = -factor.solve(sum.bottomLeftCorner<1, 6>().transpose());
    T.linear() = exp_so3(xi.tail<3>()) * R;
    T.translation() += xi.head<3>();
    if (xi.norm() < 1e-7) break;
  }
  return T;
}

void gauss_newton(benchmark::State& run) {
  const auto problems = make_problems(static_cast<int>(run.range(0)));
  std::size_t i = 0;
  for (auto _ : run) {
    const Problem& problem = problems[i++ % kProblems];
    benchmark::DoNotOptimize(gauss_newton(problem.constraints, problem.start));
  }
}
BENCHMARK(gauss_newton)->Arg(12)->Arg(32)->Arg(96);

constexpr double kWrong = 0.2;

// The whole robust solve: graduated weights, least squares on the inliers, information.
void robust(benchmark::State& run) {
  const auto problems = make_problems(static_cast<int>(run.range(0)), kWrong);
  std::size_t i = 0;
  for (auto _ : run) {
    const Problem& problem = problems[i++ % kProblems];
    benchmark::DoNotOptimize(solve_robustly(problem.constraints, problem.start));
  }
}
BENCHMARK(robust)->Arg(32);

// How far translations end from the minimum of the robust cost, where they end in the same one.
struct Gap {
  double sum = 0.0;
  int count = 0;

  void add(const Problem& problem, const Eigen::Vector3d& t) {
    RobustPlaneOptions options;
    options.max_iterations = 200;
    const double apart = (descend_robustly(problem.constraints, problem.start, options, 1e-9).translation() - t).norm();
    if (apart > 5e-5) return;
    sum += apart * apart;
    ++count;
  }
  double root_mean_square_um() const { return 1e6 * std::sqrt(sum / count); }
};

// The same loss and start as Ceres below.
void robust_descent(benchmark::State& run) {
  const auto problems = make_problems(static_cast<int>(run.range(0)), kWrong);
  std::size_t i = 0;
  for (auto _ : run) {
    const Problem& problem = problems[i++ % kProblems];
    benchmark::DoNotOptimize(descend_robustly(problem.constraints, problem.start));
  }
  Gap gap;
  for (const Problem& problem : problems) {
    gap.add(problem, descend_robustly(problem.constraints, problem.start).translation());
  }
  run.counters["gap_um"] = gap.root_mean_square_um();
}
BENCHMARK(robust_descent)->Arg(32);

struct GemanMcClure : ceres::LossFunction {
  double c2 = RobustPlaneOptions{}.gate_chi2;
  void Evaluate(double s, double rho[3]) const override {
    const double root = c2 / (c2 + s);
    rho[0] = root * s;
    rho[1] = root * root;
    rho[2] = -2.0 * root * root / (c2 + s);
  }
};

struct PlaneResidual {
  PlaneConstraint constraint;

  template <class T>
  bool operator()(const T* pose, T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q(pose);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> t(pose + 4);
    const Eigen::Matrix<T, 3, 1> p = q * constraint.p_body.cast<T>() + t;
    const Eigen::Matrix<T, 3, 1> n = constraint.plane_world.normal.cast<T>();
    residual[0] = (p.dot(n) - constraint.plane_world.offset) * std::sqrt(constraint.weight);
    return true;
  }
};

// As Ceres' tutorial has it: automatic derivatives, DENSE_QR, tolerances as they are.
void ceres_robust(benchmark::State& run) {
  const auto problems = make_problems(static_cast<int>(run.range(0)), kWrong);
  GemanMcClure loss;
  std::size_t i = 0;
  Gap gap;
  for (auto _ : run) {
    const Problem& problem = problems[i++ % kProblems];
    double pose[7];
    Eigen::Map<Eigen::Quaterniond>(pose).coeffs() = Eigen::Quaterniond(problem.start.linear()).coeffs();
    Eigen::Map<Eigen::Vector3d>(pose + 4) = problem.start.translation();
    ceres::Problem::Options ownership;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem ceres_problem(ownership);
    for (const PlaneConstraint& c : problem.constraints) {
      ceres_problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PlaneResidual, 1, 7>(new PlaneResidual{c}), &loss,
                                     pose);
    }
    ceres_problem.SetManifold(
        pose, new ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>{});
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    options.function_tolerance = 1e-6;  // with its default, 1e-6, the gap is several times ours
    ceres::Solver::Summary summary;
    ceres::Solve(options, &ceres_problem, &summary);
    benchmark::DoNotOptimize(pose);
    run.PauseTiming();
    gap.add(problem, Eigen::Vector3d(pose[4], pose[5], pose[6]));
    run.ResumeTiming();
  }
  run.counters["gap_um"] = gap.root_mean_square_um();
}
BENCHMARK(ceres_robust)->Arg(32);

// All minima of 32 planes without a start, and their judgement.
void global_start(benchmark::State& run) {
  const auto problems = make_problems(static_cast<int>(run.range(0)));
  std::size_t i = 0;
  for (auto _ : run) {
    const Problem& problem = problems[i++ % kProblems];
    benchmark::DoNotOptimize(judge_minima(problem.constraints, all_minima(problem.constraints)));
  }
}
BENCHMARK(global_start)->Arg(32)->Unit(benchmark::kMicrosecond);

// The pose without a start where a fifth of the planes is wrong.
void robust_global_start(benchmark::State& run) {
  const auto problems = make_problems(static_cast<int>(run.range(0)), kWrong);
  std::size_t i = 0;
  for (auto _ : run) benchmark::DoNotOptimize(search_pose(problems[i++ % kProblems].constraints));
}
BENCHMARK(robust_global_start)->Arg(32)->Unit(benchmark::kMicrosecond);

// A plane more and a plane less.
void rank_update(benchmark::State& run) {
  const auto problems = make_problems(32);
  PlaneSums sums = sum_planes(problems.front().constraints);
  std::size_t i = 0;
  for (auto _ : run) {
    const std::vector<PlaneConstraint>& constraints = problems.front().constraints;
    sums.add(constraints[i % constraints.size()]);
    sums.remove(constraints[i % constraints.size()]);
    ++i;
  }
  benchmark::DoNotOptimize(sums);
}
BENCHMARK(rank_update);

}  // namespace
}  // namespace alidade

BENCHMARK_MAIN();
