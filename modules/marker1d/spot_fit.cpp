// SPDX-License-Identifier: Apache-2.0
#include "marker1d/spot_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace alidade {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kShapeError = 0.003;  // of a spot, in its height: lenses and pixels make it not quite Gaussian

// Unknowns: positions of the J spots; then, per channel, their J amplitudes and the background's offset.
class SpotProblem {
 public:
  SpotProblem(const LineRow& row, PixelRange range, Index spots, double spot_sigma_px)
      : row_(row), range_(range), spots_(spots), per_width_(1.0 / spot_sigma_px) {}

  Index channels() const { return row_.signal.cols(); }
  Index unknowns() const { return spots_ + channels() * (spots_ + 1); }
  Index amplitude(Index spot, Index channel) const { return spots_ + channel * (spots_ + 1) + spot; }

  int pixels() const {
    return static_cast<int>(row_.is_usable.segment(range_.first, range_.last - range_.first + 1).count());
  }

  // Weights 1 / variance of all pixels and channels at the model of `x`; zero where unusable.
  MatrixXd weights(const VectorXd& x) const {
    MatrixXd weight = MatrixXd::Zero(range_.last - range_.first + 1, channels());
    for (int i = range_.first; i <= range_.last; ++i) {
      if (!row_.is_usable(i)) continue;
      for (Index c = 0; c < channels(); ++c) {
        const double light = std::max(0.0, model(x, i, c));
        weight(i - range_.first, c) =
            1.0 / (row_.variance(i, c) + light * (row_.shot + kShapeError * kShapeError * light));
      }
    }
    return weight;
  }

  double chi2(const VectorXd& x, const MatrixXd& weight) const {
    double sum = 0.0;
    for (int i = range_.first; i <= range_.last; ++i) {
      for (Index c = 0; c < channels(); ++c) {
        const double residual = row_.signal(i, c) - model(x, i, c);
        sum += weight(i - range_.first, c) * residual * residual;
      }
    }
    return sum;
  }

  struct Normal {
    MatrixXd A;
    VectorXd g;
  };

  Normal linearise(const VectorXd& x, const MatrixXd& weight) const {
    Normal normal{MatrixXd::Zero(unknowns(), unknowns()), VectorXd::Zero(unknowns())};
    VectorXd J(unknowns());
    for (int i = range_.first; i <= range_.last; ++i) {
      for (Index c = 0; c < channels(); ++c) {
        J.setZero();
        for (Index j = 0; j < spots_; ++j) {
          const double u = (i - x(j)) * per_width_, g = std::exp(-0.5 * u * u);
          J(j) = x(amplitude(j, c)) * g * u * per_width_;
          J(amplitude(j, c)) = g;
        }
        J(amplitude(spots_, c)) = 1.0;
        const double w = weight(i - range_.first, c);
        normal.A.selfadjointView<Eigen::Lower>().rankUpdate(J, w);
        normal.g += w * (row_.signal(i, c) - model(x, i, c)) * J;
      }
    }
    normal.A.triangularView<Eigen::StrictlyUpper>() = normal.A.transpose();
    return normal;
  }

  bool holds(const VectorXd& x) const {
    for (Index j = 0; j < spots_; ++j) {
      double sum = 0.0;
      for (Index c = 0; c < channels(); ++c) sum += x(amplitude(j, c));
      if (!(sum > 0) || !(x(j) >= range_.first - 0.5) || !(x(j) <= range_.last + 0.5)) return false;
    }
    return x.allFinite();
  }

 private:
  double model(const VectorXd& x, int i, Index c) const {
    double value = x(amplitude(spots_, c));
    for (Index j = 0; j < spots_; ++j) {
      const double u = (i - x(j)) * per_width_;
      value += x(amplitude(j, c)) * std::exp(-0.5 * u * u);
    }
    return value;
  }

  const LineRow& row_;
  PixelRange range_;
  Index spots_;
  double per_width_;
};

// Amplitudes and offsets at given positions: a linear problem.
std::optional<VectorXd> with_heights(const SpotProblem& problem, VectorXd x, Index spots) {
  const auto normal = problem.linearise(x, problem.weights(x));
  const Index linear = problem.unknowns() - spots;
  const Eigen::LDLT<MatrixXd> factor(normal.A.bottomRightCorner(linear, linear));
  if (!factor.isPositive() || factor.rcond() < 1e-12) return std::nullopt;
  x.tail(linear) += factor.solve(normal.g.tail(linear));
  return x;
}

