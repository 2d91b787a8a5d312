// SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/camera_calibration_options.h"
#include "app/camera_calibration_report.h"
#include "app/commands/verbs.h"
#include "core/errors.h"

namespace alidade {
namespace {

class CalibrateCameraCommand : public Command {
 public:
  explicit CalibrateCameraCommand(CLI::App& flags) {
    flags.add_option("SOURCE", source_, "images of the board: a folder, a glob in quotes, a list, or a video")
        ->required();
    flags.add_option(
        "--board", board_,
        "e.g. chessboard:9x6:25mm (inner corners), charuco:8x6:30mm:22mm:5X5_100, aprilgrid:6x6:88mm:26.4mm;"
        " left out: guessed");
    bind(options_, choice_);
  }

  ExitCode run(const RunContext& context) override {
    CameraCalibrationRun run;
    run.board = choose_board(board_, source_);
    if (run.board.is_guessed) context.tell("board: " + describe(run.board.board));
    run.images = read_board_images(source_, run.board.board, context);
    if (context.stop.stop_requested()) return ExitCode::Interrupted;
    ResultDirectory directory(context.output, "calibrate camera");
    const auto begin = std::chrono::steady_clock::now();
    run.result = calibrate_camera(run.images.image, run.board.board, run.images.views, effective_options(choice_),
                                  context.progress, context.stop);
    run.calibration_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (run.result.outcome == CameraCalibrationOutcome::Stopped) return ExitCode::Interrupted;
    if (run.result.outcome != CameraCalibrationOutcome::Calibrated) {
      throw InputError(source_, 0, "no calibration: " + explain(run.result), "");
    }
    run.opencv = calibrate_by_opencv(run.images.image, shape_of(run.board.board), run.images.views);
    add_warnings(run);
    return write(context, run, directory);
  }

 private:
  ExitCode write(const RunContext& context, const CameraCalibrationRun& run, ResultDirectory& directory) const {
    write_camera_calibration(run, directory, context.arguments, options_.to_yaml());
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

  std::string source_, board_;
  CameraCalibrationChoice choice_;
};

}  // namespace

Verb calibrate_camera_verb() {
  return {"calibrate camera", "a camera's intrinsics with their uncertainty, from images of a board",
          "alidade calibrate camera 'shots/*.jpg' --board chessboard:9x6:25mm -o calibration", OutputUse::Required,
          make_command<CalibrateCameraCommand>};
}

}  // namespace alidade
