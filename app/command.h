// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "app/run_context.h"

namespace alidade {

/// The work of a verb once its flags are parsed; throws InputError and DeviceError, which main turns into one line.
using Command = std::function<ExitCode(const RunContext&)>;

/// Where a verb leaves its work when CLI11 calls its callback; main runs it.
using CommandSlot = std::function<void(Command)>;

// One per file in app/commands: adds the verb, its flags and its example to the parser.
void add_evaluate(CLI::App& app, const CommandSlot& chosen);

}  // namespace alidade
