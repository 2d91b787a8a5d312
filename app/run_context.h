// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/progress.h"

namespace alidade {

/// What every verb is given: how to tell the user, when to stop, and what the user typed.
struct RunContext {
  ProgressSink progress;                          ///< drawn as a bar, log lines or JSON, as the user chose
  std::function<void(const std::string&)> tell;   ///< one line of result on stdout (silent with --quiet)
  std::function<void(const std::string&)> warn;   ///< one line on stderr, "warning: " in front
  std::stop_token stop;                           ///< set by Ctrl-C and SIGTERM: keep what there is, return Interrupted
  unsigned seed = 1;                              ///< --seed
  std::vector<std::string> arguments;             ///< argv, for the report
};

}  // namespace alidade
