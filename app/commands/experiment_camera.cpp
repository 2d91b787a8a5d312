// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands/verbs.h"
#include "app/experiments/camera_experiment.h"
#include "app/experiments/experiment_report.h"
#include "app/experiments/recording_experiment.h"
#include "io/map_file.h"

namespace alidade {
namespace {

struct Part {
  std::string name;
  ExperimentSection (*run)(const CameraScene&, const ExperimentContext&);
};

const std::vector<Part> kParts{{"accuracy", camera_accuracy}, {"noise", camera_noise},
                               {"frames", camera_frames},     {"points", camera_points},
                               {"outliers", camera_outliers}, {"uncertain-map", camera_uncertain_map},
                               {"claims", camera_claims}};

// On the user's recordings: run where their folder is given.
struct RecordedPart {
  std::string name;
  std::string flag;
  std::string what;
  ExperimentSection (*run)(const std::filesystem::path&, const ExperimentContext&);
};

const std::vector<RecordedPart> kRecordedParts{
    {"stills", "--stills", "data set of stills with truth, for stills", camera_stills},
    {"known-map", "--video", "recording with depth and truth (TUM RGB-D), for known-map", camera_known_map}};

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const Part& part : kParts) names.push_back(part.name);
  for (const RecordedPart& part : kRecordedParts) names.push_back(part.name);
  return names;
}

class ExperimentCameraCommand : public Command {
 public:
  explicit ExperimentCameraCommand(CLI::App& flags) {
    flags.add_option("--points", points_,
                     "object to move about: vertices of a PLY; else a generated one of 453 points");
    for (const RecordedPart& part : kRecordedParts) flags.add_option(part.flag, recordings_[part.name], part.what);
    flags.add_option("--only", only_, fmt::format("parts to run: {}", fmt::join(part_names(), ", ")))
        ->check(CLI::IsMember(part_names()));
    options_.add("runs", runs_, "", "with different noise, over which errors are averaged");
    options_.add_check([this] {
      if (runs_ < 1) throw std::invalid_argument(fmt::format("runs must be >= 1, got {}", runs_));
    });
  }

  ExitCode run(const RunContext& context) override {
    for (const RecordedPart& part : kRecordedParts) require_recording(part);
    CameraScene scene;
    if (!points_.empty()) scene.points = read_object();
    ExperimentContext experiment{runs_, context.seed, context.progress, context.stop};
    ExperimentRecord record;
    const auto take = [&](const std::string& name, const auto& run) {
      if (!is_wanted(name) || context.stop.stop_requested()) return;
      ExperimentSection section = run();
      if (context.stop.stop_requested()) return;  // a part that was cut short proves nothing
      tell(section, context);
      record.sections.push_back(std::move(section));
    };
    for (const Part& part : kParts) take(part.name, [&] { return part.run(scene, experiment); });
    for (const RecordedPart& part : kRecordedParts) {
      const std::filesystem::path& recording = recordings_[part.name];
      if (!recording.empty()) take(part.name, [&] { return part.run(recording, experiment); });
    }
    record.object = points_.empty() ? "a generated object of 453 points" : points_.filename().string();
    record.count = runs_;
    record.interrupted = context.stop.stop_requested();
    return finish(record, "experiment camera", options_.to_yaml(), context);
  }

 private:
  bool is_wanted(const std::string& name) const {
    return only_.empty() || std::find(only_.begin(), only_.end(), name) != only_.end();
  }

  void require_recording(const RecordedPart& part) const {
    if (only_.empty() || !is_wanted(part.name) || !recordings_.at(part.name).empty()) return;
    throw InputError("--only " + part.name, 0, "needs a recording", fmt::format("give it with {} FOLDER", part.flag));
  }

  std::vector<Eigen::Vector3d> read_object() const {
    std::vector<Eigen::Vector3d> points;
    for (const MapPoint& p : read_map_ply(points_).points) points.push_back(p.p_world);
    constexpr std::size_t kFewest = 10;
    if (points.size() < kFewest) {
      throw InputError(points_.string(), 0, fmt::format("has {} vertices, {} are needed", points.size(), kFewest),
                       "give the PLY of an object");
    }
    return fitted_to(0.15, std::move(points));
  }

  std::filesystem::path points_;
  std::map<std::string, std::filesystem::path> recordings_;  // by part
  std::vector<std::string> only_;
  int runs_ = 100;
};

}  // namespace

Verb experiment_camera_verb() {
  return {"experiment camera", "the camera tracker paper's experiments, and ours beside them",
          "alidade experiment camera -o experiment\n"
          "alidade experiment camera --only accuracy --runs 10 --points bunny.ply -o experiment\n"
          "alidade experiment camera --only known-map --video rgbd_dataset_freiburg1_rpy -o experiment",
          OutputUse::Optional, make_command<ExperimentCameraCommand>};
}

}  // namespace alidade
