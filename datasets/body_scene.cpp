// SPDX-License-Identifier: Apache-2.0
#include "datasets/body_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

using std::numbers::pi;

constexpr double kBodyRadius_m = 0.15, kDisturbance = 0.15;
constexpr double kDistance_m = 3.0, kSpacing_m = 0.15;
constexpr int kDetectorsPerBlock = 4;

// x(t) = offset + amplitude sin(rate t + phase) in each of three coordinates.
struct Swing {
  Eigen::Vector3d offset, amplitude, rate, phase;

  Eigen::Vector3d at(double t) const { return offset.array() + amplitude.array() * (t * rate + phase).array().sin(); }
  Eigen::Vector3d velocity(double t) const {
    return amplitude.array() * rate.array() * (t * rate + phase).array().cos();
  }
};

const Swing& translation() {
  static const Swing swing{{0, 0, 1}, {0.5, 0.4, 0.3}, {2, 2.7, 3.3}, {0, 1, 2}};
  return swing;
}

const Swing& rotation() {
  static const Swing swing{{0, 0, 0}, {0.8, 0.7, 1}, {1.9, 2.3, 1.4}, {0, 0.5, 1}};
  return swing;
}

// All bodies walk the same path, one after the other and beside each other.
double own_time_s(int body, Timestamp time) {
  constexpr double kBehind_s = 1.3;
  return to_seconds(time.time_since_epoch()) - kBehind_s * body;
}

Eigen::Vector3d beside_m(int body) {
  constexpr double kTurn = 2.4, kAway_m = 0.4;
  return body == 0 ? Eigen::Vector3d(0, 0, 0)
                   : Eigen::Vector3d(kAway_m * std::cos(kTurn * body), kAway_m * std::sin(kTurn * body), 0);
}

std::vector<Eigen::Vector3d> corners(int markers) {
  if (markers == 3) {  // bent: its plane is not through the body's centre
    std::vector<Eigen::Vector3d> triangle;
    for (int i = 0; i < 3; ++i) triangle.emplace_back(std::cos(2 * pi * i / 3), std::sin(2 * pi * i / 3), 0.5);
    return triangle;
  }
  if (markers == 4) return {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  std::vector<Eigen::Vector3d> cube;
  for (int i = 0; i < 8; ++i) cube.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  return cube;
}

RigidBody make_body(int index, int markers, std::mt19937_64& random) {
  std::uniform_real_distribution<double> disturbance(-kDisturbance, kDisturbance);
  RigidBody body{fmt::format("body{}", index + 1), {}};
  for (const Eigen::Vector3d& corner : corners(markers)) {
    const Eigen::Vector3d off(disturbance(random), disturbance(random), disturbance(random));
    const int id = index * markers + static_cast<int>(body.markers.size());
    body.markers.push_back({id, kBodyRadius_m * (corner.normalized() + off)});
  }
  return body;
}

// z towards the scene's centre, x across the view and level.
Eigen::Isometry3d T_world_block(int block, int blocks) {
  const double azimuth = 2 * pi * block / std::max(3, blocks) + 0.3;  // one and two blocks stand as of three
  const Eigen::Vector3d centre(kDistance_m * std::cos(azimuth), kDistance_m * std::sin(azimuth),
                               1.2 + 0.5 * (block % 3));
  const Eigen::Vector3d z = (Eigen::Vector3d(0, 0, 1) - centre).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = centre;
  return T;
}

// Each a little different.
LineCamera lens_of(int detector) {
  constexpr int kWidth_px = 2048;
  return {kWidth_px, 1640.0 + 3.0 * detector, 1023.5 + 5.0 * std::sin(detector), -0.08, 0.02, 0.0};
}

double sigma_of(const BodySceneOptions& options) {
  return options.has_lenses ? options.sigma_px : options.sigma_rad;
}

// Whether the line of pixels is long enough.
bool is_in_view(const LineModel& model, double value) {
  const auto* lens = std::get_if<LineCamera>(&model);
  return !lens || (value >= -0.5 && value <= lens->width - 0.5);
}

LineDetector make_detector(int block, int place, const BodySceneOptions& options) {
  LineDetector detector;
  detector.id = block * kDetectorsPerBlock + place;
  detector.station = fmt::format("block{}", block + 1);
  detector.model = FocalLine{};
  if (options.has_lenses) {
    constexpr double kUsual_px = 0.5;
    detector.model = lens_of(detector.id);
    detector.sigma = kUsual_px;
  }
  detector.T_world_station = T_world_block(block, options.blocks);
  detector.T_station_detector = Eigen::Translation3d((place - 1.5) * kSpacing_m, 0, 0) *
                                Eigen::AngleAxisd(place * pi / kDetectorsPerBlock, Eigen::Vector3d::UnitZ());
  if (sigma_of(options) > 0) detector.sigma = sigma_of(options);
  return detector;
}

// Streams of chance of their own, so that noise is the same with and without occlusion.
std::mt19937_64 chance(unsigned seed, unsigned stream) {
  std::seed_seq sequence{seed, stream};
  return std::mt19937_64(sequence);
}

// Where in a frame the n-th reading falls, in [0, 1): evenly filled, in no order (the golden ratio's multiples).
double place_in_frame(int n) {
  const double turns = n * (std::numbers::phi - 1.0);
  return turns - std::floor(turns);
}

template <class Value>
void require(bool holds, const char* field, Value value, const char* bound) {
  if (!holds) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

void sort_by_time(BodySceneFrame& frame) {
  std::vector<std::size_t> order(frame.readings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&frame](std::size_t a, std::size_t b) { return frame.readings[a].time < frame.readings[b].time; });
  BodySceneFrame sorted{frame.time, {}, {}};
  for (const std::size_t i : order) {
    sorted.readings.push_back(frame.readings[i]);
    sorted.is_right.push_back(frame.is_right[i]);
  }
  frame = std::move(sorted);
}

}  // namespace

