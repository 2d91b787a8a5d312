// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "view/scene.h"

namespace alidade {

/// A result directory as it is drawn, and what could not be drawn of it.
struct ResultPicture {
  TrackPicture picture;
  std::vector<std::string> warnings;
};

/// Reads what there is to see in a result: trajectory.tum, map.ply, camera.yaml and truth.tum, each where it is there
/// (a simulated sequence has only a truth); or a trajectory file alone. `truth`, where not empty, is a trajectory file
/// or folder to show instead of truth.tum. It is brought into the frame of the estimate by the similarity between poses
/// near in time; where that is not determined it is left out, with a warning.
/// Throws InputError where there is nothing to see or a file is damaged.
ResultPicture read_result_picture(const std::filesystem::path& result, const std::filesystem::path& truth);

}  // namespace alidade
