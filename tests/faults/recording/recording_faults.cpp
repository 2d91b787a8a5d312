// SPDX-License-Identifier: Apache-2.0
// What becomes of recordings when the program is killed or the disk is full; see --help.
#include <iostream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tests/faults/recording/fault_trials.h"
#include "tests/support/temporary_directory.h"

int main(int argc, char** argv) {
  CLI::App app("Records a synthetic camera, kills the recorder or fills its disk, and counts what is left.");
  std::vector<std::string> sections{"kill", "full-disk", "exact"};
  int count = 50;
  unsigned seed = 1;
  bool json = false;
  app.add_option("--section", sections, "kill, full-disk (needs root), exact; default: all")
      ->check(CLI::IsMember({"kill", "full-disk", "exact"}));
  app.add_option("--count", count, "recordings that are killed, disks that are filled")->check(CLI::PositiveNumber);
  app.add_option("--seed", seed, "of the moments and the disks' sizes");
  app.add_flag("--json", json, "one object a line");
  CLI11_PARSE(app, argc, argv);
  const alidade::test::TemporaryDirectory folder;
  for (const std::string& section : sections) {
    const nlohmann::json result = section == "kill"    ? alidade::test::kill_trials(folder.path(), count, seed)
                                  : section == "exact" ? alidade::test::exactness_trials(folder.path())
                                                       : alidade::test::full_disk_trials(folder.path(), count, seed);
    std::cout << result.dump(json ? -1 : 2) << std::endl;
  }
  return 0;
}
