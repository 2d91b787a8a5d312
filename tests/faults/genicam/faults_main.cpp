// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/errors.h"
#include "tests/faults/genicam/fault_bench.h"
#include "tests/support/temporary_directory.h"

namespace alidade::test {
namespace {

struct Section {
  const char* name;
  const char* about;
  Figures (*figures)(const FaultBench&);
};

constexpr Section kSections[] = {
    {"kill", "the camera is killed and comes back", kill_figures},
    {"freeze", "the camera's program is stopped for 1 and 6 s", freeze_figures},
    {"stall", "the camera gives no frames for a while", stall_figures},
    {"busy", "another client has control", busy_figures},
    {"loss", "packets are lost", loss_figures},
    {"drop", "whole frames are lost", drop_figures},
    {"clock", "two cameras with clocks of their own, of which one dies", clock_figures},
    {"trigger", "software and hardware triggers", trigger_figures},
    {"format", "all pixel formats, odd regions, lines", format_figures},
};

std::string list_of_sections() {
  std::string list = "Sections:\n";
  for (const Section& section : kSections) list += std::string("  ") + section.name + ": " + section.about + "\n";
  return list;
}

int run(int argc, char** argv) {
  FaultBench bench{.camera_program = ALIDADE_GIGE_TEST_CAMERA, .folder = {}};
  std::vector<std::string> wanted;
  bool is_json = false;
  CLI::App app("Faults of GenICam cameras on loopback, against the live camera.", "genicam_faults");
  app.add_option("--section", wanted, "only these");
  app.add_option("--cycles", bench.cycles, "of kill and stall")->capture_default_str();
  app.add_option("--frames", bench.frames, "per share of packet loss")->capture_default_str();
  app.add_option("--loss", bench.losses, "shares of packets")->capture_default_str();
  app.add_option("--clocks", bench.clocks_s, "s, of comparing clocks")->capture_default_str();
  app.add_option("--address", bench.address, "of this machine, for the camera")->capture_default_str();
  app.add_option("--other-address", bench.other_address, "for a second camera")->capture_default_str();
  app.add_flag("--json", is_json, "one JSON object a line for each figure");
  app.footer(list_of_sections());
  CLI11_PARSE(app, argc, argv);
  const TemporaryDirectory folder;
  bench.folder = folder.path();
  bool is_all_met = true;
  for (const Section& section : kSections) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), section.name) == wanted.end()) continue;
    for (const Figure& figure : section.figures(bench)) {
      std::cout << (is_json ? to_json(figure) : to_text(figure)) << std::endl;
      is_all_met = is_all_met && figure.is_met();
    }
  }
  return is_all_met ? 0 : 1;
}

}  // namespace
}  // namespace alidade::test

int main(int argc, char** argv) {
  try {
    return alidade::test::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "genicam_faults: " << error.what() << '\n';
    return 3;
  }
}
