// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/live_messages.h"
#include "app/live_output.h"
#include "app/reading_source.h"
#include "app/targets/placement_plan.h"
#include "app/targets/sky_source.h"
#include "app/targets/target_evaluation.h"
#include "app/targets/target_pipeline.h"
#include "app/targets/target_report.h"
#include "app/targets/video_sky.h"
#include "io/receiver_file.h"
#include "io/receiver_reading_file.h"

namespace alidade {
namespace {

class TrackTargetsCommand : public Command {
 public:
  explicit TrackTargetsCommand(CLI::App& flags) {
    flags
        .add_option("RECEIVERS", receivers_,
                    "receivers: our YAML, a rig of cameras, or a folder that holds observations or videos too")
        ->required();
    flags.add_option(
        "OBSERVATIONS", observations_,
        "CSV of pixels, or of azimuth and elevation, by each receiver's own clock; -: standard input; or a "
        "video (or live camera) of each receiver, in order");
    flags.add_option("--truth", truth_, "true paths, to draw beside the tracks: truth.csv of 'simulate targets'");
    flags.add_option("--stream", stream_, kStreamHelp);
    flags.add_flag("--cue", is_cueing_,
                   "cues.csv: where and when each receiver can see each target, as told at each time");
    flags.add_flag("--plan", is_plan_, "no observations: how well these receivers can locate a target, over a volume");
    bind(options_, track_);
    bind(options_, plan_);
  }

  ExitCode run(const RunContext& context) override {
    const std::vector<Receiver> receivers = read_receivers_of(receivers_);
    check(receivers);
    if (is_plan_) return plan(context, receivers);
    const std::vector<TargetRow> truth =
        truth_.empty() ? std::vector<TargetRow>() : read_target_rows(target_file_of(truth_));
    const std::vector<std::string> sources = sources_of(receivers);
    const std::string source = fmt::format("{}", fmt::join(sources, ", "));
    std::optional<LiveOutput> live;  // before standard input has said anything
    if (!stream_.empty()) live.emplace(context, stream_, hello_message(hello(source)));
    ResultDirectory directory(context.output, "track targets");
    std::optional<ReceiverReadingWriter> found_readings;  // in images; else they are in a table already
    if (shows_images(sources.front())) found_readings.emplace(directory.path("observations.csv"), receivers);
    const ReadingSink found = [&](const ReceiverReading& reading) { found_readings->write(reading); };
    const auto sky = found_readings ? open_videos(sources, receivers, found, context.stop)
                                    : open_table(sources, receivers, context.stop);
    const TargetTrackOptions track = settled(track_, sky->frame_interval_s(), receivers);
    TargetRecord record(directory, receivers);
    const auto begin = std::chrono::steady_clock::now();
    std::optional<CueFileWriter> cues;
    if (is_cueing_) cues.emplace(directory.path("cues.csv"));
    TargetPipeline pipeline(track, record, live ? sink_of(*live, source) : TargetPipeline::LiveSink(),
                            cue_sink(cues ? &*cues : nullptr, live ? &*live : nullptr));
    const std::optional<InputError> fault = follow(context, *sky, pipeline);
    if (fault && record.run().targets.empty()) throw *fault;

    if (found_readings) found_readings->commit();
    if (cues) cues->commit();
    TargetRun run = record.commit();
    run.tracking_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    run.source = name_of_source(source);
    run.method = describe(track_);
    run.without_direction = sky->without_direction();
    run.interrupted = context.stop.stop_requested();
    if (fault) run.fault = fault->what();
    run.warnings = sky->losses();
    add_warnings(pipeline, run);
    if (live) live->end(end_message({run.bearings, static_cast<std::int64_t>(run.targets.size()), run.interrupted}));
    const std::vector<Receiver>& operated = pipeline.receivers_in_operation();
    write_receivers(directory.path("receivers.yaml"), operated.empty() ? receivers : operated);
    conclude(context, run, truth, directory);
    if (fault) throw *fault;
    return run.interrupted ? ExitCode::Interrupted : answer(context, run);
  }

 private:
  std::vector<std::string> sources_of(const std::vector<Receiver>& receivers) const {
    if (!observations_.empty()) return observations_;
    const std::vector<std::string> videos = videos_in(receivers_, receivers);
    return videos.empty() ? std::vector<std::string>{receivers_} : videos;
  }

  void check(const std::vector<Receiver>& receivers) const {
    const std::size_t least = track_.method == TargetMethod::PaperProposed ? 3 : 2;
    if (receivers.size() >= least) return;
    throw InputError(
        receivers_, 0,
        fmt::format("holds {} receiver{}, wanted are {}", receivers.size(), receivers.size() == 1 ? "" : "s", least),
        "a place in space takes lines of sight from two places; add a receiver");
  }

