// SPDX-License-Identifier: Apache-2.0
#include "io/receiver_file.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/camera_yaml.h"
#include "io/pose_yaml.h"
#include "io/rig_file.h"
#include "io/text_lines.h"
#include "io/yaml_nodes.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

constexpr const char* kExample = "{id: 0, model: direction_finder, T_world_receiver: {...}, clock: common}";
constexpr std::array<std::string_view, 8> kReceiverKeys{
    "id", "name", "model", "sigma_rad", "sigma_px", "T_world_receiver", "pose_covariance", "clock"};
constexpr std::array<std::string_view, 4> kCameraKeys{"resolution_px", "intrinsics_px", "distortion", "readout_s"};

ReceiverClock read_clock(const Path& path, const YAML::Node& node) {
  ReceiverClock clock;
  if (node.IsScalar() && node.Scalar() == "common") return clock;
  require_yaml_map(path, node, "clock: common, or clock: {offset_s: 0.2, rate: 1e-5}");
  constexpr std::array<std::string_view, 4> kKeys{"offset_s", "rate", "reference_s", "covariance"};
  refuse_unknown_keys(path, node, kKeys);
  clock.offset_s = yaml_number(path, yaml_value(path, node, "offset_s", "the clock"));
  if (const YAML::Node rate = node["rate"]) clock.rate = yaml_number(path, rate);
  if (const YAML::Node reference = node["reference_s"]) {
    clock.reference = Timestamp(from_seconds(yaml_number(path, reference)));
  }
  if (const YAML::Node covariance = node["covariance"]) clock.covariance = read_covariance(path, covariance, 2);
  return clock;
}

// The camera's part of the map, as read_camera_node takes it.
Camera read_camera_part(const Path& path, const YAML::Node& node, std::size_t index) {
  YAML::Node part(YAML::NodeType::Map);
  for (const auto& entry : node) {
    const std::string key = entry.first.Scalar();
    const bool is_camera = std::find(kCameraKeys.begin(), kCameraKeys.end(), key) != kCameraKeys.end();
    if (is_camera || key == "name" || key == "model") part[key] = entry.second;
  }
  return read_camera_node(path, part, index).camera;
}

Receiver read_finder(const Path& path, const YAML::Node& node) {
  std::vector<std::string_view> keys(kReceiverKeys.begin(), kReceiverKeys.end());
  keys.push_back("axes");
  refuse_unknown_keys(path, node, keys);
  if (node["sigma_px"]) {
    throw InputError(path, yaml_line(node["sigma_px"]), "a direction finder reads angles", "write sigma_rad");
  }
  Receiver receiver;
  receiver.sigma = yaml_number(path, yaml_value(path, node, "sigma_rad", "the direction finder"));
  if (const YAML::Node axes = node["axes"]) {
    constexpr std::array<std::string_view, 2> kAxes{"y_down", "y_up"};
    receiver.axes = yaml_choice(path, axes, "axes", kAxes) == "y_up" ? FinderAxes::YUp : FinderAxes::YDown;
  }
  return receiver;
}

Receiver read_sky_camera(const Path& path, const YAML::Node& node, std::size_t index) {
  std::vector<std::string_view> keys(kReceiverKeys.begin(), kReceiverKeys.end());
  keys.insert(keys.end(), kCameraKeys.begin(), kCameraKeys.end());
  refuse_unknown_keys(path, node, keys);
  if (node["sigma_rad"]) {
    throw InputError(path, yaml_line(node["sigma_rad"]), "a camera reads pixels", "write sigma_px");
  }
  Receiver receiver;
  receiver.camera = read_camera_part(path, node, index);
  if (const YAML::Node sigma = node["sigma_px"]) receiver.sigma = yaml_number(path, sigma);
  return receiver;
}

