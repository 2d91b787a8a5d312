// SPDX-License-Identifier: Apache-2.0
// Records a camera that is not there; see --help.
#include <iostream>

#include <CLI/CLI.hpp>

#include "capture/recording/recording_group.h"
#include "tests/capture/recording/synthetic_camera.h"

namespace {

using namespace alidade;

void record(const std::filesystem::path& folder, int frames, bool closed) {
  const RecordingSubject camera = test::synthetic_camera({PixelKind::Grey, 8}, {160, 120});
  RecordingWriter writer(folder, camera);
  for (int i = 0; i < frames; ++i) writer.write(test::synthetic_frame(camera, i));
  if (closed) writer.close();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Records a camera that is not there.");
  std::filesystem::path folder;
  std::vector<std::string> members;
  int frames = 10;
  bool unclosed = false;
  app.add_option("DIR", folder, "the recording")->required();
  app.add_option("--frames", frames, "how many");
  app.add_option("--member", members, "a camera each; DIR is then a group");
  app.add_flag("--unclosed", unclosed, "ends as if it were killed");
  CLI11_PARSE(app, argc, argv);
  try {
    if (members.empty()) record(folder, frames, !unclosed);
    for (const std::string& member : members) record(folder / member, frames, !unclosed);
    if (!members.empty()) write_recording_group(folder, "alidade test", members);
  } catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
    return 1;
  }
  return 0;
}
