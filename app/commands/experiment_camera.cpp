// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/experiments/camera_experiment.h"
#include "app/experiments/experiment_report.h"
#include "app/result_directory.h"
#include "io/map_file.h"

namespace alidade {
namespace {

struct Part {
  std::string name;
  ExperimentSection (*run)(const CameraScene&, const ExperimentContext&);
};

const std::vector<Part> kParts{{"accuracy", camera_accuracy}, {"noise", camera_noise},
                               {"frames", camera_frames},     {"points", camera_points},
                               {"outliers", camera_outliers}, {"uncertain-map", camera_uncertain_map}};

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const Part& part : kParts) names.push_back(part.name);
  return names;
}

class ExperimentCameraCommand : public Command {
 public:
  explicit ExperimentCameraCommand(CLI::App& flags) {
    flags.add_option("--points", points_,
                     "object to move about: vertices of a PLY; else a generated one of 453 points");
    flags.add_option("--only", only_, fmt::format("parts to run: {}", fmt::join(part_names(), ", ")))
        ->check(CLI::IsMember(part_names()));
    options_.add("runs", runs_, "", "with different noise, over which errors are averaged");
    options_.add_check([this] {
      if (runs_ < 1) throw std::invalid_argument(fmt::format("runs must be >= 1, got {}", runs_));
    });
  }

  ExitCode run(const RunContext& context) override {
    CameraScene scene;
    if (!points_.empty()) scene.points = read_object();
    ExperimentContext experiment{runs_, context.seed, context.progress, context.stop};
    ExperimentRecord record;
    for (const Part& part : kParts) {
      if (!only_.empty() && std::find(only_.begin(), only_.end(), part.name) == only_.end()) continue;
      ExperimentSection section = part.run(scene, experiment);
      if (context.stop.stop_requested()) break;  // a part that was cut short proves nothing
      for (const ReportTable& table : section.tables) {
        for (const std::string& line : lines_of(table)) context.tell(line);
        context.tell("");
      }
      record.sections.push_back(std::move(section));
    }
    record.object = points_.empty() ? "a generated object of 453 points" : points_.filename().string();
    record.runs = runs_;
    record.interrupted = context.stop.stop_requested();
    context.publish(summary_of(record));
    if (!context.output.empty()) write(record, context);
    return record.interrupted ? ExitCode::Interrupted : ExitCode::Success;
  }

 private:
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

  void write(const ExperimentRecord& record, const RunContext& context) const {
    ResultDirectory directory(context.output, "experiment camera");
    write_experiment(record, context.arguments, options_.to_yaml(), directory);
    directory.commit(summary_of(record));
    context.tell(fmt::format("written to {}", context.output.string()));
  }

  std::filesystem::path points_;
  std::vector<std::string> only_;
  int runs_ = 100;
};

}  // namespace

Verb experiment_camera_verb() {
  return {"experiment camera", "the camera tracker paper's experiments, and ours beside them",
          "alidade experiment camera -o experiment\n"
          "alidade experiment camera --only accuracy --runs 10 --points bunny.ply -o experiment",
          OutputUse::Optional, make_command<ExperimentCameraCommand>};
}

}  // namespace alidade
