// SPDX-License-Identifier: Apache-2.0
#include "app/command_line.h"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/version.h"
#include "core/errors.h"
#include "core/nearest_name.h"

namespace alidade {
namespace {

std::vector<std::string> flag_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string_view> views(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands(nullptr)) names.push_back(verb->get_name());
  return names;
}

// "alidade track camera"
std::string full_name(const CLI::App& app) {
  return app.get_parent() ? fmt::format("{} {}", full_name(*app.get_parent()), app.get_name()) : app.get_name();
}

const CLI::App& deepest_parsed(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : deepest_parsed(*parsed.front());
}

// CLI11's exceptions say what is wrong, seldom what would be right.
InputError explain(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& asked = deepest_parsed(app);
  const std::string name = full_name(asked);
  const std::string help = fmt::format("see '{} --help'", name);
  const std::vector<std::string> verbs = verb_names(asked);
  const std::vector<std::string> rest = app.remaining(/*recurse=*/true);
  const auto is_flag = [](const std::string& word) { return word.size() > 1 && word.front() == '-'; };
  const auto flag = std::find_if(rest.begin(), rest.end(), is_flag);
  if (!verbs.empty() && !rest.empty() && !is_flag(rest.front()))
    return {name, 0, fmt::format("unknown verb '{}'", rest.front()), suggest_name(rest.front(), views(verbs))};
  if (flag != rest.end()) {
    const std::string typed = flag->substr(0, flag->find('='));
    const std::vector<std::string> flags = flag_names(asked);
    const auto nearest = nearest_name(typed, views(flags));
    return {name, 0, fmt::format("unknown flag '{}'", typed),
            nearest ? fmt::format("did you mean '{}'?", *nearest) : help};
  }
  if (!verbs.empty()) return {name, 0, "a verb is missing", fmt::format("one of: {}", fmt::join(verbs, ", "))};
  std::string what = error.what();
  std::replace(what.begin(), what.end(), '\n', ' ');
  return {name, 0, what, help};
}

}  // namespace

CommandLine::CommandLine(const std::vector<Verb>& verbs)
    : app_("Alidade turns lines of sight into motion: of cameras, rigid bodies and flying objects.", "alidade") {
  app_.require_subcommand(1);
  app_.set_version_flag("--version", std::string("alidade ") + kVersion);
  app_.footer("Each verb explains itself: alidade VERB --help");
  for (const Verb& verb : verbs) {
    const std::string last_word = verb.name.substr(verb.name.rfind(' ') + 1);
    CLI::App& app = *parent_of(verb.name).add_subcommand(last_word, verb.summary);
    app.footer("Example:\n  " + verb.example);
    add_shared_flags(app, verb.output);
    auto command = verb.make(app);
    command->options().add_flags(app);
    // Not a flag of its own: --seed is one of the shared flags already, but options.yaml must hold it to be complete.
    command->options().add("seed", flags_.seed, "", "seed of all random choices");
    entries_.push_back({verb.name, &app, std::move(command), verb.output});
  }
}

CLI::App& CommandLine::parent_of(const std::string& verb_name) {
  const auto space = verb_name.find(' ');
  if (space == std::string::npos) return app_;
  const std::string group = verb_name.substr(0, space);
  for (CLI::App* known : app_.get_subcommands(nullptr))
    if (known->get_name() == group) return *known;
  CLI::App& parent = *app_.add_subcommand(group, fmt::format("what to {}: see 'alidade {} --help'", group, group));
  parent.require_subcommand(1);
  return parent;
}

void CommandLine::add_shared_flags(CLI::App& app, OutputUse output) {
  const std::string group = "Flags of every verb";
  app.set_version_flag("--version", std::string("alidade ") + kVersion)->group(group);
  const bool is_file = output == OutputUse::File;
  CLI::Option* out =
      app.add_option("-o,--output", flags_.output, is_file ? "the file to write" : "directory of the results");
  out->type_name(is_file ? "FILE" : "DIR")->group(group)->required(output != OutputUse::Optional);
  CLI::Option* quiet = app.add_flag("--quiet", flags_.quiet, "print warnings and errors only")->group(group);
  CLI::Option* json = app.add_flag("--json", flags_.json, "print progress and result as JSON lines")->group(group);
  json->excludes(quiet);
  app.add_option("--seed", flags_.seed, "seed of all random choices")
      ->type_name("N")
      ->capture_default_str()
      ->group(group);
  app.add_option("--config", flags_.config, "YAML file of options, such as an earlier options.yaml")
      ->type_name("FILE")
      ->group(group);
}

std::optional<Request> CommandLine::parse(int argc, const char* const* argv) {
  try {
    app_.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    app_.exit(success);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw explain(app_, error);
  }
  const auto chosen =
      std::find_if(entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.app->parsed(); });
  OptionFields& options = chosen->command->options();
  const unsigned flagged_seed = flags_.seed;
  if (!flags_.config.empty()) options.read(flags_.config);
  if (chosen->app->get_option("--seed")->count() > 0) flags_.seed = flagged_seed;
  options.validate(flags_.config.empty() ? "options" : flags_.config.string());
  return Request{chosen->name, flags_, chosen->command.get(), chosen->output};
}

}  // namespace alidade
