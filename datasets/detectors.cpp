// SPDX-License-Identifier: Apache-2.0
#include "datasets/detectors.h"

#include <array>
#include <cmath>
#include <map>

#include <Eigen/LU>
#include <fmt/format.h>

#include "core/errors.h"
#include "io/detector_file.h"
#include "io/text_lines.h"
#include "io/yaml_nodes.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

enum class System { First, Second, SecondFull };

System find_system(const Path& path, const YAML::Node& root) {
  constexpr std::array<std::string_view, 2> kSystems{"Lighthouse 1", "Lighthouse 2"};
  if (const YAML::Node system = root["system"]) {
    return yaml_choice(path, system, "system", kSystems) == kSystems[0] ? System::First : System::Second;
  }
  if (root["device"]) return System::SecondFull;
  throw InputError(path, 0, "says neither 'system' nor 'device'",
                   "write \"system\": \"Lighthouse 1\" or \"Lighthouse 2\"");
}

Eigen::Vector3d read_vector(const Path& path, const YAML::Node& node) {
  const auto v = yaml_numbers(path, node, 3, "[0, 0, 1.5]");
  return {v[0], v[1], v[2]};
}

Eigen::Matrix3d read_rotation(const Path& path, const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != 3) {
    throw InputError(path, yaml_line(node), "three rows of a rotation matrix are wanted", "");
  }
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) R.row(i) = read_vector(path, node[static_cast<std::size_t>(i)]).transpose();
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3) || !(R.determinant() > 0)) {
    throw InputError(path, yaml_line(node), "is not a rotation", "its columns are the station's axes in the world");
  }
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

