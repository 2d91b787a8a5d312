// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/spline_bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include "camera/static_triangulation.h"
#include "core/median.h"

namespace alidade {
namespace {

constexpr double kMedianToSigma = 1.0 / 1.17741;  // the median distance in the plane is σ √(2 ln 2)
constexpr double kEdge_s = 0.2;                   // of the path, beyond the first and the last reading

// A reading, and whose it is: the receiver's place among all.
struct Sight {
  ReceiverReading reading;
  std::size_t receiver = 0;
};

// What is solved for: changes and control points, in place.
struct Unknowns {
  std::vector<ReceiverChange> changes;
  SplinePath path;
};

class SightCost : public ceres::SizedCostFunction<2, 3, 3, 3, 3, kReceiverParameters> {
 public:
  SightCost(const Receiver& receiver, const ReceiverReading& reading, double knot_s, double interval_s, double sigma_px)
      : receiver_(receiver), reading_(reading), knot_s_(knot_s), interval_s_(interval_s), sigma_px_(sigma_px) {}

  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const Eigen::Map<const ReceiverChange> change(blocks[4]);
    const double u = (sight_time(receiver_, change, reading_).t_s - knot_s_) / interval_s_;
    const Eigen::Vector4d w = spline_weights(u), s = spline_slopes(u) / interval_s_;
    TrackPoint point;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Map<const Eigen::Vector3d> c(blocks[k]);
      point.p_world += w[k] * c;
      point.v_world += s[k] * c;
    }
    const auto seen = sight_residual(receiver_, change, reading_, point);
    Eigen::Map<Eigen::Vector2d> error(residuals);
    error.setZero();  // behind the camera it says nothing
    if (seen) error = seen->residual_px / sigma_px_;
    for (int k = 0; jacobians && k < 4; ++k) {
      if (!jacobians[k]) continue;
      Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>> J(jacobians[k]);
      J.setZero();
      if (seen) J = w[k] / sigma_px_ * seen->J_position;
    }
    if (jacobians && jacobians[4]) {
      Eigen::Map<Eigen::Matrix<double, 2, kReceiverParameters, Eigen::RowMajor>> J(jacobians[4]);
      J.setZero();
      if (seen) J = seen->J_change / sigma_px_;
    }
    return true;
  }

 private:
  const Receiver& receiver_;
  const ReceiverReading& reading_;
  double knot_s_, interval_s_, sigma_px_;
};

// The jerk between two knots is the third difference of the control points over the interval's cube.
struct JerkCost {
  double per_unit;
  template <class T>
  bool operator()(const T* a, const T* b, const T* c, const T* d, T* residual) const {
    for (int i = 0; i < 3; ++i) residual[i] = (d[i] - 3.0 * c[i] + 3.0 * b[i] - a[i]) * per_unit;
    return true;
  }
};

struct PriorCost {
  ReceiverChange sigma;
  template <class T>
  bool operator()(const T* change, T* residual) const {
    for (int i = 0; i < kReceiverParameters; ++i) residual[i] = sigma[i] > 0.0 ? change[i] / sigma[i] : T(0.0);
    return true;
  }
};

ReceiverChange prior_sigma(const SplineBundleOptions& options) {
  ReceiverChange sigma;
  sigma << Eigen::Vector3d::Constant(options.place_sigma_m), Eigen::Vector3d::Constant(options.turn_sigma_rad),
      options.offset_sigma_s, options.rate_sigma, options.readout_sigma_s, options.focal_sigma;
  return sigma;
}

std::vector<Sight> thinned(std::span<const Receiver> receivers, std::span<const ReceiverReading> readings,
                           double per_s) {
  std::vector<Sight> sights;
  std::map<int, double> last_s;
  for (const ReceiverReading& reading : readings) {
    const auto r =
        std::find_if(receivers.begin(), receivers.end(), [&](const auto& x) { return x.id == reading.receiver; });
    if (r == receivers.end()) {
      throw std::invalid_argument(fmt::format("bundle_flight: no receiver has the id {}", reading.receiver));
    }
    const double t = to_seconds(reading.time - Timestamp{});
    const auto last = last_s.find(reading.receiver);
    if (last != last_s.end() && std::abs(t - last->second) < 1.0 / per_s) continue;
    last_s[reading.receiver] = t;
    sights.push_back({reading, static_cast<std::size_t>(r - receivers.begin())});
  }
  return sights;
}

