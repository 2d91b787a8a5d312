// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <thread>

#include <nlohmann/json_fwd.hpp>

#include "app/run_context.h"
#include "io/line_feed.h"

namespace alidade {

/// What --stream says in --help.
inline constexpr const char* kStreamHelp =
    "poses as JSON lines, as soon as they are known: tcp://ADDR:PORT (readers connect; :PORT is this machine alone), "
    "udp://ADDR:PORT, or - for standard output, where nothing else goes then";

/// Messages of a run, one JSON object per line, to whoever reads them (app/live_messages.h says what is in them). Never
/// waits for a reader: see LineFeed.
class LiveOutput {
 public:
  /// `address` as parse_feed_address takes it; `hello` greets every reader. Tells the user where readers may connect.
  /// Throws InputError for a bad address and for standard output that --json takes already, DeviceError for an address
  /// that cannot be had.
  LiveOutput(const RunContext& context, const std::string& address, const nlohmann::ordered_json& hello);
  ~LiveOutput();
  LiveOutput(const LiveOutput&) = delete;
  LiveOutput& operator=(const LiveOutput&) = delete;

  /// Sends it with sent_ns, the host's clock now; returns that moment.
  std::chrono::steady_clock::time_point send(nlohmann::ordered_json message);

  /// The last message; then waits a second at most until the readers have it. What became of them.
  FeedTally end(nlohmann::ordered_json message);

 private:
  void finish();

  LineFeed feed_;
  std::jthread server_;
};

/// Whether lines for the user may still go to standard output.
bool leaves_standard_output(const std::string& stream_address);

}  // namespace alidade
