// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/genicam_listing.h"

#include <arv.h>
#include <fmt/format.h>

#include "capture/genicam/camera_features.h"
#include "capture/genicam/camera_opening.h"
#include "capture/genicam/gvcp.h"
#include "capture/genicam/pfnc_format.h"

namespace alidade {
namespace {

using SizeBounds = void (*)(ArvCamera*, gint*, gint*, GError**);

std::pair<int, int> bounds_of(ArvCamera* camera, SizeBounds get) {
  std::pair<int, int> bounds;
  get(camera, &bounds.first, &bounds.second, AravisFault().out());
  return bounds;
}

ListedSize size_range(ArvCamera* camera) {
  const auto [least_width, most_width] = bounds_of(camera, arv_camera_get_width_bounds);
  const auto [least_height, most_height] = bounds_of(camera, arv_camera_get_height_bounds);
  ListedSize size;
  size.size = {most_width, most_height};
  if (least_width != most_width || least_height != most_height) size.least = cv::Size(least_width, least_height);
  AravisFault fault;
  double slowest = 0, fastest = 0;
  arv_camera_get_frame_rate_bounds(camera, &slowest, &fastest, fault.out());
  if (!fault.happened() && fastest > 0) size.fps_hz = {fastest, slowest};
  return size;
}

std::string text_or_empty(const char* text) {
  return text ? text : "";
}

ListedCamera describe(ArvCamera* camera) {
  ArvDevice* const device = arv_camera_get_device(camera);
  ListedCamera listed;
  listed.model = fmt::format("{} {}", text_or_empty(arv_camera_get_vendor_name(camera, AravisFault().out())),
                             text_or_empty(arv_camera_get_model_name(camera, AravisFault().out())));
  listed.serial = text_or_empty(arv_camera_get_device_serial_number(camera, AravisFault().out()));
  for (const auto& name : enumeration_choices(device, "PixelFormat")) {
    listed.formats.push_back({name, "", pfnc_format(name).has_value(), {size_range(camera)}});
  }
  for (const auto& name : feature_names(device)) {
    if (has_feature(device, name)) listed.controls.push_back(describe_feature(device, name));
  }
  return listed;
}

// What can be said without control of the camera: it answers whoever asks who is there.
ListedCamera identity_at(const std::string& address) {
  ListedCamera listed;
  if (const auto identity = ask_gige_camera(address, std::chrono::milliseconds(600))) {
    listed.model = fmt::format("{} {}", identity->maker, identity->model);
    listed.serial = identity->serial;
  }
  return listed;
}

std::string driver_of(bool is_gige) {
  return is_gige ? "GigE Vision" : "USB3 Vision";
}

ListedCamera try_to_describe(const std::string& id) {
  const std::string source = "genicam:" + id;
  ListedCamera listed;
  try {
    const OpenedCamera opened = open_camera(id, source);
    listed = describe(opened.camera.get());
    listed.driver = driver_of(!opened.address.empty());
  } catch (const CameraError& error) {
    if (error.trouble() != CameraTrouble::Busy) throw;
    listed = identity_at(address_of(id));
    listed.driver = driver_of(true);
    listed.trouble = "in use";
  }
  listed.source = source;
  return listed;
}

// A camera of Aravis' list, by the name to open it with and the ones that last.
struct Found {
  std::string id, address, device_id, serial;
};

std::vector<Found> find_cameras() {
  silence_aravis();
  arv_update_device_list();
  std::vector<Found> found;
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    const bool is_gige = text_or_empty(arv_get_device_protocol(i)) == "GigEVision";
    Found camera{"", is_gige ? text_or_empty(arv_get_device_address(i)) : "", text_or_empty(arv_get_device_id(i)),
                 text_or_empty(arv_get_device_serial_nbr(i))};
    camera.id = is_gige ? camera.address : camera.device_id;
    found.push_back(camera);
  }
  return found;
}

}  // namespace

std::vector<ListedCamera> list_genicam() {
  std::vector<ListedCamera> cameras;
  for (const Found& found : find_cameras()) {
    ListedCamera listed;
    try {
      listed = try_to_describe(found.id);
    } catch (const CameraError& error) {
      listed.source = "genicam:" + found.id;
      listed.serial = found.serial;
      listed.trouble = error.what();
    }
    for (const std::string& name : {found.serial, found.device_id}) {
      if (!name.empty() && name != found.id) listed.aliases.push_back("genicam:" + name);
    }
    cameras.push_back(std::move(listed));
  }
  return cameras;
}

ListedCamera describe_genicam(const std::string& id) {
  return try_to_describe(id);
}

}  // namespace alidade