Receiver read_receiver(const Path& path, const YAML::Node& node, std::size_t index) {
  require_yaml_map(path, node, kExample);
  const YAML::Node model = yaml_value(path, node, "model", "the receiver");
  constexpr std::array<std::string_view, 4> kModels{"direction_finder", "pinhole", "brown_conrady", "fisheye"};
  const bool is_finder = yaml_choice(path, model, "receiver model", kModels) == "direction_finder";
  Receiver receiver = is_finder ? read_finder(path, node) : read_sky_camera(path, node, index);
  receiver.id = yaml_integer(path, yaml_value(path, node, "id", "the receiver"));
  receiver.name = node["name"] ? yaml_text(path, node["name"]) : fmt::format("receiver {}", receiver.id);
  receiver.T_world_receiver = read_pose(path, yaml_value(path, node, "T_world_receiver", "the receiver"));
  if (const YAML::Node covariance = node["pose_covariance"]) {
    receiver.pose_covariance = read_covariance(path, covariance, 6);
  }
  if (!node["clock"]) {
    throw InputError(path, yaml_line(node), fmt::format("receiver '{}' has no clock", receiver.name),
                     "write 'clock: {offset_s: ...}', or 'clock: common' where it runs with the others'");
  }
  receiver.clock = read_clock(path, node["clock"]);
  if (const auto fault = find_fault(receiver)) {
    throw InputError(path, yaml_line(node), fmt::format("receiver '{}': {}", receiver.name, *fault),
                     "correct the file");
  }
  return receiver;
}

std::vector<Receiver> receivers_of(const CameraRig& rig) {
  std::vector<Receiver> receivers;
  for (const RigCamera& camera : rig.cameras) {
    Receiver receiver;
    receiver.id = static_cast<int>(receivers.size());
    receiver.name = camera.name;
    receiver.camera = camera.camera;
    receiver.T_world_receiver = camera.T_rig_camera;
    receiver.pose_covariance = camera.pose_covariance;
    receiver.clock.offset_s = camera.clock_offset_s;
    receivers.push_back(receiver);
  }
  return receivers;
}

bool is_receiver_file(const Path& path, const std::string& text) {
  const std::string extension = path.extension().string();
  if (extension != ".yaml" && extension != ".yml") return false;
  return text.find("receivers:") != std::string::npos;
}

std::string format_clock(const ReceiverClock& clock) {
  std::string text = fmt::format("{{offset_s: {}, rate: {}", clock.offset_s, clock.rate);
  if (clock.reference != Timestamp{}) {
    text += fmt::format(", reference_s: {}", to_seconds(clock.reference.time_since_epoch()));
  }
  if (!clock.covariance.isZero(0.0)) text += fmt::format(", covariance: {}", format_covariance(clock.covariance));
  return text + "}";
}

}  // namespace

std::vector<Receiver> read_receivers(const Path& path) {
  const std::string text = read_bytes(path);
  if (!is_receiver_file(path, text)) return receivers_of(read_camera_rig(path));
  const YAML::Node root = load_yaml(path, text);
  constexpr std::array<std::string_view, 1> kKeys{"receivers"};
  require_yaml_map(path, root, "receivers: [...]");
  refuse_unknown_keys(path, root, kKeys);
  const YAML::Node list = yaml_value(path, root, "receivers", "the file");
  if (!list.IsSequence() || list.size() == 0) {
    throw InputError(path, yaml_line(list), "a list of receivers is wanted", "");
  }
  std::vector<Receiver> receivers;
  std::set<int> ids;
  for (const YAML::Node& node : list) {
    receivers.push_back(read_receiver(path, node, receivers.size()));
    const int id = receivers.back().id;
    if (!ids.insert(id).second) {
      throw InputError(path, yaml_line(node), fmt::format("two receivers have the id {}", id), "give each its own");
    }
  }
  return receivers;
}

void write_receivers(const Path& path, std::span<const Receiver> receivers) {
  std::string text =
      "# T_world_receiver maps points of the receiver (x right, y down, z forward) into the world; quaternions in the\n"
      "# order w, x, y, z; covariances: upper triangles by rows, of a pose that of its right perturbation "
      "(translation,\n"
      "# rotation), m2, m rad, rad2; common time = own + offset_s + rate * (own - reference_s), covariance of both\n"
      "receivers:\n";
  for (const Receiver& receiver : receivers) {
    text += fmt::format("  - id: {}\n    name: {}\n", receiver.id, quoted_yaml(receiver.name));
    text += receiver.camera ? format_camera(*receiver.camera, "    ") : "    model: direction_finder\n";
    if (receiver.axes == FinderAxes::YUp) text += "    axes: y_up\n";
    text += fmt::format("    {}: {}\n", receiver.camera ? "sigma_px" : "sigma_rad", receiver.sigma);
    text += fmt::format("    T_world_receiver: {}\n", format_pose(receiver.T_world_receiver));
    if (receiver.pose_covariance) {
      text += fmt::format("    pose_covariance: {}\n", format_covariance(*receiver.pose_covariance));
    }
    text += fmt::format("    clock: {}\n", format_clock(receiver.clock));
  }
  write_file(path, text);
}

}  // namespace alidade
