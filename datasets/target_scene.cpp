// SPDX-License-Identifier: Apache-2.0
#include "datasets/target_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

#include "datasets/scan_law.h"
#include "geometry/tangent.h"

namespace alidade {
namespace {

using Eigen::Vector3d;
using Random = std::mt19937_64;

void require(bool is_so, const char* field, const char* bound, double value) {
  if (!is_so) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

Vector3d normal_vector(Random& random, double sigma) {
  std::normal_distribution<double> normal(0.0, 1.0);
  Vector3d v;
  for (double& x : v) x = sigma * normal(random);
  return v;
}

Vector3d common_velocity(const TargetSceneOptions& options, Random& random) {
  Vector3d v = normal_vector(random, options.velocity_sigma_m_s);
  while (v.norm() > options.top_speed_m_s) v = normal_vector(random, options.velocity_sigma_m_s);
  return v;
}

// Evenly in a cube, none too near another; the cube grows where they do not fit.
std::vector<Vector3d> first_places(const TargetSceneOptions& options, Random& random) {
  constexpr int kTriesPerCube = 1000;
  std::uniform_real_distribution<double> even(-0.5, 0.5);
  std::vector<Vector3d> places;
  double side = options.spread_m;
  for (int tries = 1; places.size() < static_cast<std::size_t>(options.targets); ++tries) {
    if (tries % kTriesPerCube == 0) side *= 1.1;
    const double x = even(random), y = even(random), z = even(random);
    const Vector3d p = side * Vector3d(x, y, z);
    const bool is_free = std::all_of(places.begin(), places.end(), [&](const Vector3d& other) {
      return (p - other).norm() >= options.least_distance_m;
    });
    if (is_free) places.push_back(p);
  }
  return places;
}

// Across the first receiver's view, which looks along x.
std::vector<Vector3d> places_in_row(const TargetSceneOptions& options) {
  std::vector<Vector3d> places;
  for (int i = 0; i < options.targets; ++i) {
    places.push_back((i - 0.5 * (options.targets - 1)) * *options.row_spacing_m * Vector3d::UnitY());
  }
  return places;
}

GustEffect gust_at(const TargetPath& path, double t_s) {
  if (path.gusts.empty() || t_s <= 0.0) return {};
  const std::size_t step = std::min(path.gusts.size() - 1, static_cast<std::size_t>(t_s / kGustStep_s));
  const GustEffect& begin = path.gusts[step];
  return {begin.p_m + (t_s - static_cast<double>(step) * kGustStep_s) * begin.v_m_s, begin.v_m_s};
}

Timestamp period_begin(const TargetSceneOptions& options, double period) {
  return Timestamp(from_seconds(period * options.period_s));
}

// The velocity changes at the end of each step, by as much as white noise does within it.
std::vector<GustEffect> draw_gusts(const TargetSceneOptions& options, Random& random) {
  const auto steps = static_cast<std::size_t>((options.periods + 1.0) * options.period_s / kGustStep_s);
  const double sigma_m_s = std::sqrt(options.agility_m2_s3 * kGustStep_s);
  std::vector<GustEffect> gusts(1);
  while (gusts.size() < steps) {
    GustEffect gust = gusts.back();
    gust.p_m += kGustStep_s * gust.v_m_s;
    gust.v_m_s += normal_vector(random, sigma_m_s);
    gusts.push_back(gust);
  }
  return gusts;
}

std::vector<TargetPath> draw_paths(const TargetSceneOptions& options, Random& random) {
  const Vector3d v = common_velocity(options, random);
  const std::vector<Vector3d> places = options.row_spacing_m ? places_in_row(options) : first_places(options, random);
  std::vector<TargetPath> paths;
  for (int i = 0; i < options.targets; ++i) {
    TargetPath path;
    path.target = i;
    path.origin = path.birth = period_begin(options, 0.0);
    path.death = period_begin(options, options.periods + 1.0);
    path.p0_world = places[static_cast<std::size_t>(i)];
    path.v_world = v + normal_vector(random, options.scatter_m_s);
    path.a_world = normal_vector(random, options.acceleration_m_s2);
    if (options.agility_m2_s3 > 0.0) path.gusts = draw_gusts(options, random);
    const int fifth = options.periods / 5;
    if (options.comes_and_goes && i % 2 == 1) path.birth = period_begin(options, fifth);
    if (options.comes_and_goes && i % 2 == 0 && i > 0) path.death = period_begin(options, options.periods - fifth);
    paths.push_back(path);
  }
  return paths;
}

Vector3d middle_at(const std::vector<TargetPath>& paths, Timestamp time) {
  Vector3d sum = Vector3d::Zero();
  for (const TargetPath& path : paths) sum += position_at(path, time);
  return sum / static_cast<double>(paths.size());
}

// Looking along `forward`, without roll: y is down as far as it can be.
Eigen::Matrix3d facing(const Vector3d& forward) {
  Eigen::Matrix3d R;
  R.col(2) = forward;
  R.col(0) = forward.cross(Vector3d::UnitZ()).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

// Below the targets' place in the middle of the time, which all receivers face.
std::vector<Receiver> place_receivers(const TargetSceneOptions& options, double range_m, const Vector3d& middle) {
  std::vector<Receiver> receivers;
  for (int k = 0; k < options.receivers; ++k) {
    const double turn =
        options.receivers == 2 ? 2.0 * std::numbers::pi / 3.0 : 2.0 * std::numbers::pi / options.receivers;
    const double azimuth = k * turn;
    const double out = std::cos(options.elevation_rad), up = std::sin(options.elevation_rad);
    const Vector3d to_receiver(out * std::cos(azimuth), out * std::sin(azimuth), -up);
    Receiver receiver;
    receiver.id = k;
    receiver.name = fmt::format("receiver{}", k + 1);
    receiver.T_world_receiver.translation() = middle + range_m * to_receiver;
    receiver.T_world_receiver.linear() = facing(-to_receiver);
    receiver.sigma = options.sigma_m > 0.0 ? options.sigma_m / range_m : 1e-6;
    receivers.push_back(receiver);
  }
  return receivers;
}

// Of a direction in the world that errs across itself by the receiver's sigma.
ReceiverReading read(const Receiver& receiver, Timestamp time, const Vector3d& direction_world) {
  ReceiverReading reading;
  reading.time = time;
  reading.receiver = receiver.id;
  reading.value = angles_of_direction(receiver.T_world_receiver.linear().transpose() * direction_world);
  return reading;
}

Vector3d disturbed(const Vector3d& direction, double sigma_rad, Random& random) {
  const Vector3d error = normal_vector(random, sigma_rad);
  return (direction + tangent_basis(direction) * error.head<2>()).normalized();
}

Vector3d within_cone(const Vector3d& axis, double full_angle_rad, Random& random) {
  std::uniform_real_distribution<double> even(0.0, 1.0);
  const double height = 1.0 - even(random) * (1.0 - std::cos(0.5 * full_angle_rad));
  const double turn = 2.0 * std::numbers::pi * even(random);
  const double across = std::sqrt(std::max(0.0, 1.0 - height * height));
  return height * axis + across * (tangent_basis(axis) * Eigen::Vector2d(std::cos(turn), std::sin(turn)));
}

// What radio-thermal receivers read beside the direction; by a chance of its own, so that bearings stay what they are.
void read_temperatures(const TargetSceneOptions& options, TargetScene& scene) {
  std::seed_seq stream{options.seed, 3u};
  Random random(stream);
  std::uniform_real_distribution<double> even(options.temperature_k - 0.5 * options.temperature_span_k,
                                              options.temperature_k + 0.5 * options.temperature_span_k);
  std::normal_distribution<double> error(0.0, options.temperature_sigma_k);
  for (TargetPath& path : scene.paths) path.temperature_k = even(random);
  for (ReceiverReading& reading : scene.readings) {
    const double true_k =
        reading.target < 0 ? even(random) : scene.paths[static_cast<std::size_t>(reading.target)].temperature_k;
    const double read_k = true_k + error(random);
    if (reading.receiver > 0) reading.temperature_k = read_k;
  }
}

class Observer {
 public:
  Observer(const TargetSceneOptions& options, TargetScene& scene, Random& random)
      : options_(options), scene_(scene), random_(random) {}

  void observe(int period) {
    const Timestamp begin = period_begin(options_, period);
    const std::vector<Timestamp> ends = scan_ends(options_, begin);
    for (std::size_t k = 0; k < scene_.receivers.size(); ++k) {
      const Receiver& receiver = scene_.receivers[k];
      const std::vector<std::optional<Timestamp>> times = scan_times(options_, receiver, scene_.paths, begin);
      for (std::size_t i = 0; i < scene_.paths.size(); ++i) {
        if (times[i]) see(receiver, scene_.paths[i], *times[i]);
      }
      imagine(receiver, begin, ends[k]);
    }
  }

 private:
  void see(const Receiver& receiver, const TargetPath& path, Timestamp time) {
    const bool is_seen = std::uniform_real_distribution<double>(0.0, 1.0)(random_) < options_.detection_probability;
    const Vector3d sight = position_at(path, time) - receiver.T_world_receiver.translation();
    const double sigma_rad = options_.sigma_m / scene_.range_m;
    const Vector3d direction = disturbed(sight.normalized(), sigma_rad, random_);
    if (!is_seen || time < path.birth || time >= path.death) return;
    scene_.readings.push_back(read(receiver, time, direction));
    scene_.readings.back().target = path.target;
  }

  // False bearings lie about the targets' middle. Where everything is seen at once, so are they.
  void imagine(const Receiver& receiver, Timestamp begin, Timestamp end) {
    if (options_.false_bearings <= 0.0) return;
    const int count = std::poisson_distribution<int>(options_.false_bearings)(random_);
    for (int i = 0; i < count; ++i) {
      const double share = std::uniform_real_distribution<double>(0.0, 1.0)(random_);
      const Timestamp first = options_.scan_law == ScanLaw::Delays ? end : begin;
      const Timestamp time = first + from_seconds(share * to_seconds(end - first));
      const Vector3d axis = middle_at(scene_.paths, time) - receiver.T_world_receiver.translation();
      scene_.readings.push_back(read(receiver, time, within_cone(axis.normalized(), options_.cone_rad, random_)));
    }
  }

  const TargetSceneOptions& options_;
  TargetScene& scene_;
  Random& random_;
};

}  // namespace

void validate(const TargetSceneOptions& o) {
  require(o.receivers >= 1, "receivers", ">= 1", o.receivers);
  require(o.targets >= 1, "targets", ">= 1", o.targets);
  require(o.periods >= 1, "periods", ">= 1", o.periods);
  require(o.period_s > 0.0, "period_s", "> 0 s", o.period_s);
  require(o.least_range_m > 0.0, "least_range_m", "> 0 m", o.least_range_m);
  require(o.greatest_range_m >= o.least_range_m, "greatest_range_m", ">= least_range_m", o.greatest_range_m);
  require(std::abs(o.elevation_rad) < 1.57, "elevation_rad", "within +-1.57 rad", o.elevation_rad);
  require(!o.delays_s.empty(), "delays_s", "at least one delay", 0.0);
  for (const double delay : o.delays_s) require(delay >= 0.0, "delays_s", ">= 0 s", delay);
  require(o.slew_rad_s > 0.0, "slew_rad_s", "> 0 rad/s", o.slew_rad_s);
  require(o.sigma_m >= 0.0, "sigma_m", ">= 0 m", o.sigma_m);
  require(o.spread_m > 0.0, "spread_m", "> 0 m", o.spread_m);
  require(o.row_spacing_m.value_or(0.0) >= 0.0, "row_spacing_m", ">= 0 m", o.row_spacing_m.value_or(0.0));
  require(o.top_speed_m_s > 0.0, "top_speed_m_s", "> 0 m/s", o.top_speed_m_s);
  require(o.agility_m2_s3 >= 0.0, "agility_m2_s3", ">= 0 m^2/s^3", o.agility_m2_s3);
  require(o.detection_probability >= 0.0 && o.detection_probability <= 1.0, "detection_probability", "in [0, 1]",
          o.detection_probability);
  require(o.temperature_sigma_k >= 0.0, "temperature_sigma_k", ">= 0 K", o.temperature_sigma_k);
  require(o.temperature_span_k >= 0.0, "temperature_span_k", ">= 0 K", o.temperature_span_k);
  require(o.false_bearings >= 0.0, "false_bearings", ">= 0", o.false_bearings);
  require(o.cone_rad > 0.0 && o.cone_rad <= 6.28, "cone_rad", "in (0, 6.28] rad", o.cone_rad);
}

Vector3d position_at(const TargetPath& path, Timestamp time) {
  const double t = to_seconds(time - path.origin);
  return path.p0_world + t * path.v_world + 0.5 * t * t * path.a_world + gust_at(path, t).p_m;
}

Vector3d velocity_at(const TargetPath& path, Timestamp time) {
  const double t = to_seconds(time - path.origin);
  return path.v_world + t * path.a_world + gust_at(path, t).v_m_s;
}

TargetSceneOptions paper_table_scene(int targets, const std::vector<double>& delays_s, unsigned seed) {
  TargetSceneOptions options;
  options.receivers = 3;  // the alternative algorithm looks at the first two, whose lines are orthogonal too
  options.targets = targets;
  options.delays_s = delays_s;
  options.row_spacing_m = 3.0;
  options.scatter_m_s = 0.0;
  options.top_speed_m_s = std::numeric_limits<double>::infinity();
  options.seed = seed;
  return options;
}

TargetScene make_target_scene(const TargetSceneOptions& options) {
  validate(options);
  Random random(options.seed);
  TargetScene scene;
  scene.range_m = std::uniform_real_distribution<double>(options.least_range_m, options.greatest_range_m)(random);
  scene.paths = draw_paths(options, random);
  const Timestamp middle = period_begin(options, 0.5 * (options.periods - 1));
  scene.receivers = place_receivers(options, scene.range_m, middle_at(scene.paths, middle));
  Observer observer(options, scene, random);
  for (int period = 0; period < options.periods; ++period) observer.observe(period);
  std::stable_sort(scene.readings.begin(), scene.readings.end(),
                   [](const ReceiverReading& a, const ReceiverReading& b) { return a.time < b.time; });
  if (options.temperature_sigma_k > 0.0) read_temperatures(options, scene);
  return scene;
}

}  // namespace alidade
