// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_result.h"

#include <vector>

#include "app/targets/target_picture.h"
#include "io/receiver_file.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTracks = "tracks.csv";
constexpr const char* kTruth = "truth.csv";
constexpr const char* kReceivers = "receivers.yaml";

}  // namespace

bool is_target_result(const fs::path& result) {
  return fs::exists(result / kTracks) || (fs::exists(result / kTruth) && fs::exists(result / kReceivers));
}

Scene read_target_scene(const fs::path& result, const fs::path& truth) {
  TargetRun run;
  if (fs::exists(result / kReceivers)) run.receivers = read_receivers(result / kReceivers);
  if (fs::exists(result / kTracks)) {
    for (const TargetRow& row : read_target_rows(result / kTracks)) run.targets[row.target].add(row);
  }
  const fs::path true_paths = truth.empty() ? result / kTruth : truth;
  const bool has_truth = !truth.empty() || fs::exists(true_paths);
  return scene_of(run, has_truth ? read_target_rows(true_paths) : std::vector<TargetRow>());
}

}  // namespace alidade
