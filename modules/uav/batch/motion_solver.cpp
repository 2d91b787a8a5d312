// SPDX-License-Identifier: Apache-2.0
#include "uav/batch/motion_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>

namespace alidade {
namespace {

constexpr int kLinearPasses = 3;        // the first with equal ranges; the weights of the third are right to 1e-3
constexpr int kRobustPasses = 8;        // what is far off loses its weight step by step
constexpr int kSteps = 25;              // of Gauss–Newton; two or three are usual
constexpr double kDecrement = 1e-10;    // of chi2 that a further step would gain: 1e-5 sigma
constexpr double kLeastPivot = 1e-12;   // of the matrix scaled to a diagonal of 1
constexpr double kFirstDamping = 1e-3;  // as a share of the diagonal
constexpr double kMostDamping = 1e9;

template <int N>
struct Equations {
  MotionMatrix<N> information = MotionMatrix<N>::Zero();
  MotionVector<N> gradient = MotionVector<N>::Zero();  // of chi2 / 2
  double chi2 = 0.0;
  double cost = 0.0;  // chi2, robust where asked
  bool is_before_all = true;
};

// What t does to a point: 1, t, t²/2 times position, velocity, acceleration.
template <int N>
std::array<double, N / 3> powers(double t_s) {
  if constexpr (N == 6)
    return {1.0, t_s};
  else
    return {1.0, t_s, 0.5 * t_s * t_s};
}

template <int N>
void add(const Eigen::Matrix3d& information, const Eigen::Vector3d& gradient, double t_s, Equations<N>& sum) {
  const auto power = powers<N>(t_s);
  for (int i = 0; i < N / 3; ++i) {
    const double at_i = power[static_cast<std::size_t>(i)];
    sum.gradient.template segment<3>(3 * i) += at_i * gradient;
    for (int j = 0; j <= i; ++j) {
      sum.information.template block<3, 3>(3 * i, 3 * j) += at_i * power[static_cast<std::size_t>(j)] * information;
    }
  }
}

double robust_weight(double chi2, double scale) {
  return scale > 0.0 ? 1.0 / (1.0 + chi2 / (scale * scale)) : 1.0;
}

double robust_cost(double chi2, double scale) {
  return scale > 0.0 ? scale * scale * std::log1p(chi2 / (scale * scale)) : chi2;
}

template <int N>
void add_prior(const MotionPrior<N>& prior, const MotionVector<N>& x, Equations<N>& sum) {
  if (prior.is_empty) return;
  const MotionVector<N> off = x - prior.mean;
  const MotionVector<N> pull = prior.information * off;
  sum.information += prior.information;
  sum.gradient += pull;
  sum.chi2 += off.dot(pull);
  sum.cost += off.dot(pull);
}

// The bearings' own errors about x.
template <int N>
Equations<N> equations_at(std::span<const BearingRows> rows, const MotionPrior<N>& prior, double scale,
                          const MotionVector<N>& x) {
  Equations<N> sum;
  for (const BearingRows& row : rows) {
    const BearingError at = bearing_error(row, position_of<N>(x, row.t_s));
    if (!(at.depth_m > 0.0)) {
      sum.is_before_all = false;
      sum.cost = std::numeric_limits<double>::infinity();
      return sum;
    }
    const double chi2 = at.error.squaredNorm();
    const double weight = robust_weight(chi2, scale);
    add<N>(weight * at.J.transpose() * at.J, weight * at.J.transpose() * at.error, row.t_s, sum);
    sum.chi2 += weight * chi2;
    sum.cost += robust_cost(chi2, scale);
  }
  add_prior(prior, x, sum);
  return sum;
}

// The paper's equation (I − a aᵀ)(M + V t + A t²/2 − c) = 0 about 0, each weighed by 1/range² as x has it (`x` empty:
// all ranges alike, of unit length).
template <int N>
Equations<N> linear_equations(std::span<const BearingRows> rows, const MotionPrior<N>& prior, double scale,
                              const std::optional<MotionVector<N>>& x) {
  Equations<N> sum;
  for (const BearingRows& row : rows) {
    double weight = 1.0;
    if (x) {
      const Eigen::Vector3d d = position_of<N>(*x, row.t_s) - row.origin;
      const double inverse = 1.0 / std::max(d.squaredNorm(), 1e-12);
      weight = inverse * robust_weight((row.whitened * d).squaredNorm() * inverse, scale);
    }
    const Eigen::Matrix3d information = weight * row.whitened.transpose() * row.whitened;
    add<N>(information, -information * row.origin, row.t_s, sum);
  }
  add_prior<N>(prior, MotionVector<N>::Zero(), sum);
  return sum;
}

// −(H + damping · diag H)⁻¹ g, of the lower triangle; empty where H is singular beyond its digits.
template <int N>
class Factor {
 public:
  Factor(const MotionMatrix<N>& information, double damping)
      : scale_(information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse()) {
    MotionMatrix<N> scaled = scale_.asDiagonal() * information * scale_.asDiagonal();
    scaled.diagonal().array() += damping;
    llt_.compute(scaled);
    is_regular_ =
        llt_.info() == Eigen::Success && llt_.matrixLLT().diagonal().array().square().minCoeff() > kLeastPivot;
  }