void validate(const BodySceneOptions& o) {
  require(o.frames >= 1, "frames", o.frames, ">= 1");
  require(o.rate_hz > 0 && o.rate_hz <= 1e6, "rate_hz", o.rate_hz, "> 0 and <= 1e6 Hz");
  require(o.markers == 3 || o.markers == 4 || o.markers == 8, "markers", o.markers, "3, 4 or 8");
  require(o.blocks >= 1 && o.blocks <= 100, "blocks", o.blocks, "1..100");
  require(o.bodies >= 1 && o.bodies <= 100, "bodies", o.bodies, "1..100");
  require(o.sigma_rad >= 0 && o.sigma_rad <= 0.1, "sigma_rad", o.sigma_rad, "0..0.1 rad");
  require(o.sigma_px >= 0 && o.sigma_px <= 100, "sigma_px", o.sigma_px, "0..100 px");
  require(o.wrong_ids >= 0 && o.wrong_ids <= 1, "wrong_ids", o.wrong_ids, "0..1");
  require(o.occluded >= 0 && o.occluded <= 1, "occluded", o.occluded, "0..1");
  require(o.redrawn >= 0 && o.redrawn <= 1, "redrawn", o.redrawn, "0..1");
  require(o.skew_s >= 0 && o.skew_s * o.rate_hz <= 1, "skew_s", o.skew_s, ">= 0 s and not longer than a frame");
}

std::vector<LineReading> right_readings(const BodySceneFrame& frame) {
  std::vector<LineReading> right;
  for (std::size_t i = 0; i < frame.readings.size(); ++i) {
    if (frame.is_right[i]) right.push_back(frame.readings[i]);
  }
  return right;
}

