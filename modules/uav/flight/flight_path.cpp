// SPDX-License-Identifier: Apache-2.0
#include "uav/flight/flight_path.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "camera/static_triangulation.h"
#include "uav/flight/flight_model.h"

namespace alidade {
namespace {

constexpr double kCommonTime_s = 1e-5;  // 0.1 mm at 10 m/s; see CommonTime

struct Gaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

// What the smoother goes by.
struct Flight {
  std::vector<ReceiverDrift> drifts;
  FlightTransition transition;
  CommonTime common;
  std::vector<Timestamp> times;
  std::vector<std::vector<FlightBearing>> bearings;  // of each step
  std::vector<int> seen_by;
};

std::vector<FlightBearing> flight_bearings(std::span<const Receiver> receivers, std::span<const Bearing> bearings,
                                           double correlation_s) {
  std::vector<std::vector<Timestamp>> times(receivers.size());
  std::vector<FlightBearing> all;
  for (const Bearing& b : bearings) {
    const auto k = std::find_if(receivers.begin(), receivers.end(), [&](const auto& r) { return r.id == b.receiver; });
    if (k == receivers.end()) {
      throw std::invalid_argument(fmt::format("estimate_flight: no receiver has the id {}", b.receiver));
    }
    if (!all.empty() && b.time < all.back().bearing.time) {
      throw std::invalid_argument("estimate_flight: the bearings are not in order of time");
    }
    all.push_back({b, static_cast<int>(k - receivers.begin()), 1.0});
    times[static_cast<std::size_t>(all.back().receiver)].push_back(b.time);
  }
  const auto half = from_seconds(0.5 * correlation_s);
  for (FlightBearing& f : all) {
    const auto& own = times[static_cast<std::size_t>(f.receiver)];
    const auto first = std::lower_bound(own.begin(), own.end(), f.bearing.time - half);
    const auto last = std::upper_bound(own.begin(), own.end(), f.bearing.time + half);
    f.share = 1.0 / static_cast<double>(last - first);
  }
  return all;
}

// Steps from the first bearing to the last, on whole multiples of the step.
Flight flight_of(std::span<const Receiver> receivers, std::span<const Bearing> bearings,
                 const FlightPathOptions& options) {
  const auto all = flight_bearings(receivers, bearings, options.correlation_s);
  const auto step = from_seconds(options.step_s);
  const auto first = (bearings.front().time.time_since_epoch() + step / 2) / step;
  const auto last = (bearings.back().time.time_since_epoch() + step / 2) / step;
  Flight flight;
  flight.drifts = receiver_drifts(receivers, bearings.front().time, options);
  flight.transition = flight_transition(flight.drifts, options);
  flight.common = common_time_of(flight.drifts, to_seconds(bearings.back().time - bearings.front().time));
  const auto by_time = [](const FlightBearing& f, Timestamp t) { return f.bearing.time < t; };
  const auto from = [&](Timestamp t) { return std::lower_bound(all.begin(), all.end(), t, by_time); };
  for (auto i = first; i <= last; ++i) {
    const Timestamp time{step * i};
    flight.times.push_back(time);
    flight.bearings.emplace_back(from(time - step / 2), from(time - step / 2 + step));
    std::set<int> seen;
    const auto near = from_seconds(options.seen_s);
    for (auto it = from(time - near); it != all.end() && it->bearing.time <= time + near; ++it)
      seen.insert(it->receiver);
    flight.seen_by.push_back(static_cast<int>(seen.size()));
  }
  return flight;
}

// States on straight lines between the places where bearings meet, as far as they do.
std::optional<std::vector<Eigen::VectorXd>> start_of(const Flight& flight, std::span<const Bearing> bearings) {
  std::vector<std::size_t> known;
  std::vector<Eigen::VectorXd> states(flight.times.size(), Eigen::VectorXd::Zero(flight.transition.F.rows()));
  for (std::size_t i = 0; i < flight.times.size(); ++i) {
    const auto met = triangulate_static(bearings, flight.times[i]);
    if (!met) continue;
    states[i].head<3>() = met->p_world;
    known.push_back(i);
  }
  if (known.empty()) return std::nullopt;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto next = std::lower_bound(known.begin(), known.end(), i);
    const std::size_t b = next == known.end() ? known.back() : *next;
    const std::size_t a = next == known.begin() || *next == i ? b : *(next - 1);
    const double part = a == b ? 0.0 : static_cast<double>(i - a) / static_cast<double>(b - a);
    states[i].head<3>() = ((1.0 - part) * states[a].head<3>() + part * states[b].head<3>()).eval();
  }
  const double h = to_seconds(flight.times.size() > 1 ? flight.times[1] - flight.times[0] : from_seconds(1.0));
  for (std::size_t i = 1; i + 1 < states.size(); ++i) {
    states[i].segment<3>(3) = (states[i + 1].head<3>() - states[i - 1].head<3>()) / (2.0 * h);
  }
  return states;
}

// The posterior of a Gaussian and the system, by factors of the prior: I + Lᵀ H L has no eigenvalue below 1.
Gaussian updated(const Gaussian& prior, const FlightSystem& system) {
  const Eigen::MatrixXd L = prior.covariance.llt().matrixL();
  const Eigen::MatrixXd M = Eigen::MatrixXd::Identity(L.rows(), L.rows()) + L.transpose() * system.information * L;
  const Eigen::MatrixXd root = M.llt().matrixL().solve(L.transpose());
  Gaussian posterior{prior.mean, root.transpose() * root};
  posterior.mean -= posterior.covariance * (system.gradient + system.information * prior.mean);
  return posterior;
}

// One pass forward and back.
std::vector<Gaussian> smoothed(const Flight& flight, const std::vector<Eigen::VectorXd>& about, bool slack,
                               const FlightPathOptions& options) {
  const Eigen::MatrixXd& F = flight.transition.F;
  std::vector<Gaussian> predicted, filtered;
  for (std::size_t i = 0; i < about.size(); ++i) {
    if (i == 0) {
      Gaussian prior{Eigen::VectorXd::Zero(F.rows()), flight_prior(flight.drifts, options)};
      prior.mean.head<3>() = about[0].head<3>();
      predicted.push_back(std::move(prior));
    } else {
      const Gaussian& before = filtered.back();
      predicted.push_back({F * before.mean, F * before.covariance * F.transpose() + flight.transition.Q});
    }
    const FlightLinearisation at{about[i], flight.times[i], options.loss_sigmas, slack};
    FlightSystem system = flight_system(flight.bearings[i], flight.drifts, at);
    system.information += flight.common.weights * flight.common.weights.transpose() / (kCommonTime_s * kCommonTime_s);
    filtered.push_back(updated(predicted.back(), system));
  }
  std::vector<Gaussian> result = filtered;
  for (std::size_t i = result.size() - 1; i-- > 0;) {
    const Eigen::MatrixXd G = predicted[i + 1].covariance.llt().solve(F * filtered[i].covariance).transpose();
    result[i].mean += G * (result[i + 1].mean - predicted[i + 1].mean);
    result[i].covariance += G * (result[i + 1].covariance - predicted[i + 1].covariance) * G.transpose();
  }
  return result;
}

FlightStep step_of(const Gaussian& g, Timestamp time, const CommonTime& common) {
  FlightStep step;
  step.state = {time, g.mean.head<3>(), g.mean.segment<3>(3), g.mean.segment<3>(6), g.covariance.topLeftCorner<9, 9>()};
  Eigen::Matrix<double, 9, 1> later;  // what becomes of the state in a second
  later << step.state.v_world, step.state.a_world, Eigen::Vector3d::Zero();
  const double common_s2 = common.sigma_s * common.sigma_s;
  step.state.covariance += later * later.transpose() * common_s2;
  for (int k = 0; FlightLayout::clock_at(k) < g.mean.size(); ++k) {
    const int clock = FlightLayout::clock_at(k);
    step.receivers.push_back({g.mean.segment<2>(FlightLayout::turn_at(k)), g.mean[clock],
                              std::sqrt(std::max(0.0, g.covariance(clock, clock)) + common_s2)});
  }
  return step;
}

// How far the states moved where two receivers or more see the target, m.
double greatest_move(const std::vector<Eigen::VectorXd>& before, const std::vector<Gaussian>& after,
                     const std::vector<int>& seen_by) {
  double move = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (seen_by[i] > 1) move = std::max(move, (before[i].head<3>() - after[i].mean.head<3>()).norm());
  }
  return move;
}

}  // namespace

