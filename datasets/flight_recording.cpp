// SPDX-License-Identifier: Apache-2.0
#include "datasets/flight_recording.h"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/errors.h"
#include "core/find_by_id.h"
#include "io/table.h"
#include "io/text_lines.h"
#include "io/yaml_nodes.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

constexpr double kMedianToSigma = 1.0 / 1.17741;  // the median distance in the plane is σ √(2 ln 2)
constexpr double kPerMillion = 1e-6;
constexpr double kSameTime_s = 1e-3;  // column t has four digits

double positive(const Path& path, const YAML::Node& node, const char* name) {
  const double value = yaml_number(path, node);
  if (value > 0.0) return value;
  throw InputError(path, yaml_line(node), fmt::format("{} must be > 0, got {}", name, value), "correct the file");
}

Eigen::Isometry3d read_pose_of_world(const Path& path, const YAML::Node& node) {
  const auto r = yaml_numbers(path, yaml_value(path, node, "R", "the pose"), 9, "[1, 0, 0, 0, 1, 0, 0, 0, 1]");
  const auto t = yaml_numbers(path, yaml_value(path, node, "t", "the pose"), 3, "[0, 0, 0]");
  const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data());
  constexpr double kDigits = 1e-6;  // nine digits are written
  if (!(R * R.transpose()).isIdentity(kDigits) || R.determinant() < 0.0) {
    throw InputError(path, yaml_line(node), "R is no rotation", "x_cam = R x_world + t is wanted, R row by row");
  }
  Eigen::Isometry3d T_receiver_world = Eigen::Isometry3d::Identity();
  T_receiver_world.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  T_receiver_world.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
  return T_receiver_world.inverse();
}

Camera read_camera_of(const Path& path, const YAML::Node& node) {
  const auto value = [&](const char* key) { return yaml_value(path, node, key, "the receiver"); };
  Camera camera;
  camera.width = yaml_integer(path, value("width"));
  camera.height = yaml_integer(path, value("height"));
  const auto K = yaml_numbers(path, value("camera_matrix"), 9, "[1500, 0, 959.5, 0, 1500, 539.5, 0, 0, 1]");
  camera.fx = K[0], camera.cx = K[2], camera.fy = K[4], camera.cy = K[5];
  const YAML::Node distortion = value("distortion");
  const auto d = yaml_all_numbers(path, distortion);
  if (d.size() != 4 && d.size() != 5) {
    throw InputError(path, yaml_line(distortion), "k1 k2 p1 p2 [k3] are wanted", "");
  }
  camera.distortion = with_coefficients(BrownConrady{}, d);
  camera.readout_s = yaml_number(path, value("rolling_shutter"));
  return camera;
}

// Frames per second by receiver, nominal.
using Rates = std::map<int, double>;

Receiver read_receiver(const Path& path, const YAML::Node& node, Rates& rates) {
  require_yaml_map(path, node, "{id: 0, name: north, width: 1920, height: 1080, fps: 30}");
  const auto value = [&](const char* key) { return yaml_value(path, node, key, "the receiver"); };
  Receiver receiver;
  receiver.id = yaml_integer(path, value("id"));
  receiver.name = yaml_text(path, value("name"));
  receiver.camera = read_camera_of(path, node);
  receiver.T_world_receiver = read_pose_of_world(path, value("pose"));
  receiver.clock.offset_s = yaml_number(path, value("beta"));
  receiver.clock.rate = kPerMillion * yaml_number(path, value("ppm"));
  const YAML::Node median = yaml_value(path, value("fit"), "median_px", "the fit");
  receiver.sigma = kMedianToSigma * positive(path, median, "median_px");
  if (!rates.emplace(receiver.id, positive(path, value("fps"), "fps")).second) {
    throw InputError(path, yaml_line(node), fmt::format("two receivers have the id {}", receiver.id), "");
  }
  if (const auto fault = find_fault(receiver)) {
    throw InputError(path, yaml_line(node), fmt::format("receiver '{}': {}", receiver.name, *fault),
                     "correct the file");
  }
  return receiver;
}

