// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <unistd.h>

#include "app/experiments/body_experiment.h"
#include "app/experiments/cpu_clock.h"
#include "datasets/body_scene.h"
#include "io/reading_file.h"
#include "marker1d/body_tracker.h"
#include "marker1d/paper_tracker.h"
#include "marker1d/reading_batches.h"

namespace alidade {
namespace {

constexpr int kRuns = 5;
constexpr double kPaperStepsPerSecond = 10000;  // "10 000 time steps in about 1 s", of its day's machine

// A recording on disk, gone with this.
class RecordedScene {
 public:
  explicit RecordedScene(const BodySceneOptions& options)
      : path_(std::filesystem::temp_directory_path() / fmt::format("alidade-speed-{}.csv", ::getpid())) {
    BodyScene scene(options);
    detectors = scene.detectors();
    body = scene.bodies().front();
    ReadingWriter writer(path_, detectors);
    while (const auto frame = scene.next()) {
      for (const LineReading& reading : frame->readings) writer.write(reading);
    }
    writer.commit();
  }
  ~RecordedScene() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  RecordedScene(const RecordedScene&) = delete;
  RecordedScene& operator=(const RecordedScene&) = delete;

  // Calls `track` for each batch of the file; returns how many there were.
  template <typename Track>
  int replay(const Track& track) const {
    ReadingReader reader(path_, detectors, std::span(&body, 1));
    ReadingBatches batches(from_seconds(1e-3));
    int count = 0;
    const auto take = [&](const std::optional<ReadingBatch>& batch) {
      if (!batch) return;
      track(*batch);
      ++count;
    };
    while (const auto reading = reader.next()) take(batches.add(*reading));
    take(batches.finish());
    return count;
  }

  std::vector<LineDetector> detectors;
  RigidBody body;

 private:
  std::filesystem::path path_;
};

int track_by_paper(const RecordedScene& scene) {
  PaperTracker tracker(scene.body);
  return scene.replay([&](const ReadingBatch& batch) {
    tracker.step(batch.time, marker_planes(scene.detectors, scene.body, batch.readings, tracker.predicted(batch.time)));
  });
}

int track_by_ours(const RecordedScene& scene) {
  const DetectorArray detectors(scene.detectors);
  BodyTracker tracker(detectors, scene.body);
  return scene.replay([&](const ReadingBatch& batch) { tracker.track(batch.time, batch.readings); });
}

int only_read(const RecordedScene& scene) {
  return scene.replay([](const ReadingBatch&) {});
}

}  // namespace

ExperimentSection body_speed(const ExperimentContext& context) {
  ExperimentSection section{
      "speed",
      "The whole loop, from a CSV file to poses",
      {fmt::format("CPU time of the thread, the least of {} runs; twelve detectors, four markers, 30 % of the readings "
                   "hidden and 5 % with a wrong id, so that padding and rejection have their work. The paper reports "
                   "{:.0f} steps per second.",
                   kRuns, kPaperStepsPerSecond)},
      {},
      {},
      {}};
  BodySceneOptions options;
  options.frames = context.runs;
  options.seed = context.seed;
  options.occluded = 0.3;
  options.wrong_ids = 0.05;
  const RecordedScene scene(options);
  ReportTable table{"From CSV to poses", {"method", "steps", "steps per second", "us per step"}, {}};
  struct Method {
    const char* name;
    int (*run)(const RecordedScene&);
  };
  for (const auto& [name, run] :
       {Method{"reading alone", only_read}, Method{"paper", track_by_paper}, Method{"ours", track_by_ours}}) {
    double least_s = std::numeric_limits<double>::infinity();
    int steps = 0;
    for (int i = 0; i < kRuns; ++i) {
      if (context.stop.stop_requested()) return section;
      const double start = thread_seconds();
      steps = run(scene);
      least_s = std::min(least_s, thread_seconds() - start);
      if (context.progress) context.progress({fmt::format("speed, {}", name), i + 1, kRuns, ""});
    }
    table.rows.push_back({name, std::to_string(steps), fmt::format("{:.0f}", steps / least_s),
                          fmt::format("{:.1f}", 1e6 * least_s / steps)});
    section.summary[name] = {{"steps", steps}, {"steps_per_s", steps / least_s}};
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