Eigen::Isometry3d read_station_pose(const Path& path, const YAML::Node& detector) {
  const YAML::Node pose = yaml_value(path, detector, "pose_logged", "the detector");
  require_yaml_map(path, pose, "{\"origin\": [0, 0, 2], \"rotation\": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = read_vector(path, yaml_value(path, pose, "origin", "the pose"));
  T.linear() = read_rotation(path, yaml_value(path, pose, "rotation", "the pose"));
  return T;
}

SweepTerms read_factory_terms(const Path& path, const YAML::Node& detector, System system) {
  const YAML::Node node = yaml_value(path, detector, "factory_calibration", "the detector");
  require_yaml_map(path, node, "{\"phase\": 0.0178, \"tilt\": -0.0052, ...}");
  SweepTerms t;
  const auto read = [&](const char* key, double& term, bool is_used) {
    const YAML::Node value = is_used ? yaml_value(path, node, key, "the factory calibration") : node[key];
    if (value) term = yaml_number(path, value);
  };
  read("phase", t.phase, true);
  read("tilt", t.tilt, true);
  read("gibmag", t.gibmag, true);
  read("gibphase", t.gibphase, true);
  read("curve", t.curve, system != System::Second);
  read("ogeemag", t.ogeemag, system == System::SecondFull);
  read("ogeephase", t.ogeephase, system == System::SecondFull);
  return t;
}

LineModel make_model(System system, int sweep, const SweepTerms& terms) {
  if (system == System::First) return Lighthouse1{sweep, terms};
  return Lighthouse2Full{sweep, terms};
}

// The full model's axes (x right, y up, z back) in a station frame whose x looks forward and whose z points up.
Eigen::Matrix3d forward_is_x() {
  Eigen::Matrix3d R;
  R << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  return R;
}

void require_kind(const Path& path, const YAML::Node& detector, System system) {
  const YAML::Node kind = yaml_value(path, detector, "kind", "the detector");
  const std::string wanted = system == System::First ? "focal-line" : "tilted-plane";
  const std::string found = kind.IsScalar() ? kind.Scalar() : "";
  if (found.starts_with(wanted)) return;
  throw InputError(path, yaml_line(kind), fmt::format("the kind '{}' is not this system's", found),
                   fmt::format("'{}' is wanted", wanted));
}

// A focal line is the axis about which the sweep turns: z of the station for sweep 0, y for sweep 1.
void require_focal_line(const Path& path, const YAML::Node& line, const LineDetector& detector, int sweep) {
  require_yaml_map(path, line, "{\"point\": [0, 0, 2], \"direction\": [0, 0, 1]}");
  const YAML::Node direction_node = yaml_value(path, line, "direction", "the focal line");
  const Eigen::Vector3d point = read_vector(path, yaml_value(path, line, "point", "the focal line"));
  const Eigen::Vector3d direction = read_vector(path, direction_node);
  const Eigen::Vector3d axis = detector.T_world_station.linear().col(sweep == 0 ? 2 : 1);
  if (!(direction.cross(axis).norm() < 1e-3 * direction.norm())) {
    throw InputError(path, yaml_line(direction_node), "the focal line is not the axis of this sweep",
                     "that is the station's z axis for sweep 0, its y axis for sweep 1");
  }
  const Eigen::Vector3d beside = (point - detector.T_world_station.translation()).cross(axis);
  if (!(beside.norm() < 1e-3)) {
    throw InputError(path, yaml_line(line), "the focal line does not pass the station's origin", "");
  }
}

LineDetector read_detector(const Path& path, const YAML::Node& node, System system) {
  require_yaml_map(path, node, "{\"id\": 0, \"station\": 0, \"sweep\": 0, ...}");
  LineDetector detector;
  detector.id = yaml_integer(path, yaml_value(path, node, "id", "the detector"));
  detector.station = yaml_text(path, yaml_value(path, node, "station", "the detector"));
  const YAML::Node sweep_node = yaml_value(path, node, "sweep", "the detector");
  const int sweep = yaml_integer(path, sweep_node);
  if (sweep != 0 && sweep != 1) {
    throw InputError(path, yaml_line(sweep_node), fmt::format("sweep must be 0 or 1, got {}", sweep), "");
  }
  require_kind(path, node, system);
  detector.model = make_model(system, sweep, read_factory_terms(path, node, system));
  detector.T_world_station = read_station_pose(path, node);
  if (system == System::Second) detector.T_station_detector.linear() = forward_is_x();
  detector.sigma = system == System::SecondFull ? 3e-4 : 1e-4;
  if (const YAML::Node line = node["focal_line"]) require_focal_line(path, line, detector, sweep);
  return detector;
}

void require_consistent(const Path& path, const YAML::Node& node, const LineDetector& detector,
                        const std::vector<LineDetector>& others) {
  for (const LineDetector& other : others) {
    if (other.id == detector.id) {
      throw InputError(path, yaml_line(node), fmt::format("two detectors have the id {}", detector.id), "");
    }
    if (other.station == detector.station && !other.T_world_station.isApprox(detector.T_world_station, 1e-6)) {
      throw InputError(path, yaml_line(node), fmt::format("station {} has two poses", detector.station),
                       "its detectors stand rigidly together: give them the same");
    }
  }
}

}  // namespace

DetectorRig read_laser_sweep_rig(const Path& path) {
  const YAML::Node root = load_yaml(path, read_bytes(path));  // YAML contains JSON, and knows the lines
  if (!root.IsMap()) throw InputError(path, 0, "holds no detectors", "a list 'detectors' is wanted");
  const System system = find_system(path, root);
  const YAML::Node list = yaml_value(path, root, "detectors", "the file");
  if (!list.IsSequence() || list.size() == 0) {
    throw InputError(path, yaml_line(list), "a list of detectors is wanted", "");
  }
  DetectorRig rig;
  for (const YAML::Node& node : list) {
    LineDetector detector = read_detector(path, node, system);
    require_consistent(path, node, detector, rig.detectors);
    if (!rig.detectors.empty()) {
      for (const LineDetector& other : rig.detectors) {
        if (other.station == detector.station) detector.T_world_station = other.T_world_station;
      }
    }
    rig.detectors.push_back(std::move(detector));
  }
  return rig;
}

DetectorRig read_detectors(const Path& path) {
  if (std::filesystem::is_directory(path)) {
    for (const char* name : {"detectors.yaml", "detectors.json"}) {
      if (std::filesystem::exists(path / name)) return read_detectors(path / name);
    }
    throw InputError(path, 0, "holds neither detectors.yaml nor detectors.json", "name the file");
  }
  return path.extension() == ".json" ? read_laser_sweep_rig(path) : read_detector_rig(path);
}

}  // namespace alidade