  bool is_regular() const { return is_regular_; }
  MotionVector<N> solve(const MotionVector<N>& b) const {
    return scale_.cwiseProduct(llt_.solve(scale_.cwiseProduct(b)));
  }
  MotionMatrix<N> inverse() const {
    const MotionMatrix<N> P = llt_.solve(MotionMatrix<N>::Identity());
    return scale_.asDiagonal() * P * scale_.asDiagonal();
  }

 private:
  MotionVector<N> scale_;
  Eigen::LLT<MotionMatrix<N>, Eigen::Lower> llt_;
  bool is_regular_ = false;
};

template <int N>
std::optional<MotionVector<N>> linear_start(std::span<const BearingRows> rows, const MotionPrior<N>& prior,
                                            const MotionFitOptions& options) {
  std::optional<MotionVector<N>> x;
  const int passes = options.robust_scale > 0.0 ? kRobustPasses : kLinearPasses;
  for (int pass = 0; pass < passes; ++pass) {
    const Equations<N> sum =
        linear_equations<N>(rows, pass == 0 && !prior.is_empty ? MotionPrior<N>{} : prior, options.robust_scale, x);
    const Factor<N> factor(sum.information, 0.0);
    if (!factor.is_regular()) return std::nullopt;
    x = factor.solve(-sum.gradient);
  }
  return x;
}

bool have_one_origin(std::span<const BearingRows> rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [&](const BearingRows& row) { return row.origin == rows.front().origin; });
}

template <int N>
bool is_sure(std::span<const BearingRows> rows, const MotionSolution<N>& solution, double greatest_range_sigma) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const BearingRows& row : rows) {
    nearest = std::min(nearest, (position_of<N>(solution.x, row.t_s) - row.origin).norm());
  }
  return std::sqrt(solution.covariance.template topLeftCorner<3, 3>().trace()) < greatest_range_sigma * nearest;
}

template <int N>
MotionSolution<N> ended(MotionSolution<N> solution, MotionOutcome outcome) {
  solution.outcome = outcome;
  return solution;
}

template <int N>
MotionSolution<N> concluded(std::span<const BearingRows> rows, const MotionFitOptions& options, const Equations<N>& at,
                            MotionSolution<N> solution) {
  const Factor<N> factor(at.information, 0.0);
  if (!factor.is_regular()) return ended(solution, MotionOutcome::Undetermined);
  solution.covariance = factor.inverse();
  solution.chi2 = at.chi2;
  const bool is_determined = is_sure<N>(rows, solution, options.greatest_range_sigma);
  return ended(solution, is_determined ? MotionOutcome::Determined : MotionOutcome::Undetermined);
}

}  // namespace

template <int N>
MotionSolution<N> refine_motion(std::span<const BearingRows> rows, const MotionPrior<N>& prior,
                                const MotionFitOptions& options, const MotionVector<N>& start) {
  MotionSolution<N> solution;
  solution.x = start;
  Equations<N> at = equations_at<N>(rows, prior, options.robust_scale, start);
  if (!at.is_before_all) return ended(solution, MotionOutcome::BehindReceiver);
  double damping = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    const Factor<N> factor(at.information, damping);
    if (!factor.is_regular()) return ended(solution, MotionOutcome::Undetermined);
    const MotionVector<N> dx = factor.solve(-at.gradient);
    if (-dx.dot(at.gradient) < kDecrement) return concluded<N>(rows, options, at, solution);
    const MotionVector<N> moved = solution.x + dx;
    const Equations<N> there = equations_at<N>(rows, prior, options.robust_scale, moved);
    if (there.cost <= at.cost) {
      solution.x = moved;
      at = there;
      damping = damping > kFirstDamping ? 0.1 * damping : 0.0;
    } else {
      damping = std::max(kFirstDamping, 10.0 * damping);
      if (damping > kMostDamping) return concluded<N>(rows, options, at, solution);  // the digits are used up
    }
  }
  return ended(solution, MotionOutcome::NotConverged);
}

template <int N>
MotionSolution<N> solve_motion(std::span<const BearingRows> rows, const MotionPrior<N>& prior,
                               const MotionFitOptions& options) {
  if (prior.is_empty && 2 * rows.size() < N) return {};
  if (prior.is_empty && have_one_origin(rows)) return ended(MotionSolution<N>{}, MotionOutcome::Undetermined);
  MotionSolution<N> near;
  near.outcome = MotionOutcome::Undetermined;
  if (!prior.is_empty) near = refine_motion<N>(rows, prior, options, prior.mean);
  if (near.outcome == MotionOutcome::Determined) return near;
  const auto start = linear_start<N>(rows, prior, options);
  if (!start) return near;
  return refine_motion<N>(rows, prior, options, *start);
}

template MotionSolution<6> solve_motion<6>(std::span<const BearingRows>, const MotionPrior<6>&,
                                           const MotionFitOptions&);
template MotionSolution<9> solve_motion<9>(std::span<const BearingRows>, const MotionPrior<9>&,
                                           const MotionFitOptions&);
template MotionSolution<6> refine_motion<6>(std::span<const BearingRows>, const MotionPrior<6>&,
                                            const MotionFitOptions&, const MotionVector<6>&);
template MotionSolution<9> refine_motion<9>(std::span<const BearingRows>, const MotionPrior<9>&,
                                            const MotionFitOptions&, const MotionVector<9>&);

}  // namespace alidade