void read_times(const Path& path, const YAML::Node& fit, FlightRecording& flight) {
  const YAML::Node window = yaml_value(path, fit, "flight_window_s", "pose_fit");
  const auto ends = yaml_numbers(path, window, 2, "[51.4, 652.6]");
  flight.flight_begin = Timestamp(from_seconds(ends[0]));
  flight.flight_end = Timestamp(from_seconds(ends[1]));
  const YAML::Node used = yaml_value(path, fit, "used_until_s", "pose_fit");
  flight.used_until = Timestamp(from_seconds(yaml_number(path, used)));
  if (flight.flight_begin < flight.used_until && flight.used_until < flight.flight_end) return;
  throw InputError(path, yaml_line(used), "used_until_s must lie within flight_window_s", "");
}

Rates read_receivers_of(const Path& path, FlightRecording& flight) {
  const YAML::Node root = load_yaml(path, read_bytes(path));
  require_yaml_map(path, root, "{pose_fit: ..., receivers: ...}");
  read_times(path, yaml_value(path, root, "pose_fit", "the file"), flight);
  const YAML::Node list = yaml_value(path, root, "receivers", "the file");
  if (!list.IsSequence() || list.size() < 2) {
    throw InputError(path, yaml_line(list), "a list of two receivers or more is wanted", "");
  }
  Rates rates;
  for (const YAML::Node& node : list) flight.receivers.push_back(read_receiver(path, node, rates));
  return rates;
}

void read_observations(const Path& path, const Rates& rates, FlightRecording& flight) {
  const Table table = read_table(path);
  const std::size_t t = table.column("t"), id = table.column("receiver"), frame = table.column("frame"),
                    u = table.column("u"), v = table.column("v");
  std::map<int, std::int64_t> last;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const auto receiver_id = static_cast<int>(table.integer(row, id));
    const Receiver* receiver = find_by_id(std::span<const Receiver>(flight.receivers), receiver_id);
    if (!receiver) throw table.error(row, fmt::format("receivers.yaml has no receiver {}", receiver_id));
    const std::int64_t number = table.integer(row, frame);
    const auto [before, is_first] = last.emplace(receiver_id, number);
    if (!is_first && number <= before->second) {
      throw table.error(
          row, fmt::format("frame {} of receiver {} comes after frame {}", number, receiver_id, before->second));
    }
    before->second = number;
    ReceiverReading reading;
    reading.time = Timestamp(from_seconds(static_cast<double>(number) / rates.at(receiver_id)));
    reading.receiver = receiver_id;
    reading.value = {table.number(row, u), table.number(row, v)};
    const double apart_s = table.number(row, t) - to_seconds(common_time(receiver->clock, reading.time) - Timestamp{});
    if (std::abs(apart_s) > kSameTime_s) {
      throw table.error(row, fmt::format("t is {:.4f} s from what frame {} is by the clock of receiver {}", apart_s,
                                         number, receiver_id));
    }
    flight.readings.push_back(reading);
  }
  if (flight.readings.empty()) throw InputError(path, 0, "holds no observation", "");
}

std::vector<TimedPosition> read_truth(const Path& path) {
  const Table table = read_table(path);
  const std::size_t t = table.column("t"), x = table.column("x"), y = table.column("y"), z = table.column("z");
  std::vector<TimedPosition> truth;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Timestamp time(from_seconds(table.number(row, t)));
    if (!truth.empty() && time <= truth.back().time) throw table.error(row, "time does not increase");
    truth.push_back({time, {table.number(row, x), table.number(row, y), table.number(row, z)}});
  }
  if (truth.size() < 2) throw InputError(path, 0, "holds no path", "two rows or more are wanted");
  return truth;
}

}  // namespace

FlightRecording read_flight(const Path& folder) {
  FlightRecording flight;
  const Rates rates = read_receivers_of(folder / "receivers.yaml", flight);
  read_observations(folder / "observations.csv", rates, flight);
  flight.truth = read_truth(folder / "groundtruth.csv");
  return flight;
}

}  // namespace alidade