void validate(const FlightPathOptions& options) {
  const auto need = [](double value, const char* name) {
    if (!(value > 0.0)) throw std::invalid_argument(fmt::format("{} must be > 0, got {}", name, value));
  };
  need(options.step_s, "step_s");
  need(options.acceleration_m_s2, "acceleration_m_s2");
  need(options.acceleration_time_s, "acceleration_time_s");
  need(options.speed_m_s, "speed_m_s");
  need(options.turn_rad, "turn_rad");
  need(options.range_m, "range_m");
  need(options.drift_time_s, "drift_time_s");
  need(options.clock_history_s, "clock_history_s");
  need(options.correlation_s, "correlation_s");
  need(options.loss_sigmas, "loss_sigmas");
  need(options.seen_s, "seen_s");
  need(options.most_passes, "most_passes");
}

std::optional<FlightPath> estimate_flight(std::span<const Receiver> receivers, std::span<const Bearing> bearings,
                                          const FlightPathOptions& options) {
  validate(options);
  if (receivers.size() < 2) throw std::invalid_argument("estimate_flight: two receivers or more are wanted");
  if (bearings.empty()) return std::nullopt;
  const Flight flight = flight_of(receivers, bearings, options);
  auto about = start_of(flight, bearings);
  if (!about) return std::nullopt;
  constexpr double kStill_m = 1e-3;  // a hundredth of what a flight is known to
  FlightPath path;
  std::vector<Gaussian> states;
  for (double move = 1.0; path.passes < options.most_passes && move > kStill_m; ++path.passes) {
    states = smoothed(flight, *about, path.passes < 2, options);
    move = greatest_move(*about, states, flight.seen_by);
    for (std::size_t i = 0; i < states.size(); ++i) (*about)[i] = states[i].mean;
  }
  for (std::size_t i = 0; i < states.size(); ++i) {
    path.steps.push_back(step_of(states[i], flight.times[i], flight.common));
    path.steps.back().seen_by = flight.seen_by[i];
  }
  return path;
}

const FlightStep* step_at(const FlightPath& path, Timestamp time) {
  if (path.steps.empty()) return nullptr;
  const auto by_time = [](const FlightStep& s, Timestamp t) { return s.state.time < t; };
  auto it = std::lower_bound(path.steps.begin(), path.steps.end(), time, by_time);
  if (it == path.steps.end() || (it != path.steps.begin() && time - (it - 1)->state.time < it->state.time - time)) --it;
  const auto step = path.steps.size() > 1 ? path.steps[1].state.time - path.steps[0].state.time : from_seconds(0.0);
  return std::chrono::abs(it->state.time - time) * 2 <= step ? &*it : nullptr;
}

std::optional<TargetState> state_at(const FlightPath& path, Timestamp time) {
  const FlightStep* step = step_at(path, time);
  if (!step) return std::nullopt;
  return moved_to(step->state, time);
}

}  // namespace alidade