  static std::unique_ptr<SkySource> open_table(const std::vector<std::string>& sources,
                                               const std::vector<Receiver>& receivers, const std::stop_token& stop) {
    if (sources.size() == 1) return open_sky(sources.front(), receivers, stop);
    throw InputError(sources[1], 0, "one table of observations is wanted", "put all receivers' rows into one file");
  }

  ExitCode plan(const RunContext& context, const std::vector<Receiver>& receivers) const {
    const PlacementMap map = map_placement(receivers, placement_of(plan_));
    ResultDirectory directory(context.output, "track targets");
    write_plan(map, receivers, directory, context.arguments, options_.to_yaml());
    const nlohmann::json summary = summary_of(map);
    directory.commit(summary);
    context.publish(summary);
    context.tell(summary.contains("median_rms_m")
                     ? fmt::format("bound of a position: median {:.3g} m, best {:.3g} m, worst {:.3g} m",
                                   summary["median_rms_m"].get<double>(), summary["best_rms_m"].get<double>(),
                                   summary["worst_rms_m"].get<double>())
                     : "a target is located nowhere in the volume");
    context.tell(fmt::format("written to {}", context.output.string()));
    return summary.contains("median_rms_m") ? ExitCode::Success : ExitCode::NoAnswer;
  }

  // Until the observations end, the user stops it, or a line is wrong: what was wrong, then.
  std::optional<InputError> follow(const RunContext& context, SkySource& sky, TargetPipeline& pipeline) const {
    constexpr int kBearingsPerReport = 500;
    std::optional<InputError> fault;
    try {
      for (int i = 1;; ++i) {
        const auto bearing = sky.next();
        if (!bearing) break;
        pipeline.add(*bearing);
        if (i % kBearingsPerReport == 0) context.progress(sky.progress());
      }
    } catch (const InputError& error) {
      fault = error;
    }
    pipeline.finish();
    context.progress(sky.progress());
    return fault;
  }

  LiveHello hello(const std::string& source) const {
    return {"track targets", name_of_source(source), "common to the receivers", "p_world_m"};
  }

  static TargetPipeline::LiveSink sink_of(LiveOutput& live, const std::string& source) {
    return [&live, source = name_of_source(source)](Timestamp, const std::vector<TargetEstimate>& targets) {
      for (const TargetEstimate& target : targets) live.send(target_message(source, row_of(target)));
    };
  }

  static TargetPipeline::CueSink cue_sink(CueFileWriter* file, LiveOutput* live) {
    if (!file) return {};
    return [file, live](const AddressedCue& cue) {
      file->write(cue);
      if (live) live->send(cue_message(cue));
    };
  }

  void add_warnings(const TargetPipeline& pipeline, TargetRun& run) const {
    if (run.without_direction > 0) {
      run.warnings.push_back(fmt::format("{} readings left out: their pixels have no direction by the lens's model",
                                         run.without_direction));
    }
    if (pipeline.left_out() > 0) {
      run.warnings.push_back(fmt::format("{} bearings came more than {} s late and were left out; see --lag-s",
                                         pipeline.left_out(), track_.ours.lag_s));
    }
  }

  void conclude(const RunContext& context, TargetRun& run, std::span<const TargetRow> truth,
                ResultDirectory& directory) const {
    write_target_report(run, truth, directory, context.arguments, options_.to_yaml());
    for (const std::string& warning : run.warnings) context.warn(warning);
    const nlohmann::json summary = summary_of(run);
    directory.commit(summary);
    tell(context, run, summary);
  }

  void tell(const RunContext& context, const TargetRun& run, const nlohmann::json& summary) const {
    context.publish(summary);
    if (!leaves_standard_output(stream_)) return;
    for (const std::string& line : table_lines(run)) context.tell(line);
    context.tell(fmt::format("written to {}", context.output.string()));
  }

  static ExitCode answer(const RunContext& context, const TargetRun& run) {
    if (!run.targets.empty()) return ExitCode::Success;
    context.warn(run.bearings == 0
                     ? fmt::format("{}: holds no bearing: nothing was seen, or it is another file", run.source)
                     : fmt::format("{}: no target was found: do lines of sight of two receivers cross at an angle, are "
                                   "poses, clocks and the period those of this recording?",
                                   run.source));
    return ExitCode::NoAnswer;
  }

  std::string receivers_, truth_, stream_;
  std::vector<std::string> observations_;
  bool is_cueing_ = false, is_plan_ = false;
  TargetTrackOptions track_;
  PlanOptions plan_;
};

}  // namespace

Verb track_targets_verb() {
  return {"track targets", "where flying objects were, from receivers that look at different times",
          "alidade track targets receivers.yaml observations.csv -o track\n"
          "alidade track targets rig.yaml cam0.mp4 cam1.mp4 -o track\n"
          "alidade track targets flight/ --truth flight/truth.csv --method paper-proposed -o paper\n"
          "alidade track targets receivers.yaml --plan --plan-greatest-m 200,200,100 -o plan",
          OutputUse::Required, make_command<TrackTargetsCommand>};
}

}  // namespace alidade