// A Gauss–Newton step, shortened until it does not make the fit worse. Empty where the spots are not determined.
std::optional<VectorXd> step_from(const SpotProblem& problem, const VectorXd& x, Index spots, double spot_sigma_px) {
  const MatrixXd weight = problem.weights(x);
  const auto normal = problem.linearise(x, weight);
  // Positions and amplitudes differ in unit: compared on a scale of their own.
  const VectorXd scale = normal.A.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<MatrixXd> factor(scale.asDiagonal() * normal.A * scale.asDiagonal());
  if (!factor.isPositive() || factor.rcond() < 1e-10) return std::nullopt;
  VectorXd step = scale.asDiagonal() * factor.solve(VectorXd(scale.asDiagonal() * normal.g));
  const double farthest = step.head(spots).cwiseAbs().maxCoeff();
  if (farthest > 0.7 * spot_sigma_px) step *= 0.7 * spot_sigma_px / farthest;
  const double before = problem.chi2(x, weight);
  for (int halving = 0; halving < 5; ++halving, step *= 0.5) {
    if (problem.chi2(x + step, weight) <= before) return x + step;
  }
  return x;
}

SpotFit fit_at(const SpotProblem& problem, const VectorXd& x, Index spots) {
  const MatrixXd weight = problem.weights(x);
  const MatrixXd covariance =
      problem.linearise(x, weight).A.ldlt().solve(MatrixXd::Identity(problem.unknowns(), problem.unknowns()));
  SpotFit fit;
  fit.chi2 = problem.chi2(x, weight);
  fit.degrees_of_freedom =
      problem.pixels() * static_cast<int>(problem.channels()) - static_cast<int>(problem.unknowns());
  for (Index j = 0; j < spots; ++j) {
    Spot spot;
    spot.position_px = x(j);
    spot.sigma_px = std::sqrt(covariance(j, j));
    double variance = 0.0;
    for (Index c = 0; c < problem.channels(); ++c) {
      const Index a = problem.amplitude(j, c);
      spot.amplitude(c) = x(a);
      spot.channel_sigma(c) = std::sqrt(covariance(a, a));
      for (Index d = 0; d < problem.channels(); ++d) variance += covariance(a, problem.amplitude(j, d));
    }
    spot.amplitude_sigma = std::sqrt(variance);
    fit.spots.push_back(spot);
  }
  return fit;
}

bool is_finite(const SpotFit& fit) {
  return std::isfinite(fit.chi2) && std::all_of(fit.spots.begin(), fit.spots.end(), [](const Spot& spot) {
           return std::isfinite(spot.position_px + spot.sigma_px + spot.amplitude_sigma) && spot.sigma_px > 0;
         });
}

}  // namespace

std::optional<SpotFit> fit_spots(const LineRow& row, PixelRange range, std::span<const double> starts,
                                 double spot_sigma_px) {
  constexpr int kSteps = 20;
  const auto spots = static_cast<Index>(starts.size());
  const SpotProblem problem(row, range, spots, spot_sigma_px);
  if (problem.pixels() * problem.channels() < problem.unknowns()) return std::nullopt;
  VectorXd start = VectorXd::Zero(problem.unknowns());
  for (Index j = 0; j < spots; ++j) start(j) = starts[static_cast<std::size_t>(j)];
  auto x = with_heights(problem, start, spots);
  for (int step = 0; x && step < kSteps; ++step) {
    const auto next = step_from(problem, *x, spots, spot_sigma_px);
    if (!next || !problem.holds(*next)) return std::nullopt;
    const double moved = (*next - *x).head(spots).cwiseAbs().maxCoeff();
    x = next;
    if (moved < 1e-4 * spot_sigma_px) break;
  }
  if (!x || !problem.holds(*x)) return std::nullopt;
  SpotFit fit = fit_at(problem, *x, spots);
  if (!is_finite(fit)) return std::nullopt;
  return fit;
}

}  // namespace alidade
