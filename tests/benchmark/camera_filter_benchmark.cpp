// SPDX-License-Identifier: Apache-2.0
// CPU time of one frame: our filter's step and the single-frame estimators on the same sightings, in one thread.

#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>

#include "datasets/object_orbit.h"
#include "reconstruction/resection.h"
#include "tracking/camera_filter.h"

namespace alidade {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr double kSigma_px = 3.0;

// The camera tracker paper's experiment: 453 exact points in 55 frames.
struct Recording {
  Camera camera = orbit_camera();
  std::vector<Eigen::Isometry3d> truth = orbit_poses(OrbitPath::Smooth, 55);
  std::vector<std::vector<PointObservation>> sightings;
};

const Recording& recording() {
  static const Recording made = [] {
    Recording r;
    std::mt19937_64 random(1);
    for (const Eigen::Isometry3d& T : r.truth) {
      r.sightings.push_back(sighted(r.camera, T, orbit_object(), kSigma_px, random));
    }
    return r;
  }();
  return made;
}

Timestamp time_of(std::size_t frame) {
  return Timestamp(from_seconds(static_cast<double>(frame) * kFrameS));
}

// All of a step: prediction, gate, every iteration, covariance, both noises. From the last frame on to the third again.
void step_filter(benchmark::State& run) {
  const Recording& r = recording();
  CameraFilterOptions options;
  const Vector6d pace = difference(r.truth[0], r.truth[1]) / kFrameS;
  options.motion = guessed_motion(pace.head<3>().norm(), pace.tail<3>().norm(), kFrameS);
  const MotionState first = moving_state({time_of(0), r.truth[0], {}}, {time_of(1), r.truth[1], {}});
  MotionState state = first;
  SightingNoise noise;
  std::size_t frame = 2;
  for (auto _ : run) {
    auto step = filter_step(r.camera, state, noise, time_of(frame), r.sightings[frame], options);
    if (!step) return run.SkipWithError("a frame has no pose");
    state = step->motion.state;
    noise = step->noise;
    if (++frame == r.truth.size()) {
      frame = 2;
      state = first;
    }
  }
}

void solve(benchmark::State& run, PnpMethod method) {
  const Recording& r = recording();
  std::size_t frame = 2;
  for (auto _ : run) {
    const auto T_world_camera = solve_pnp(r.camera, r.sightings[frame], method);
    if (!T_world_camera) return run.SkipWithError("a frame has no pose");
    benchmark::DoNotOptimize(T_world_camera->matrix().data());
    if (++frame == r.truth.size()) frame = 2;
  }
}

BENCHMARK(step_filter)->Name("filter_step")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(solve, epnp, PnpMethod::Epnp)->Name("EPnP")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(solve, sqpnp, PnpMethod::Sqpnp)->Name("SQPnP")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(solve, epnp_lm, PnpMethod::EpnpLm)->Name("EPnP+LM")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace alidade

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
