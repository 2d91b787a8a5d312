// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/body_pipeline.h"
#include "app/body_report.h"
#include "app/commands/verbs.h"
#include "app/live_messages.h"
#include "app/live_output.h"
#include "app/reading_source.h"
#include "datasets/detectors.h"
#include "io/body_file.h"
#include "io/detector_file.h"
#include "io/reading_file.h"

namespace alidade {
namespace {

class TrackBodyCommand : public Command {
 public:
  explicit TrackBodyCommand(CLI::App& flags) {
    flags.add_option("BODY", bodies_, "CSV of markers: marker, x_m, y_m, z_m, and body where there are several")
        ->required();
    flags.add_option("DETECTORS", detectors_, "line detectors: our YAML, detectors.json of laser sweeps, or a folder")
        ->required();
    flags
        .add_option("OBSERVATIONS", observations_,
                    "CSV of readings in order of time; -: standard input; or a folder of line images")
        ->required();
    flags.add_option("--start", start_s_, "s, by the observations' clock: pass over what is before");
    flags.add_option("--end", end_s_, "s, by the observations' clock: stop there");
    flags.add_option("--stream", stream_, kStreamHelp);
    bind(options_, track_);
  }

  ExitCode run(const RunContext& context) override {
    const std::vector<RigidBody> bodies = read_bodies(bodies_);
    const DetectorRig rig = read_detectors(detectors_);
    std::optional<LiveOutput> live;  // before standard input has said anything
    if (!stream_.empty()) live.emplace(context, stream_, hello_message(hello(bodies)));
    const auto source = open_readings(observations_, rig.detectors, bodies, context.stop);
    ResultDirectory directory(context.output, "track body");
    BodyRecord record(directory, rig.detectors, bodies, detail_of(track_));
    const auto begin = std::chrono::steady_clock::now();
    const BodyPipeline::LiveSink sink = live ? sink_of(*live) : BodyPipeline::LiveSink();
    BodyPipeline pipeline(rig.detectors, bodies, track_, record, sink);
    const std::optional<InputError> fault = follow(context, *source, rig.detectors, directory, pipeline);
    if (fault && !record.run().has_answer()) throw *fault;

    BodyRun run = record.commit();
    run.tracking_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    run.source = name_of_source(observations_);
    run.signals = source->signals();
    run.method = describe(track_);
    run.interrupted = context.stop.stop_requested();
    if (live) live->end(end_message(live_end(run)));
    if (fault) run.fault = fault->what();
    write_bodies(directory.path("body.csv"), bodies);
    write_detector_rig(directory.path("detectors.yaml"), rig);
    write_body_report(run, directory, context.arguments, options_.to_yaml());
    for (const std::string& warning : run.warnings) context.warn(warning);
    const nlohmann::json summary = summary_of(run);
    directory.commit(summary);
    tell(context, run, summary);
    if (fault) throw *fault;
    if (run.interrupted) return ExitCode::Interrupted;
    return answer(context, run);
  }

 private:
  // Until the observations end, the user stops it, or a line is wrong: what was wrong, then.
  std::optional<InputError> follow(const RunContext& context, ReadingSource& source,
                                   const std::vector<LineDetector>& detectors, const ResultDirectory& directory,
                                   BodyPipeline& pipeline) const {
    std::optional<ReadingWriter> found;  // in images; else they are in a table already
    if (source.finds_readings()) found.emplace(directory.path("readings.csv"), detectors, true);
    const auto show_progress = [&] { context.progress(progress_of(source, "tracking")); };
    std::optional<InputError> fault;
    try {
      while (const auto reading = source.next()) {
        if (context.stop.stop_requested() || (end_s_ && to_seconds(reading->time.time_since_epoch()) > *end_s_)) break;
        if (start_s_ && to_seconds(reading->time.time_since_epoch()) < *start_s_) continue;
        if (found) found->write(*reading);
        if (pipeline.add(*reading)) show_progress();
      }
    } catch (const InputError& error) {
      fault = error;
    }
    pipeline.finish();
    if (found) found->commit();
    show_progress();
    return fault;
  }

  LiveHello hello(const std::vector<RigidBody>& bodies) const {
    LiveHello hello{"track body", name_of_source(observations_), "of the readings", "T_world_body"};
    for (const RigidBody& body : bodies) hello.bodies.push_back(body.name);
    return hello;
  }

  BodyPipeline::LiveSink sink_of(LiveOutput& live) const {
    return [&live, source = name_of_source(observations_), detail = detail_of(track_)](
               const std::string& body, const BodyEstimate& e) { live.send(pose_message(source, body, e, detail)); };
  }

  static LiveEnd live_end(const BodyRun& run) {
    LiveEnd end{run.batches, 0, run.interrupted};
    for (const BodyTally& tally : run.tallies) end.tracked += tally.tracked;
    return end;
  }

  void tell(const RunContext& context, const BodyRun& run, const nlohmann::json& summary) const {
    context.publish(summary);
    if (!leaves_standard_output(stream_)) return;
    for (const std::string& line : table_lines(run)) context.tell(line);
    context.tell(fmt::format("written to {}", context.output.string()));
  }

  ExitCode answer(const RunContext& context, const BodyRun& run) const {
    if (run.has_answer()) return ExitCode::Success;
    context.warn(
        run.batches == 0
            ? fmt::format("{}: holds no reading", run.source)
            : fmt::format("{}: no pose is determined by the readings: are the detectors, the body and the unit "
                          "of the readings those of this recording?",
                          run.source));
    return ExitCode::NoAnswer;
  }

  std::string bodies_, detectors_, observations_, stream_;
  std::optional<double> start_s_, end_s_;
  BodyTrackOptions track_;
};

}  // namespace

Verb track_body_verb() {
  return {"track body", "where rigid bodies were, from line detectors that read their markers",
          "alidade track body body.csv detectors.yaml observations.csv -o track", OutputUse::Required,
          make_command<TrackBodyCommand>};
}

}  // namespace alidade