// The path through where lines of sight meet, straight on between.
std::optional<SplinePath> first_path(std::span<const Receiver> receivers, std::span<const ReceiverReading> readings,
                                     const SplineBundleOptions& options) {
  const std::vector<Bearing> bearings = bearings_of(receivers, readings);
  if (bearings.empty()) return std::nullopt;
  const double h = options.knot_interval_s, margin_s = kEdge_s + 3.0 * options.offset_sigma_s;
  const double begin_s = to_seconds(bearings.front().time - Timestamp{}) - margin_s;
  const double end_s = to_seconds(bearings.back().time - Timestamp{}) + margin_s;
  const auto count = static_cast<std::size_t>(std::ceil((end_s - begin_s) / h)) + 3;
  std::vector<Eigen::Vector3d> at_knots(count);
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < count; ++k) {
    const Timestamp time(from_seconds(begin_s + (static_cast<double>(k) - 1.0) * h));
    const auto met = triangulate_static(bearings, time, {.within_s = 0.5 * h});
    if (!met) continue;
    at_knots[k] = met->p_world;
    known.push_back(k);
  }
  if (known.empty()) return std::nullopt;
  for (std::size_t k = 0; k < count; ++k) {
    const auto next = std::lower_bound(known.begin(), known.end(), k);
    const std::size_t b = next == known.end() ? known.back() : *next;
    const std::size_t a = next == known.begin() || b <= k ? b : *(next - 1);
    const double part = a == b ? 0.0 : static_cast<double>(k - a) / static_cast<double>(b - a);
    at_knots[k] = ((1.0 - part) * at_knots[a] + part * at_knots[b]).eval();
  }
  return spline_through(begin_s, h, std::move(at_knots));
}

// Of a coordinate of each receiver's readings about the unknowns, px.
std::vector<double> scatters(std::span<const Receiver> receivers, const std::vector<Sight>& sights,
                             const Unknowns& unknowns) {
  std::vector<std::vector<double>> lengths(receivers.size());
  for (const Sight& sight : sights) {
    const Receiver& receiver = receivers[sight.receiver];
    const ReceiverChange& change = unknowns.changes[sight.receiver];
    const auto point = unknowns.path.at(sight_time(receiver, change, sight.reading).t_s);
    const auto seen = point ? sight_residual(receiver, change, sight.reading, *point) : std::nullopt;
    if (seen) lengths[sight.receiver].push_back(seen->residual_px.norm());
  }
  std::vector<double> sigmas;
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    double sigma = receivers[k].sigma;
    // The path can follow one receiver closer than it sees.
    if (!lengths[k].empty()) sigma = std::max(sigma, kMedianToSigma * median(lengths[k]));
    sigmas.push_back(sigma);
  }
  return sigmas;
}

void hold_what_stands(ceres::Problem& problem, Unknowns& unknowns, const ReceiverChange& sigma,
                      std::size_t time_receiver) {
  for (std::size_t k = 0; k < unknowns.changes.size(); ++k) {
    std::vector<int> held;
    for (int i = 0; i < kReceiverParameters; ++i) {
      const bool is_time = k == time_receiver && (i == kClockOffset || i == kClockRate);
      if (is_time || !(sigma[i] > 0.0)) held.push_back(i);
    }
    double* change = unknowns.changes[k].data();
    if (!held.empty()) problem.SetManifold(change, new ceres::SubsetManifold(kReceiverParameters, held));
  }
}

std::size_t time_receiver_of(std::span<const Receiver> receivers, const SplineBundleOptions& options) {
  if (!options.time_receiver) return 0;
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    if (receivers[k].id == *options.time_receiver) return k;
  }
  throw std::invalid_argument(fmt::format("time_receiver: no receiver has the id {}", *options.time_receiver));
}

