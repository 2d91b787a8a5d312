// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/resection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include "core/median.h"
#include "reconstruction/resection.h"

namespace alidade {
namespace {

constexpr double kMedianToSigma = 1.0 / 1.17741;  // the median distance in the plane is σ √(2 ln 2)

using Readings = std::vector<ReceiverReading>;

std::optional<SightResidual> residual_on_track(const Receiver& receiver, const ReceiverChange& change,
                                               const ReceiverReading& reading, const KnownTrack& track) {
  const auto point = track.at(sight_time(receiver, change, reading).t_s);
  if (!point) return std::nullopt;
  return sight_residual(receiver, change, reading, *point);
}

// Of the residuals' lengths; infinite where half of the readings or more see nothing.
double median_px(const Receiver& receiver, const Readings& readings, const KnownTrack& track) {
  std::vector<double> lengths;
  for (const ReceiverReading& reading : readings) {
    const auto r = residual_on_track(receiver, ReceiverChange::Zero(), reading, track);
    lengths.push_back(r ? r->residual_px.norm() : std::numeric_limits<double>::infinity());
  }
  return lengths.empty() ? std::numeric_limits<double>::infinity() : median(std::move(lengths));
}

std::optional<Receiver> posed_at(Receiver receiver, double later_s, const Readings& some, const KnownTrack& track) {
  receiver.clock.offset_s += later_s;
  std::vector<PointObservation> observations;
  for (const ReceiverReading& reading : some) {
    const auto point = track.at(sight_time(receiver, ReceiverChange::Zero(), reading).t_s);
    if (!point) continue;
    PointObservation observation;
    observation.pixel = reading.value;
    observation.p_world = point->p_world;
    observations.push_back(observation);
  }
  const auto pose = solve_pnp(*receiver.camera, observations, PnpMethod::Sqpnp);
  if (!pose) return std::nullopt;
  receiver.T_world_receiver = *pose;
  return receiver;
}

// The clock's offset at which the best pose fits best; then closer about it.
std::optional<Receiver> sweep(const Receiver& given, const Readings& readings, const KnownTrack& track,
                              const ResectionOptions& options) {
  Readings some;
  const std::size_t stride =
      std::max<std::size_t>(1, readings.size() / static_cast<std::size_t>(options.sweep_readings));
  for (std::size_t i = 0; i < readings.size(); i += stride) some.push_back(readings[i]);
  std::optional<Receiver> best;
  double best_px = std::numeric_limits<double>::infinity(), middle_s = 0.0, width_s = options.search_s;
  for (double step_s = options.sweep_step_s; step_s > 0.005; step_s *= 0.25) {
    const double around_s = middle_s;
    const int steps = static_cast<int>(std::floor(width_s / step_s));
    for (int i = -steps; i <= steps; ++i) {
      const auto posed = posed_at(given, around_s + i * step_s, some, track);
      if (!posed) continue;
      const double px = median_px(*posed, some, track);
      if (px >= best_px) continue;
      best_px = px, best = posed, middle_s = around_s + i * step_s;
    }
    width_s = step_s;
  }
  return best;
}

class TrackCost : public ceres::SizedCostFunction<2, kReceiverParameters> {
 public:
  TrackCost(const Receiver& receiver, const ReceiverReading& reading, const KnownTrack& track)
      : receiver_(receiver), reading_(reading), track_(track) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const ReceiverChange> change(parameters[0]);
    const auto r = residual_on_track(receiver_, change, reading_, track_);
    Eigen::Map<Eigen::Vector2d> error(residuals);
    error.setZero();
    if (r) error = r->residual_px;
    if (jacobians && jacobians[0]) {
      Eigen::Map<Eigen::Matrix<double, 2, kReceiverParameters, Eigen::RowMajor>> J(jacobians[0]);
      J.setZero();
      if (r) J = r->J_change;
    }
    return true;
  }

 private:
  const Receiver& receiver_;
  const ReceiverReading& reading_;
  const KnownTrack& track_;
};

std::vector<int> held_parameters(const ResectionOptions& options) {
  std::vector<int> held;
  for (int i = 0; i < 3; ++i) {
    if (!options.find_place) held.push_back(kTranslation + i);
    if (!options.find_turn) held.push_back(kRotation + i);
  }
  if (!options.find_rate) held.push_back(kClockRate);
  if (!options.find_readout) held.push_back(kReadout);
  if (!options.find_focal) held.push_back(kFocal);
  return held;
}

bool refine(const Receiver& start, const Readings& readings, const KnownTrack& track, const ResectionOptions& options,
            ReceiverChange& change) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres tells of its steps whatever its own logging_type
  for (int round = 0; round < 3; ++round) {
    const double scatter_px = kMedianToSigma * median_px(changed(start, change), readings, track);
    if (!std::isfinite(scatter_px)) return false;
    ceres::CauchyLoss loss(options.loss_sigmas * std::max(scatter_px, 1e-3));
    ceres::Problem::Options ownership;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    for (const ReceiverReading& reading : readings) {
      problem.AddResidualBlock(new TrackCost(start, reading, track), &loss, change.data());
    }
    const auto held = held_parameters(options);
    if (!held.empty()) problem.SetManifold(change.data(), new ceres::SubsetManifold(kReceiverParameters, held));
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.max_num_iterations = 50;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (!summary.IsSolutionUsable()) return false;
  }
  return true;
}

// Sums over blocks of time.
struct Block {
  ReceiverChange score = ReceiverChange::Zero();
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();
  double weight = 0.0;
};

