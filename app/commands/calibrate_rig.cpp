// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/camera_calibration_options.h"
#include "app/commands/verbs.h"
#include "app/rig_calibration_report.h"
#include "app/rig_synchronisation.h"
#include "core/errors.h"

namespace alidade {
namespace {

class CalibrateRigCommand : public Command {
 public:
  CalibrateRigCommand(CLI::App& flags, const std::string& verb) : verb_(verb) {
    flags.add_option("--board", board_, "as of calibrate camera; left out: guessed");
    flags.add_option("--names", names_, "of the cameras, by commas; left out: after their sources")->delimiter(',');
    flags.add_flag("--unsynchronised", is_unsynchronised_,
                   "films of cameras without a common clock or trigger: finds by how much their clocks differ from how "
                   "the board moves; give videos, or folders with times.csv");
    bind(options_, choice_);
  }

  ExitCode run(const RunContext& context) override {
    RigCalibrationRun run;
    run.names = camera_names();
    run.board = choose_board(board_, sources_.front());
    if (run.board.is_guessed) context.tell("board: " + describe(run.board.board));
    for (const std::string& source : sources_) {
      run.images.push_back(read_board_images(source, run.board.board, context,
                                             is_unsynchronised_ ? FilmViews::All : FilmViews::StillAndDistinct));
      if (context.stop.stop_requested()) return ExitCode::Interrupted;
    }
    if (is_unsynchronised_) {
      synchronise_cameras(run, effective_options(choice_), context);
      if (run.clocks.empty()) return ExitCode::Interrupted;
    } else {
      run.moments = match_moments(run.images);
    }
    ResultDirectory directory(context.output, verb_);
    const auto views = rig_views(run);
    const auto begin = std::chrono::steady_clock::now();
    run.result = calibrate_rig(run.board.board, views, effective_options(choice_), context.progress, context.stop);
    run.calibration_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (run.result.outcome == RigCalibrationOutcome::Stopped) return ExitCode::Interrupted;
    if (run.result.outcome != RigCalibrationOutcome::Calibrated) {
      const std::size_t failed = run.result.failed.empty() ? 0 : static_cast<std::size_t>(run.result.failed.front());
      throw InputError(sources_[failed], 0, "no calibration: " + explain(run.result, views), "");
    }
    add_warnings(run);
    return write(context, run, directory);
  }

 protected:
  std::vector<std::string> sources_;

 private:
  std::vector<std::string> camera_names() const {
    std::vector<std::string> names = names_;
    if (names.empty()) {
      for (std::size_t i = 0; i < sources_.size(); ++i) {
        names.push_back(camera_name(sources_[i], static_cast<int>(i)));
      }
      if (std::set(names.begin(), names.end()).size() < names.size()) {
        for (std::size_t i = 0; i < names.size(); ++i) names[i] = fmt::format("camera{}", i);
      }
    }
    if (names.size() != sources_.size() || std::set(names.begin(), names.end()).size() < names.size()) {
      throw InputError("--names", 0, fmt::format("names {} cameras, there are {}", names.size(), sources_.size()),
                       "give every source a name of its own");
    }
    return names;
  }

  ExitCode write(const RunContext& context, RigCalibrationRun& run, ResultDirectory& directory) const {
    write_rig_calibration(run, directory, context.arguments, options_.to_yaml());
    for (const std::string& warning : run.warnings) context.warn(warning);
    const nlohmann::json summary = summary_of(run);
    directory.commit(summary);
    context.publish(summary);
    for (const ReportRow& row : figure_rows(run)) {
      context.tell(fmt::format("{}: {}{}{}", row.name, row.value, row.unit.empty() ? "" : " ", row.unit));
    }
    context.tell(fmt::format("written to {}", context.output.string()));
    return ExitCode::Success;
  }

  std::string verb_, board_;
  std::vector<std::string> names_;
  bool is_unsynchronised_ = false;
  CameraCalibrationChoice choice_;
};

class SeveralCamerasCommand : public CalibrateRigCommand {
 public:
  explicit SeveralCamerasCommand(CLI::App& flags) : CalibrateRigCommand(flags, "calibrate rig") {
    flags.add_option("SOURCE", sources_, "images of the board by each camera, as of calibrate camera; two and more")
        ->required()
        ->expected(2, 1000);
  }
};

class TwoCamerasCommand : public CalibrateRigCommand {
 public:
  explicit TwoCamerasCommand(CLI::App& flags) : CalibrateRigCommand(flags, "calibrate stereo") {
    sources_.resize(2);
    flags.add_option("LEFT", sources_[0], "images of the board by the left camera, as of calibrate camera")->required();
    flags.add_option("RIGHT", sources_[1], "images by the right camera at the same moments")->required();
  }
};

}  // namespace

Verb calibrate_rig_verb() {
  return {"calibrate rig", "several cameras and how they stand to each other, from images of one board",
          "alidade calibrate rig 'front/*.png' 'left/*.png' 'right/*.png' --board charuco:8x6:30mm:22mm:5X5_100 -o rig",
          OutputUse::Required, make_command<SeveralCamerasCommand>};
}

Verb calibrate_stereo_verb() {
  return {"calibrate stereo", "two cameras and how they stand to each other, from images of one board",
          "alidade calibrate stereo 'left*.jpg' 'right*.jpg' --board chessboard:9x6:25mm -o stereo",
          OutputUse::Required, make_command<TwoCamerasCommand>};
}

}  // namespace alidade
