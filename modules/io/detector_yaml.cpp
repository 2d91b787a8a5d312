// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "io/camera_yaml.h"
#include "io/detector_file.h"
#include "io/pose_yaml.h"
#include "io/text_lines.h"
#include "io/yaml_nodes.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

constexpr double kPixelSigma = 0.5;  // px; what centroids of markers reach without care

struct Station {
  std::string name;
  Eigen::Isometry3d T_world_station = Eigen::Isometry3d::Identity();
};

Station read_station(const Path& path, const YAML::Node& node, DetectorRig& rig) {
  require_yaml_map(path, node, "{name: north, T_world_station: {translation_m: [...], quaternion_wxyz: [...]}}");
  constexpr std::array<std::string_view, 3> kKeys{"name", "T_world_station", "covariance"};
  refuse_unknown_keys(path, node, kKeys);
  Station station;
  station.name = yaml_text(path, yaml_value(path, node, "name", "the station"));
  station.T_world_station = read_pose(path, yaml_value(path, node, "T_world_station", "the station"));
  if (const YAML::Node covariance = node["covariance"]) {
    rig.station_covariance[station.name] = read_covariance(path, covariance, 6);
  }
  return station;
}

std::vector<Station> read_stations(const Path& path, const YAML::Node& list, DetectorRig& rig) {
  if (!list.IsSequence() || list.size() == 0) {
    throw InputError(path, yaml_line(list), "a list of stations is wanted", "");
  }
  std::vector<Station> stations;
  for (const YAML::Node& node : list) {
    Station station = read_station(path, node, rig);
    const bool taken =
        std::any_of(stations.begin(), stations.end(), [&](const auto& s) { return s.name == station.name; });
    if (taken) throw InputError(path, yaml_line(node), fmt::format("two stations are named '{}'", station.name), "");
    stations.push_back(std::move(station));
  }
  return stations;
}

// Numbers by name from a map that may leave some out.
template <std::size_t N>
void read_terms(const Path& path, const YAML::Node& map, const std::array<std::string_view, N>& keys,
                const std::array<double*, N>& values) {
  require_yaml_map(path, map, fmt::format("{{{}: 0.01}}", keys.front()).c_str());
  refuse_unknown_keys(path, map, keys);
  for (std::size_t i = 0; i < N; ++i) {
    if (const YAML::Node value = map[keys[i].data()]) *values[i] = yaml_number(path, value);
  }
}

SweepTerms read_sweep_terms(const Path& path, const YAML::Node& node) {
  SweepTerms t;
  if (!node) return t;
  read_terms<7>(path, node, {"phase", "tilt", "curve", "gibmag", "gibphase", "ogeemag", "ogeephase"},
                {&t.phase, &t.tilt, &t.curve, &t.gibmag, &t.gibphase, &t.ogeemag, &t.ogeephase});
  return t;
}

LineModel read_line_camera(const Path& path, const YAML::Node& node) {
  LineCamera camera;
  camera.width = yaml_integer(path, yaml_value(path, node, "width_px", "the detector"));
  const YAML::Node intrinsics = yaml_value(path, node, "intrinsics_px", "the detector");
  require_yaml_map(path, intrinsics, "{f: 1500, c: 1023.5}");
  yaml_value(path, intrinsics, "f", "the line camera");
  yaml_value(path, intrinsics, "c", "the line camera");
  read_terms<2>(path, intrinsics, {"f", "c"}, {&camera.f, &camera.c});
  if (const YAML::Node distortion = node["distortion"]) {
    read_terms<3>(path, distortion, {"k1", "k2", "k3"}, {&camera.k1, &camera.k2, &camera.k3});
  }
  return camera;
}

LineModel read_pixel_axis(const Path& path, const YAML::Node& node) {
  constexpr std::array<std::string_view, 2> kAxes{"x", "y"};
  const std::string axis = yaml_choice(path, yaml_value(path, node, "axis", "the detector"), "axis", kAxes);
  const CameraRecord record = read_camera_node(path, yaml_value(path, node, "camera", "the detector"), 0);
  return PixelAxis{record.camera, axis == "x" ? 0 : 1};
}

struct ModelKeys {
  std::string_view name;
  std::vector<std::string_view> keys;  // besides those of every detector
};

