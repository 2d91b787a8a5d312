// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tests/faults/genicam/fault_bench.h"
#include "tests/faults/genicam/live_capture.h"
#include "tests/faults/genicam/tally.h"

namespace alidade::test {
namespace {

using std::chrono::milliseconds;

constexpr double kFps = 100;

struct Run {
  Tally tally;
  std::string sent;  // as the camera counted packets
};

Run run_for(const FaultBench& bench, const std::vector<std::string>& faults) {
  auto camera = bench.start_camera(bench.address, faults);
  LiveCapture capture(bench.address, small_request(kFps));
  const auto expected = milliseconds(static_cast<int>(1000 * bench.frames / kFps));
  capture.wait_for_count(static_cast<std::size_t>(bench.frames), 2 * expected + milliseconds(5000));
  capture.stop();
  const std::string sent = camera->end();
  return {tally_of(capture.frames(), read_camera_log(bench.log_of(bench.address))), sent};
}

// What holds whatever is lost.
Figures honesty_figures(const std::string& when, const Tally& tally) {
  return {{"loss", "frames not told of" + when, static_cast<double>(tally.unexplained()), "", 0, 0},
          {"loss",
           "wrong frames shown as good" + when,
           static_cast<double>(tally.wrong),
           "",
           {},
           0,
           fmt::format("{} good, {} damaged, {} dropped", tally.good, tally.damaged, tally.counted)}};
}

void append(Figures& figures, const Figures& more) {
  figures.insert(figures.end(), more.begin(), more.end());
}

// Up to 1 % of packets lost, 99.9 % of the frames must come whole; up to 2 %, 99 %.
double least_complete(double loss) {
  return loss <= 0.01 ? 99.9 : 99;
}

}  // namespace

Figures loss_figures(const FaultBench& bench) {
  Figures figures;
  for (const double loss : bench.losses) {
    const auto [tally, sent] = run_for(bench, {"--loss", fmt::format("{}", loss), "--kept-frames", "64"});
    const std::string at = fmt::format(" at {:g} % of packets lost", 100 * loss);
    const double complete = 100.0 * tally.good / std::max(tally.exposed, 1);
    figures.push_back({"loss",
                       "complete frames" + at,
                       complete,
                       "%",
                       least_complete(loss),
                       {},
                       fmt::format("{} of {}, {} damaged, {} dropped; packets {}", tally.good, tally.exposed,
                                   tally.damaged, tally.counted, sent)});
    append(figures, honesty_figures(at, tally));
  }
  // A camera that sends nothing again, and one that takes its time.
  append(figures, honesty_figures(" without resends", run_for(bench, {"--loss", "0.01", "--kept-frames", "0"}).tally));
  append(figures,
         honesty_figures(" with slow resends", run_for(bench, {"--loss", "0.01", "--resend-delay", "25"}).tally));
  return figures;
}

Figures drop_figures(const FaultBench& bench) {
  const auto figures_of = [](const std::string& when, const Tally& tally) {
    const double difference = tally.counted - tally.never_sent;
    return Figures{{"drop", "frames counted as dropped less those never sent" + when, difference, "", 0, 0,
                    fmt::format("{} of {}", tally.never_sent, tally.exposed)},
                   {"drop", "wrong frames shown as good" + when, static_cast<double>(tally.wrong), "", {}, 0}};
  };
  Figures figures = figures_of("", run_for(bench, {"--drop", "0.1"}).tally);
  // The frame ids wrap from 65535 to 1 on the way.
  append(figures, figures_of(" as ids wrap", run_for(bench, {"--drop", "0.1", "--first-frame-id", "65450"}).tally));
  return figures;
}

}  // namespace alidade::test
