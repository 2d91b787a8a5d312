// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "app/options_yaml.h"
#include "app/run_context.h"

namespace alidade {

/// The work of one verb. Its constructor takes the verb's parser, adds positionals and flags whose values are members,
/// and binds its option structs to `options_` (each becomes a flag and a key of --config). The shell adds the flags
/// that all verbs share, parses, and calls run.
class Command {
 public:
  virtual ~Command() = default;

  /// Throws InputError and DeviceError, which main turns into one line.
  virtual ExitCode run(const RunContext& context) = 0;

  OptionFields& options() { return options_; }

 protected:
  OptionFields options_;
};

/// What a verb wants of -o.
enum class OutputUse {
  Required,  ///< a directory
  Optional,  ///< a directory, or none
  File,      ///< the one file that it writes
};

/// How a verb stands on the command line.
struct Verb {
  std::string name;     ///< as typed: "evaluate", "track camera"
  std::string summary;  ///< one line for --help
  std::string example;  ///< one line or more that works as typed: "alidade evaluate estimate.tum truth.tum"
  OutputUse output = OutputUse::Required;
  std::unique_ptr<Command> (*make)(CLI::App& flags) = nullptr;  ///< make_command<C>
};

template <class C>
std::unique_ptr<Command> make_command(CLI::App& flags) {
  return std::make_unique<C>(flags);
}

}  // namespace alidade
