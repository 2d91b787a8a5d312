// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <benchmark/benchmark.h>

#include "camera/receiver.h"
#include "datasets/target_scene.h"
#include "uav/batch/motion_fit.h"
#include "uav/batch/placement.h"
#include "uav/window/window_association.h"

namespace alidade {
namespace {

constexpr unsigned kScenes = 20;  // so that no single one decides

std::vector<Bearing> bearings_of_scene(int targets, double detection_probability, double false_bearings,
                                       unsigned seed) {
  TargetSceneOptions options;
  options.targets = targets;
  options.detection_probability = detection_probability;
  options.false_bearings = false_bearings;
  options.seed = seed;
  const TargetScene scene = make_target_scene(options);
  return bearings_of(scene.receivers, scene.readings);
}

// Windows of five periods, three receivers, Pd 0.9, one false bearing per scan.
void twenty_windows(benchmark::State& state) {
  std::vector<std::vector<Bearing>> scenes;
  for (unsigned seed = 1; seed <= kScenes; ++seed) {
    scenes.push_back(bearings_of_scene(static_cast<int>(state.range(0)), 0.9, 1.0, seed));
  }
  for (auto _ : state) {
    for (const std::vector<Bearing>& bearings : scenes) benchmark::DoNotOptimize(associate_window(bearings));
  }
  state.SetItemsProcessed(state.iterations() * kScenes);
}
BENCHMARK(twenty_windows)->Arg(5)->Arg(10)->Arg(20)->Unit(benchmark::kMillisecond);

// The motion of one target from 15 bearings, straight on (6 unknowns) or along a parabola (9).
void batch_fit(benchmark::State& state) {
  const std::vector<Bearing> bearings = bearings_of_scene(1, 1.0, 0.0, 1);
  MotionFitOptions options;
  if (state.range(0) == 9) options.model = MotionModel::Acceleration;
  for (auto _ : state) benchmark::DoNotOptimize(fit_motion(bearings, options));
}
BENCHMARK(batch_fit)->Arg(6)->Arg(9)->Unit(benchmark::kMicrosecond);

// One point of the placement map.
void placement_point(benchmark::State& state) {
  TargetSceneOptions scene_options;
  scene_options.targets = 1;
  const std::vector<Receiver> receivers = make_target_scene(scene_options).receivers;
  const Eigen::Vector3d place = receivers.front().T_world_receiver * Eigen::Vector3d(0, 0, 120);
  for (auto _ : state) benchmark::DoNotOptimize(bound_at(receivers, {}, place));
}
BENCHMARK(placement_point)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace alidade

BENCHMARK_MAIN();
