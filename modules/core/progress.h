// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace alidade {

/// How far a long piece of work has come. Modules report it; the app draws it as a bar, log lines or JSON.
struct Progress {
  std::string stage;       ///< what is being done, e.g. "tracking"
  std::int64_t done = 0;   ///< units finished
  std::int64_t total = 0;  ///< units in all; 0 where unknown (a live source)
  std::string message;     ///< one line worth telling the user, else empty
};

/// Called from the thread that does the work; an empty function is allowed.
using ProgressSink = std::function<void(const Progress&)>;

}  // namespace alidade
