// SPDX-License-Identifier: Apache-2.0
#include "app/listed_cameras.h"

#include <algorithm>
#include <utility>

#include "app/frame_sources.h"
#include "capture/genicam/genicam_listing.h"
#include "capture/v4l2/v4l2_camera.h"
#include "capture/v4l2/v4l2_listing.h"
#include "core/errors.h"

namespace alidade {
namespace {

bool is_named(const ListedCamera& camera, const std::string& source) {
  return camera.source == source ||
         std::find(camera.aliases.begin(), camera.aliases.end(), source) != camera.aliases.end();
}

ListedCamera describe_camera(const std::string& source) {
  camera_opener(source, {});  // refuses what is no camera's name
  constexpr std::string_view genicam = "genicam:";
  if (source.starts_with(genicam)) return describe_genicam(source.substr(genicam.size()));
  for (ListedCamera& camera : list_v4l2()) {
    if (is_named(camera, source)) return std::move(camera);
  }
  open_v4l2(source.substr(source.find(':') + 1), {});  // says what is wrong with it
  throw CameraError(CameraTrouble::Refused, source, "cannot be listed", "the system does not count it as a camera",
                    "name it by its file in /dev");
}

}  // namespace

std::vector<ListedCamera> list_cameras() {
  std::vector<ListedCamera> cameras = list_v4l2();
  for (ListedCamera& camera : list_genicam()) cameras.push_back(std::move(camera));
  return cameras;
}

std::vector<ListedCamera> describe_cameras(const std::vector<std::string>& sources) {
  std::vector<ListedCamera> cameras;
  for (const std::string& source : sources) cameras.push_back(describe_camera(source));
  return cameras;
}

}  // namespace alidade
