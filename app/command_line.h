// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/command.h"

namespace alidade {

/// The flags that every verb has.
struct SharedFlags {
  std::filesystem::path output;
  bool quiet = false;
  bool json = false;
  unsigned seed = 1;
  std::filesystem::path config;
};

/// What the user asked for.
struct Request {
  std::string verb;  ///< as typed: "track camera"
  SharedFlags flags;
  Command* command;
  OutputUse output;  ///< what flags.output is
};

/// The parser of the whole command line.
class CommandLine {
 public:
  explicit CommandLine(const std::vector<Verb>& verbs);

  /// Reads the flags and then --config into the chosen command, and checks its options. Empty after --help or --version
  /// (printed on stdout). Throws InputError: unknown verbs, flags and keys come with the nearest known name.
  std::optional<Request> parse(int argc, const char* const* argv);

 private:
  struct Entry {
    std::string name;
    CLI::App* app;
    std::unique_ptr<Command> command;
    OutputUse output;
  };

  CLI::App& parent_of(const std::string& verb_name);
  void add_shared_flags(CLI::App& app, OutputUse output);

  SharedFlags flags_;
  std::vector<Entry> entries_;  // before app_: the parser refers to the commands and must go first
  CLI::App app_;
};

}  // namespace alidade