const std::array<ModelKeys, 6> kModels{{{"focal_line", {"sigma_rad"}},
                                        {"line_camera", {"width_px", "intrinsics_px", "distortion", "sigma_px"}},
                                        {"lighthouse1", {"sweep", "terms", "sigma_rad"}},
                                        {"lighthouse2", {"sweep", "terms", "sigma_rad"}},
                                        {"lighthouse2_full", {"sweep", "terms", "sigma_rad"}},
                                        {"pixel", {"axis", "camera", "sigma_px"}}}};

LineModel read_model(const Path& path, const YAML::Node& node) {
  std::vector<std::string_view> names;
  for (const ModelKeys& model : kModels) names.push_back(model.name);
  const std::string name = yaml_choice(path, yaml_value(path, node, "model", "the detector"), "detector model", names);
  const auto model = std::find_if(kModels.begin(), kModels.end(), [&](const auto& m) { return m.name == name; });
  std::vector<std::string_view> keys{"id", "station", "model", "T_station_detector"};
  keys.insert(keys.end(), model->keys.begin(), model->keys.end());
  refuse_unknown_keys(path, node, keys);
  if (name == "focal_line") return FocalLine{};
  if (name == "line_camera") return read_line_camera(path, node);
  if (name == "pixel") return read_pixel_axis(path, node);
  const int sweep = yaml_integer(path, yaml_value(path, node, "sweep", "the detector"));
  const SweepTerms terms = read_sweep_terms(path, node["terms"]);
  if (name == "lighthouse1") return Lighthouse1{sweep, terms};
  if (name == "lighthouse2") return Lighthouse2{sweep, terms};
  return Lighthouse2Full{sweep, terms};
}

const Station& find_station(const Path& path, const YAML::Node& node, const std::vector<Station>& stations) {
  const std::string name = yaml_text(path, node);
  std::vector<std::string_view> known;
  for (const Station& station : stations) {
    if (station.name == name) return station;
    known.push_back(station.name);
  }
  throw InputError(path, yaml_line(node), fmt::format("unknown station '{}'", name), suggest_name(name, known));
}

LineDetector read_detector(const Path& path, const YAML::Node& node, const std::vector<Station>& stations) {
  require_yaml_map(path, node, "{id: 0, station: north, model: focal_line}");
  LineDetector detector;
  detector.id = yaml_integer(path, yaml_value(path, node, "id", "the detector"));
  detector.model = read_model(path, node);
  const Station& station = find_station(path, yaml_value(path, node, "station", "the detector"), stations);
  detector.station = station.name;
  detector.T_world_station = station.T_world_station;
  if (const YAML::Node pose = node["T_station_detector"]) detector.T_station_detector = read_pose(path, pose);
  if (reads_pixels(detector.model)) detector.sigma = kPixelSigma;
  for (const char* key : {"sigma_rad", "sigma_px"}) {
    if (const YAML::Node sigma = node[key]) detector.sigma = yaml_number(path, sigma);
  }
  if (const auto fault = find_fault(detector)) {
    throw InputError(path, yaml_line(node), fmt::format("detector {}: {}", detector.id, *fault), "correct the file");
  }
  return detector;
}

}  // namespace

DetectorRig read_detector_rig(const Path& path) {
  const YAML::Node root = load_yaml(path, read_bytes(path));
  if (!root.IsMap()) throw InputError(path, 0, "holds no detectors", "keys 'stations' and 'detectors' are wanted");
  constexpr std::array<std::string_view, 2> kKeys{"stations", "detectors"};
  refuse_unknown_keys(path, root, kKeys);
  DetectorRig rig;
  const auto stations = read_stations(path, yaml_value(path, root, "stations", "the rig"), rig);
  const YAML::Node list = yaml_value(path, root, "detectors", "the rig");
  if (!list.IsSequence() || list.size() == 0) {
    throw InputError(path, yaml_line(list), "a list of detectors is wanted", "");
  }
  std::set<int> ids;
  for (const YAML::Node& node : list) {
    rig.detectors.push_back(read_detector(path, node, stations));
    const int id = rig.detectors.back().id;
    if (!ids.insert(id).second)
      throw InputError(path, yaml_line(node), fmt::format("two detectors have the id {}", id), "");
  }
  return rig;
}

}  // namespace alidade