// What is believed before any reading: of the path's jerk, and of how far the receivers may be off.
void add_beliefs(ceres::Problem& problem, Unknowns& unknowns, const SplineBundleOptions& options) {
  std::vector<Eigen::Vector3d>& c = unknowns.path.control_m;
  const double h = options.knot_interval_s, per_unit = 1.0 / (h * h * h * options.jerk_m_s3);
  for (std::size_t i = 0; i + 3 < c.size(); ++i) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<JerkCost, 3, 3, 3, 3, 3>(new JerkCost{per_unit}), nullptr,
                             c[i].data(), c[i + 1].data(), c[i + 2].data(), c[i + 3].data());
  }
  const ReceiverChange prior = prior_sigma(options);
  for (ReceiverChange& change : unknowns.changes) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PriorCost, kReceiverParameters, kReceiverParameters>(new PriorCost{prior}),
        nullptr, change.data());
  }
}

int solve(std::span<const Receiver> receivers, const std::vector<Sight>& sights, const SplineBundleOptions& options,
          Unknowns& unknowns) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres tells of its steps whatever its own logging_type
  const std::vector<double> sigmas = scatters(receivers, sights, unknowns);
  SplinePath& path = unknowns.path;
  ceres::CauchyLoss loss(options.loss_sigmas);
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  const double h = options.knot_interval_s;
  for (const Sight& sight : sights) {
    const Receiver& receiver = receivers[sight.receiver];
    ReceiverChange& change = unknowns.changes[sight.receiver];
    const auto i = static_cast<std::size_t>(path.interval_at(sight_time(receiver, change, sight.reading).t_s));
    problem.AddResidualBlock(
        new SightCost(receiver, sight.reading, path.begin_s + static_cast<double>(i) * h, h, sigmas[sight.receiver]),
        &loss, path.control_m[i].data(), path.control_m[i + 1].data(), path.control_m[i + 2].data(),
        path.control_m[i + 3].data(), change.data());
  }
  add_beliefs(problem, unknowns, options);
  hold_what_stands(problem, unknowns, prior_sigma(options), time_receiver_of(receivers, options));
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = 30;
  solver.function_tolerance = 1e-5;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return static_cast<int>(summary.iterations.size());
}

}  // namespace

void validate(const SplineBundleOptions& options) {
  const auto need = [](bool fine, double value, const char* name, const char* bound) {
    if (!fine) throw std::invalid_argument(fmt::format("{} must be {} 0, got {}", name, bound, value));
  };
  const auto positive = [&](double value, const char* name) { need(value > 0.0, value, name, ">"); };
  const auto not_negative = [&](double value, const char* name) { need(value >= 0.0, value, name, ">="); };
  positive(options.knot_interval_s, "knot_interval_s");
  positive(options.readings_per_s, "readings_per_s");
  positive(options.jerk_m_s3, "jerk_m_s3");
  not_negative(options.place_sigma_m, "place_sigma_m");
  not_negative(options.turn_sigma_rad, "turn_sigma_rad");
  not_negative(options.offset_sigma_s, "offset_sigma_s");
  not_negative(options.rate_sigma, "rate_sigma");
  not_negative(options.readout_sigma_s, "readout_sigma_s");
  not_negative(options.focal_sigma, "focal_sigma");
  positive(options.loss_sigmas, "loss_sigmas");
  positive(options.rounds, "rounds");
}

std::optional<SplineBundle> bundle_flight(std::span<const Receiver> receivers,
                                          std::span<const ReceiverReading> readings,
                                          const SplineBundleOptions& options) {
  validate(options);
  if (receivers.size() < 2) throw std::invalid_argument("bundle_flight: two receivers or more are wanted");
  for (const Receiver& receiver : receivers) {
    if (!receiver.camera) throw std::invalid_argument("bundle_flight: a receiver has no camera");
  }
  const std::vector<Sight> sights = thinned(receivers, readings, options.readings_per_s);
  auto path = first_path(receivers, readings, options);
  if (!path) return std::nullopt;
  Unknowns unknowns{std::vector<ReceiverChange>(receivers.size(), ReceiverChange::Zero()), std::move(*path)};
  SplineBundle bundle;
  for (int round = 0; round < options.rounds; ++round) {
    bundle.iterations += solve(receivers, sights, options, unknowns);
  }
  const std::vector<double> sigmas = scatters(receivers, sights, unknowns);
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    bundle.receivers.push_back(changed(receivers[k], unknowns.changes[k]));
    bundle.receivers.back().sigma = sigmas[k];
  }
  bundle.changes = std::move(unknowns.changes);
  bundle.path = std::move(unknowns.path);
  return bundle;
}

}  // namespace alidade
