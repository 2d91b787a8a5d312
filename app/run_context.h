// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/errors.h"
#include "core/progress.h"

namespace alidade {

/// What every verb is given: where results go, how to tell the user, when to stop, and what the user typed.
struct RunContext {
  std::filesystem::path output;                  ///< -o; empty where the verb does not need it and none was given
  unsigned seed = 1;                             ///< --seed
  std::stop_token stop;                          ///< set by Ctrl-C and SIGTERM: keep what there is, return Interrupted
  ProgressSink progress;                         ///< drawn as a bar, log lines or JSON, as the user chose
  std::function<void(const std::string&)> tell;  ///< a line of result on stdout (none with --quiet)
  std::function<void(const std::string&)> warn;  ///< one line on stderr, "warning: " in front
  std::function<void(const nlohmann::json&)> publish;  ///< the result as one JSON line on stdout (only with --json)
  std::function<void(const nlohmann::json&)> stream;   ///< one JSON line on stdout at once, however the user is told
  bool prints_json = false;                            ///< --json: standard output holds events alone
  std::vector<std::string> arguments;                  ///< argv, for the report
};

}  // namespace alidade
