// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/scan_association.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "estimation/assignment.h"
#include "estimation/joint_assignment.h"

namespace alidade {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kImpossible = -std::numeric_limits<double>::infinity();

// ln of how much more probable the bearing is as a sighting of the track than as a false one.
double log_ratio_of(const TargetTrack& track, const TargetState& predicted, const Bearing& bearing,
                    const TargetTrackerOptions& options) {
  const auto innovation = innovation_of(predicted, bearing, options.filter.added_sigma_rad);
  if (!innovation || innovation->chi2 > options.gate_chi2) return kImpossible;
  double log_ratio = std::log(options.detection_probability / options.false_bearings_per_sr) + innovation->log_density;
  const bool by_temperature =
      options.temperature_sigma_k > 0.0 && bearing.temperature_k && track.temperature.count > 0.0;
  if (by_temperature) {
    const double sigma = options.temperature_sigma_k * std::sqrt(1.0 + 1.0 / track.temperature.count);
    const double off = (*bearing.temperature_k - track.temperature.mean_k) / sigma;
    log_ratio += std::log(options.temperature_span_k / (sigma * std::sqrt(2.0 * std::numbers::pi))) - 0.5 * off * off;
  }
  return log_ratio;
}

// Tracks × bearings.
MatrixXd log_ratios(const std::vector<TargetTrack>& tracks, const BearingScan& scan,
                    const TargetTrackerOptions& options) {
  MatrixXd ratios(tracks.size(), scan.bearings.size());
  for (Index i = 0; i < ratios.rows(); ++i) {
    const TargetTrack& track = tracks[static_cast<std::size_t>(i)];
    TargetState predicted = track.state;
    for (Index j = 0; j < ratios.cols(); ++j) {
      const Bearing& bearing = scan.bearings[static_cast<std::size_t>(j)];
      if (j == 0 || bearing.time != predicted.time) {
        predicted = predict(track.state, bearing.time, options.filter.motion);
      }
      ratios(i, j) = log_ratio_of(track, predicted, bearing, options);
    }
  }
  return ratios;
}

TargetState updated(const TargetState& state, const Bearing& bearing, const TargetTrackerOptions& options) {
  const TargetState predicted = predict(state, bearing.time, options.filter.motion);
  const auto innovation = innovation_of(predicted, bearing, options.filter.added_sigma_rad);
  return innovation ? absorb(predicted, bearing, *innovation, options.filter) : predicted;
}

void see(TargetTrack& track, const Bearing& bearing, double log_ratio, const TargetTrackerOptions& options) {
  track.state = updated(track.state, bearing, options);
  if (bearing.temperature_k) track.temperature.add(*bearing.temperature_k, 1.0);
  note_sighting(track, bearing, log_ratio, options);
}

ScanOutcome take_nearest(std::vector<TargetTrack> tracks, const BearingScan& scan, const MatrixXd& log_ratio,
                         const TargetTrackerOptions& options) {
  const double log_miss = std::log(1.0 - options.detection_probability);
  ScanOutcome outcome{std::move(tracks), std::vector<bool>(scan.bearings.size(), false)};
  const auto bearing_of = best_assignment(log_ratio.array() - log_miss);
  for (std::size_t i = 0; i < outcome.tracks.size(); ++i) {
    if (!bearing_of[i]) continue;
    const auto j = static_cast<std::size_t>(*bearing_of[i]);
    outcome.is_claimed[j] = true;
    see(outcome.tracks[i], scan.bearings[j], log_ratio(static_cast<Index>(i), *bearing_of[i]), options);
  }
  return outcome;
}

Vector9d vector_of(const TargetState& state) {
  Vector9d x;
  x << state.p_world, state.v_world, state.a_world;
  return x;
}

// States of the same time, each with its probability.
class Mixture {
 public:
  void add(const TargetState& state, double probability) {
    if (probability <= 0.0) return;
    states_.push_back(state);
    probabilities_.push_back(probability);
  }

  TargetState moments() const {
    Vector9d mean = Vector9d::Zero();
    for (std::size_t i = 0; i < states_.size(); ++i) mean += probabilities_[i] * vector_of(states_[i]);
    TargetState state = states_.front();
    state.p_world = mean.head<3>();
    state.v_world = mean.segment<3>(3);
    state.a_world = mean.tail<3>();
    state.covariance.setZero();
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const Vector9d off = vector_of(states_[i]) - mean;
      state.covariance += probabilities_[i] * (states_[i].covariance + off * off.transpose());
    }
    return state;
  }

 private:
  std::vector<TargetState> states_;
  std::vector<double> probabilities_;
};

// `probability`: of each bearing being the track's, and of none.
void blend(TargetTrack& track, const BearingScan& scan, const Eigen::RowVectorXd& probability,
           const Eigen::RowVectorXd& log_ratio, const TargetTrackerOptions& options) {
  const Index none = log_ratio.size();
  Mixture mixture;
  mixture.add(predict(track.state, scan.end(), options.filter.motion), probability(none));
  double gained = 0.0;
  for (Index j = 0; j < none; ++j) {
    const Bearing& bearing = scan.bearings[static_cast<std::size_t>(j)];
    if (!(probability(j) > 0.0)) continue;
    mixture.add(predict(updated(track.state, bearing, options), scan.end(), options.filter.motion), probability(j));
    if (bearing.temperature_k) track.temperature.add(*bearing.temperature_k, probability(j));
    gained += probability(j) * log_ratio(j);
  }
  track.state = mixture.moments();
  if (probability(none) > 0.5) return;
  Index nearest = 0;
  probability.head(none).maxCoeff(&nearest);
  note_sighting(track, scan.bearings[static_cast<std::size_t>(nearest)], gained, options);
}

ScanOutcome take_jointly(std::vector<TargetTrack> tracks, const BearingScan& scan, const MatrixXd& log_ratio,
                         const TargetTrackerOptions& options) {
  const Eigen::VectorXd miss = Eigen::VectorXd::Constant(log_ratio.rows(), 1.0 - options.detection_probability);
  // Eigen's own exp of minus infinity is not 0
  const MatrixXd ratio = log_ratio.unaryExpr([](double log) { return std::exp(log); });
  const MatrixXd probability = joint_assignment(ratio, miss);
  // so many tracks and bearings in one heap that all ways cannot be counted
  if ((probability.rowwise().sum().array() < 0.5).any())
    return take_nearest(std::move(tracks), scan, log_ratio, options);
  ScanOutcome outcome{std::move(tracks), std::vector<bool>(scan.bearings.size(), false)};
  for (std::size_t i = 0; i < outcome.tracks.size(); ++i) {
    const auto row = static_cast<Index>(i);
    if (probability(row, log_ratio.cols()) < 1.0) {
      blend(outcome.tracks[i], scan, probability.row(row), log_ratio.row(row), options);
    }
  }
  for (std::size_t j = 0; j < outcome.is_claimed.size(); ++j) {
    outcome.is_claimed[j] = probability.col(static_cast<Index>(j)).sum() > 0.5;
  }
  return outcome;
}

}  // namespace

ScanOutcome take_scan(std::vector<TargetTrack> tracks, const BearingScan& scan, const TargetTrackerOptions& options) {
  const MatrixXd log_ratio = log_ratios(tracks, scan, options);
  return options.association == ScanAssociation::Joint ? take_jointly(std::move(tracks), scan, log_ratio, options)
                                                       : take_nearest(std::move(tracks), scan, log_ratio, options);
}

}  // namespace alidade
