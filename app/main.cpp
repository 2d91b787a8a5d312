// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "app/command_line.h"
#include "app/commands/verbs.h"
#include "app/interruption.h"
#include "app/progress_display.h"
#include "app/result_directory.h"
#include "core/errors.h"

namespace alidade {
namespace {

ExitCode run(int argc, char** argv) {
  CommandLine command_line(all_verbs());
  const std::optional<Request> request = command_line.parse(argc, argv);
  if (!request) return ExitCode::Success;
  const bool wants_directory = request->output != OutputUse::File && !request->flags.output.empty();
  if (wants_directory) check_result_directory(request->flags.output);
  const Interruption interruption;  // before any other thread
  ProgressDisplay display(choose_style(request->flags.quiet, request->flags.json), std::cout, std::cerr,
                          terminal_columns());
  const RunContext context{
      .output = request->flags.output,
      .seed = request->flags.seed,
      .stop = interruption.token(),
      .progress = [&display](const Progress& progress) { display.show(progress); },
      .tell = [&display](const std::string& line) { display.tell(line); },
      .warn = [&display](const std::string& line) { display.warn(line); },
      .publish = [&display](const nlohmann::json& result) { display.publish(result); },
      .stream = [&display](const nlohmann::json& event) { display.stream(event); },
      .prints_json = request->flags.json,
      .arguments = {argv, argv + argc},
  };
  const ExitCode code = request->command->run(context);
  if (!std::cout.flush()) throw DeviceError("standard output", "write", "not all results could be written", "");
  return code;
}

int exit_with(ExitCode code, const std::string& line) {
  std::cerr << line << '\n';
  return static_cast<int>(code);
}

// A fault without a better name: nothing that the user did.
int exit_with_bug(const std::exception& error) {
  return exit_with(ExitCode::Bug,
                   fmt::format("alidade: internal fault: {}; please report it with the command line", error.what()));
}

}  // namespace
}  // namespace alidade

int main(int argc, char** argv) {
  using alidade::ExitCode;
  try {
    return static_cast<int>(alidade::run(argc, argv));
  } catch (const alidade::InputError& error) {
    return alidade::exit_with(ExitCode::BadInput, error.what());
  } catch (const alidade::DeviceError& error) {
    return alidade::exit_with(ExitCode::DeviceFault, error.what());
  } catch (const std::system_error& error) {  // a full disk, no permission, no more threads
    return alidade::exit_with(ExitCode::DeviceFault, fmt::format("alidade: {}", error.what()));
  } catch (const std::bad_alloc&) {
    return alidade::exit_with(ExitCode::DeviceFault, "alidade: out of memory; give it fewer or smaller images");
  } catch (const std::exception& error) {
    return alidade::exit_with_bug(error);
  }
}
