// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/experiments/targets_experiment.h"
#include "datasets/target_scene.h"
#include "evaluation/ensemble.h"
#include "geometry/tangent.h"
#include "uav/batch/placement.h"

namespace alidade {
namespace {

constexpr int kPlaces = 10;
constexpr double kHalfWidth_m = 60.0, kHalfHeight_m = 30.0;  // of the volume about the receivers' common point

struct Place {
  PlacementPoint point;
  std::vector<double> squared_m2;  // errors of the runs; fewer where the motion was not determined
};

std::vector<Receiver> receivers_of(const ExperimentContext& context) {
  TargetSceneOptions options;
  options.targets = 1;
  options.seed = context.seed;
  return make_target_scene(options).receivers;
}

// Where the receivers' axes meet.
Eigen::Vector3d middle_of(const std::vector<Receiver>& receivers) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Receiver& receiver : receivers) {
    const Eigen::Vector3d axis = receiver.T_world_receiver.linear().col(2);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    A += across;
    b += across * receiver.T_world_receiver.translation();
  }
  return A.ldlt().solve(b);
}

Eigen::MatrixXd normal_draws(Eigen::Index runs, Eigen::Index dimensions, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(runs, dimensions, [&] { return normal(random); });
}

// Of fits to the exact bearings with each row's noise.
std::vector<double> squared_errors(const std::vector<Bearing>& exact, const Eigen::Vector3d& p_world, MotionModel model,
                                   const Eigen::MatrixXd& draws) {
  MotionFitOptions options;
  options.model = model;
  std::vector<double> squared_m2;
  for (Eigen::Index run = 0; run < draws.rows(); ++run) {
    std::vector<Bearing> bearings = exact;
    for (std::size_t i = 0; i < bearings.size(); ++i) {
      const Eigen::Vector2d normal = draws.row(run).segment<2>(2 * static_cast<Eigen::Index>(i)).transpose();
      Eigen::Vector3d& direction = bearings[i].direction_world;
      direction =
          (direction + tangent_basis(direction) * (bearings[i].covariance.llt().matrixL() * normal)).normalized();
    }
    const MotionAnswer answer = fit_motion(bearings, options);
    if (answer.fit) squared_m2.push_back((answer.fit->state.p_world - p_world).squaredNorm());
  }
  return squared_m2;
}

Place try_place(const std::vector<Receiver>& receivers, const PlacementOptions& options, const Eigen::Vector3d& p_world,
                const ExperimentContext& context) {
  const std::vector<Bearing> exact = planned_bearings(receivers, options, p_world);
  const auto dimensions = 2 * static_cast<Eigen::Index>(exact.size());
  return {bound_at(receivers, options, p_world),
          squared_errors(exact, p_world, options.model, normal_draws(context.runs, dimensions, context.seed))};
}

std::vector<Eigen::Vector3d> draw_places(const Eigen::Vector3d& middle, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < kPlaces; ++i) {
    const double x = even(random), y = even(random), z = even(random);
    places.push_back(middle + Eigen::Vector3d(kHalfWidth_m * x, kHalfWidth_m * y, kHalfHeight_m * z));
  }
  return places;
}

}  // namespace

ExperimentSection targets_placement(const ExperimentContext& context) {
  ExperimentSection section{
      "placement",
      "The placement map's bound against Monte Carlo",
      {"Ten places in a volume of 120 × 120 × 60 m between the scene's three receivers; a target that flies through at "
       "15 m/s, five periods, delays .1/.2. RMS of the position at the last look.",
       "All places share the runs' noise; the RMS of 500 runs scatters by 2 to 3 % itself."},
      {},
      {},
      {}};
  const std::vector<Receiver> receivers = receivers_of(context);
  const Eigen::Vector3d middle = middle_of(receivers);
  PlacementOptions options;
  options.delays_s = {0.0, 0.1, 0.2};
  const std::vector<Eigen::Vector3d> positions = draw_places(middle, context.seed);
  std::vector<Place> places(positions.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    if (!context.stop.stop_requested()) places[i] = try_place(receivers, options, positions[i], context);
  });
  if (context.stop.stop_requested()) return section;
  ReportTable table{fmt::format("{} runs at each place", context.runs),
                    {"place (m from the middle)", "bound (m)", "RMS (m)", "RMS / bound", "answered"},
                    {}};
  double farthest = 0.0;
  for (const Place& place : places) {
    const Eigen::Vector3d p = place.point.p_world - middle;
    const double rms_m = pooled_rms(place.squared_m2), bound_m = place.point.rms_m.value();
    farthest = std::max(farthest, std::abs(rms_m / bound_m - 1.0));
    table.rows.push_back({fmt::format("({:.0f}, {:.0f}, {:.0f})", p.x(), p.y(), p.z()), fmt::format("{:.4f}", bound_m),
                          fmt::format("{:.4f}", rms_m), fmt::format("{:.3f}", rms_m / bound_m),
                          std::to_string(place.squared_m2.size())});
    section.summary["to_bound"].push_back(rms_m / bound_m);
    section.summary["answered"].push_back(place.squared_m2.size());
  }
  section.summary["farthest_from_one"] = farthest;
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