struct Spread {
  Eigen::Matrix<double, kReceiverParameters, kReceiverParameters> covariance;
  double wander_px = 0.0;
};

std::optional<Spread> spread_of(const Receiver& receiver, const Readings& readings, const KnownTrack& track,
                                const ResectionOptions& options) {
  std::map<long, Block> blocks;
  Eigen::Matrix<double, kReceiverParameters, kReceiverParameters> H;
  H.setZero();
  for (const ReceiverReading& reading : readings) {
    const auto r = residual_on_track(receiver, ReceiverChange::Zero(), reading, track);
    if (!r) continue;
    const double off = r->residual_px.norm() / (options.loss_sigmas * receiver.sigma), w = 1.0 / (1.0 + off * off);
    Block& block = blocks[std::lround(to_seconds(reading.time - Timestamp{}) / options.block_s)];
    H += w * r->J_change.transpose() * r->J_change;
    block.score += w * r->J_change.transpose() * r->residual_px;
    block.residual_px += w * r->residual_px;
    block.weight += w;
  }
  for (const int held : held_parameters(options)) {
    H.row(held).setZero(), H.col(held).setZero();
    H(held, held) = 1.0;  // its score is 0, and so is its variance
    for (auto& [number, block] : blocks) block.score[held] = 0.0;
  }
  // Scaled to ones on the diagonal: rates and places differ by orders of magnitude.
  const ReceiverChange unit = H.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(unit.asDiagonal() * H * unit.asDiagonal());
  const auto count = static_cast<double>(blocks.size());
  if (factor.info() != Eigen::Success || !unit.allFinite() || count <= kReceiverParameters) return std::nullopt;
  Spread spread;
  spread.covariance.setZero();
  double mean2 = 0.0;
  for (const auto& [number, block] : blocks) {
    const ReceiverChange moved = unit.asDiagonal() * factor.solve(unit.asDiagonal() * block.score);
    spread.covariance += moved * moved.transpose() * (count / (count - kReceiverParameters));
    if (block.weight > 0.0) mean2 += 0.5 * (block.residual_px / block.weight).squaredNorm() / count;
  }
  spread.wander_px = std::sqrt(mean2);
  return spread;
}

// With the clock's reference amid the readings, where offset and rate hardly depend on each other.
Receiver with_middle_reference(Receiver receiver, const Readings& readings) {
  const Timestamp middle = readings.front().time + (readings.back().time - readings.front().time) / 2;
  receiver.clock.offset_s += receiver.clock.rate * to_seconds(middle - receiver.clock.reference);
  receiver.clock.reference = middle;
  return receiver;
}

Readings covered(const Receiver& receiver, std::span<const ReceiverReading> readings, const KnownTrack& track,
                 double margin_s) {
  Readings result;
  for (const ReceiverReading& reading : readings) {
    if (reading.receiver != receiver.id) throw std::invalid_argument("resect_receiver: a reading of another receiver");
    const double t = sight_time(receiver, ReceiverChange::Zero(), reading).t_s;
    if (t > track.begin_s() + margin_s && t < track.end_s() - margin_s) result.push_back(reading);
  }
  return result;
}

}  // namespace

void validate(const ResectionOptions& options) {
  const auto need = [](double value, const char* name) {
    if (!(value > 0.0)) throw std::invalid_argument(fmt::format("{} must be > 0, got {}", name, value));
  };
  need(options.search_s, "search_s");
  need(options.sweep_step_s, "sweep_step_s");
  need(options.sweep_readings - 5, "sweep_readings - 5");
  need(options.loss_sigmas, "loss_sigmas");
  need(options.block_s, "block_s");
  need(options.least_readings - 19, "least_readings - 19");
}

std::optional<ResectedReceiver> resect_receiver(const Receiver& given, std::span<const ReceiverReading> readings,
                                                const KnownTrack& track, const ResectionOptions& options) {
  validate(options);
  if (!given.camera) throw std::invalid_argument("resect_receiver: the receiver has no camera");
  const Readings used = covered(given, readings, track, options.keep_pose ? 0.0 : options.search_s);
  if (static_cast<int>(used.size()) < options.least_readings) return std::nullopt;
  auto start = std::optional<Receiver>(with_middle_reference(given, used));
  if (!options.keep_pose) start = sweep(*start, used, track, options);
  ReceiverChange change = ReceiverChange::Zero();
  if (!start || !refine(*start, used, track, options, change)) return std::nullopt;
  ResectedReceiver result;
  result.receiver = changed(*start, change);
  result.focal_scale = result.receiver.camera->fx / given.camera->fx;
  result.readings = static_cast<int>(used.size());
  result.median_px = median_px(result.receiver, used, track);
  result.receiver.sigma = std::max(1e-3, kMedianToSigma * result.median_px);
  const auto spread = spread_of(result.receiver, used, track, options);
  if (!spread) return std::nullopt;
  result.sigma = spread->covariance.diagonal().cwiseSqrt();
  result.wander_px = spread->wander_px;
  Matrix6d pose = spread->covariance.topLeftCorner<6, 6>();
  const double wander_rad = spread->wander_px / result.receiver.camera->fx;
  pose(3, 3) += wander_rad * wander_rad;
  pose(4, 4) += wander_rad * wander_rad;
  result.receiver.pose_covariance = pose;
  result.receiver.clock.covariance = spread->covariance.block<2, 2>(kClockOffset, kClockOffset);
  return result;
}

}  // namespace alidade