BodyScene::BodyScene(const BodySceneOptions& options)
    : options_(options), chance_{chance(options.seed, 1), chance(options.seed, 2), chance(options.seed, 3)} {
  validate(options);
  std::mt19937_64 shapes = chance(options.seed, 0);
  for (int i = 0; i < options.bodies; ++i) bodies_.push_back(make_body(i, options.markers, shapes));
  for (int block = 0; block < options.blocks; ++block) {
    for (int place = 0; place < kDetectorsPerBlock; ++place) {
      detectors_.push_back(make_detector(block, place, options));
    }
  }
  std::bernoulli_distribution is_hidden(options.occluded);
  for (int i = 0; i < options.blocks * options.bodies * options.markers; ++i) {
    hidden_.push_back(is_hidden(chance_.occlusion));
  }
}

Timestamp BodyScene::time(int frame) const {
  return Timestamp(from_seconds(frame / options_.rate_hz));
}

std::optional<BodySceneFrame> BodyScene::next() {
  if (next_frame_ == options_.frames) return std::nullopt;
  if (next_frame_ > 0) redraw_occlusion();
  BodySceneFrame frame;
  frame.time = time(next_frame_++);
  for (int body = 0; body < options_.bodies; ++body) read_body(body, frame);
  if (options_.skew_s > 0) sort_by_time(frame);
  return frame;
}

void BodyScene::redraw_occlusion() {
  if (options_.occluded == 0) return;
  std::bernoulli_distribution is_redrawn(options_.redrawn), is_hidden(options_.occluded);
  for (std::size_t i = 0; i < hidden_.size(); ++i) {
    if (is_redrawn(chance_.occlusion)) hidden_[i] = is_hidden(chance_.occlusion);
  }
}

void BodyScene::read_body(int body, BodySceneFrame& frame) {
  const auto& markers = bodies_[static_cast<std::size_t>(body)].markers;
  std::normal_distribution<double> noise(0.0, 1.0);
  const Eigen::Isometry3d T_at_frame = pose_in_scene(body, frame.time);
  for (const LineDetector& detector : detectors_) {
    for (const BodyMarker& marker : markers) {
      const int count = options_.bodies * options_.markers, turn = detector.id * count + marker.id;
      const Timestamp time = frame.time + from_seconds(options_.skew_s * place_in_frame(turn));
      const double off = sigma_of(options_) * noise(chance_.noise);
      if (hidden_[static_cast<std::size_t>(detector.id / kDetectorsPerBlock * count + marker.id)]) continue;
      const Eigen::Isometry3d T_world_body = options_.skew_s > 0 ? pose_in_scene(body, time) : T_at_frame;
      const auto projection = project(detector, T_world_body * marker.p_body);
      if (!projection || !is_in_view(detector.model, projection->value)) continue;
      const int name = name_of(body, marker.id);
      frame.readings.push_back({time, detector.id, name, projection->value + off, sigma_of(options_)});
      frame.is_right.push_back(name == marker.id);
    }
  }
}

// The id under which a reading of `marker` is told.
int BodyScene::name_of(int body, int marker) {
  if (options_.wrong_ids == 0 || !std::bernoulli_distribution(options_.wrong_ids)(chance_.names)) return marker;
  const int first = body * options_.markers;
  const int step = std::uniform_int_distribution<int>(1, options_.markers - 1)(chance_.names);
  return first + (marker - first + step) % options_.markers;
}

Eigen::Isometry3d pose_in_scene(int index, Timestamp time) {
  const double t = own_time_s(index, time);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3(rotation().at(t));
  T.translation() = translation().at(t) + beside_m(index);
  return T;
}

Vector6d twist_in_scene(int index, Timestamp time) {
  const double t = own_time_s(index, time);
  const Eigen::Vector3d phi = rotation().at(t);
  Vector6d twist;
  twist << exp_so3(phi).transpose() * translation().velocity(t), right_jacobian_so3(phi) * rotation().velocity(t);
  return twist;
}

}  // namespace alidade
