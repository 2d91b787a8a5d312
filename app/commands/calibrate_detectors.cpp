// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/calibration_readings.h"
#include "app/commands/verbs.h"
#include "app/detector_calibration_options.h"
#include "app/detector_calibration_report.h"
#include "app/reading_source.h"
#include "datasets/detectors.h"
#include "io/body_file.h"
#include "io/position_file.h"

namespace alidade {
namespace {

class CalibrateDetectorsCommand : public Command {
 public:
  explicit CalibrateDetectorsCommand(CLI::App& flags) {
    flags.add_option("BODY", bodies_, "CSV of markers: marker, x_m, y_m, z_m, and body where there are several")
        ->required();
    flags.add_option("DETECTORS", detectors_, "where they stand roughly: our YAML, detectors.json, or a folder")
        ->required();
    flags
        .add_option("OBSERVATIONS", observations_,
                    "CSV of readings of the moving body; -: standard input; or line images")
        ->required();
    flags.add_option("--body", body_name_, "the body to go by, where the file has several");
    flags.add_option("--start", interval_.start_s, "s, by the observations' clock: pass over what is before");
    flags.add_option("--end", interval_.end_s, "s, by the observations' clock: pass over what is from there on");
    flags.add_option("--reference", reference_, "where a point of the body was: CSV of t_s, x_m, y_m, z_m, or TUM");
    flags.add_option("--verify", verify_, "CSV of readings to verify the refined detectors on");
    flags.add_option("--verify-start", verify_interval_.start_s, "s: of those (without --verify: of OBSERVATIONS)");
    flags.add_option("--verify-end", verify_interval_.end_s, "s: of those");
    flags.add_option("--verify-reference", verify_reference_, "where a point of the body was then, as --reference");
    flags.add_option("--verify-onboard", verify_onboard_, "another estimate, at whose instants errors are compared");
    bind(options_, choice_);
  }

  ExitCode run(const RunContext& context) override {
    DetectorCalibrationRun run;
    run.source = name_of_source(observations_);
    run.given.rig = read_detectors(detectors_);
    const std::vector<RigidBody> bodies = read_bodies(bodies_);
    run.given.body = choose_body(bodies, body_name_, bodies_);
    require_station(run.given.rig, choice_.solver.held_station, detectors_);
    const auto recording = read_recording(observations_, run, bodies, context);
    const auto readings = take_interval(recording, interval_, {run.source, "--start", "--end"});
    const auto verification = read_verification(recording, run, bodies, context);
    const std::optional<MotionReference> reference = read_reference(readings);
    warn_of_overlap(context);

    ResultDirectory directory(context.output, "calibrate detectors");
    const CalibrationContext watched{reference ? &*reference : nullptr, context.progress, context.stop};
    const auto begin = std::chrono::steady_clock::now();
    run.refined = calibrate_detectors(run.given.rig.detectors, run.given.body, readings, choice_.solver, watched);
    run.calibration_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    run.has_reference = reference.has_value();
    if (run.refined.outcome == CalibrationOutcome::Stopped) return ExitCode::Interrupted;
    if (run.refined.outcome != CalibrationOutcome::Refined) {
      context.warn(fmt::format("{}: {}", run.source, explain(run.refined.outcome)));
      return ExitCode::NoAnswer;
    }
    if (verification && !context.stop.stop_requested()) {
      run.verification = verify_detectors(run.given, run.refined, *verification, choice_, watched);
    }
    run.interrupted = context.stop.stop_requested();
    return write(context, run, directory);
  }

 private:
  std::vector<LineReading> read_recording(const std::string& path, DetectorCalibrationRun& run,
                                          const std::vector<RigidBody>& bodies, const RunContext& context) const {
    auto readings = read_all(path, run.given.rig, bodies, context);
    if (!choice_.rotor_times) return readings;
    return repair_times(std::move(readings), run.given.rig, path == "-" ? run.source : path, run.warnings);
  }

  std::optional<VerificationData> read_verification(const std::vector<LineReading>& recording,
                                                    DetectorCalibrationRun& run, const std::vector<RigidBody>& bodies,
                                                    const RunContext& context) const {
    if (verify_.empty() && !verify_interval_.start_s && !verify_interval_.end_s) return std::nullopt;
    VerificationData data;
    data.source = verify_.empty() ? run.source : verify_;
    const auto others = verify_.empty() ? recording : read_recording(verify_, run, bodies, context);
    data.readings = take_interval(others, verify_interval_, {data.source, "--verify-start", "--verify-end"});
    if (!verify_reference_.empty()) {
      data.reference = read_positions(verify_reference_);
      require_overlap(data.reference, data.readings, verify_reference_);
    }
    if (!verify_onboard_.empty()) {
      data.onboard = read_positions(verify_onboard_);
      require_overlap(data.onboard, data.readings, verify_onboard_);
    }
    return data;
  }

  std::optional<MotionReference> read_reference(const std::vector<LineReading>& readings) const {
    if (reference_.empty()) return std::nullopt;
    MotionReference reference{read_positions(reference_), choice_.reference_sigma_m};
    require_overlap(reference.positions, readings, reference_);
    return reference;
  }

  void warn_of_overlap(const RunContext& context) const {
    if (verify_.empty() ? !verify_interval_.start_s && !verify_interval_.end_s : verify_ != observations_) return;
    if (overlap(interval_, verify_interval_)) {
      context.warn("verification uses readings of the calibration: its residuals say little");
    }
  }

  ExitCode write(const RunContext& context, DetectorCalibrationRun& run, ResultDirectory& directory) const {
    add_warnings(run);
    write_calibration(run, directory, context.arguments, options_.to_yaml());
    for (const std::string& warning : run.warnings) context.warn(warning);
    const nlohmann::json summary = summary_of(run);
    directory.commit(summary);
    context.publish(summary);
    for (const std::string& line : table_lines(run)) context.tell(line);
    context.tell(fmt::format("written to {}", context.output.string()));
    if (run.interrupted) return ExitCode::Interrupted;
    const bool is_verified = !run.verification || run.verification->after.outcome == CalibrationOutcome::Refined;
    return is_verified ? ExitCode::Success : ExitCode::NoAnswer;
  }

  std::string bodies_, detectors_, observations_, body_name_, reference_;
  std::string verify_, verify_reference_, verify_onboard_;
  TimeInterval interval_, verify_interval_;
  DetectorCalibrationChoice choice_;
};

}  // namespace

Verb calibrate_detectors_verb() {
  return {"calibrate detectors", "where line detectors stand, from readings of a moving body of known size",
          "alidade calibrate detectors body.csv detectors.yaml observations.csv --verify others.csv -o calibration",
          OutputUse::Required, make_command<CalibrateDetectorsCommand>};
}

}  // namespace alidade
