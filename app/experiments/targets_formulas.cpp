// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "app/experiments/targets_experiment.h"
#include "evaluation/statistics.h"
#include "geometry/tangent.h"
#include "uav/paper/paper_accuracy.h"
#include "uav/paper/paper_geometry.h"

namespace alidade {
namespace {

using Eigen::Vector3d;

constexpr int kTrials = 100000;  // a variance is then told to 0.45 %
constexpr double kSigma_m = 0.1;
constexpr double kRange_m = 150.0;

// What errs: the equations, as the formulas have it, or the directions.
enum class Noise { White, Bearings };

// Lines of sight that meet, at 0 and at the angles given; the third and later ones each in a plane of its own.
std::vector<Bearing> lines_at(const std::vector<double>& angles_rad) {
  std::vector<Bearing> lines(1 + angles_rad.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double angle = k == 0 ? 0.0 : angles_rad[k - 1], turn = static_cast<double>(k);
    lines[k].direction_world =
        Vector3d(std::cos(angle), std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn));
    lines[k].origin_world = -kRange_m * lines[k].direction_world;
    lines[k].receiver = static_cast<int>(k);
  }
  return lines;
}

std::vector<Bearing> disturbed(std::vector<Bearing> lines, Noise noise, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, kSigma_m);
  const auto vector = [&] {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vector3d(x, y, z);
  };
  for (Bearing& line : lines) {
    const Vector3d e = vector();
    if (noise == Noise::Bearings) {
      const Vector3d across = tangent_basis(line.direction_world) * e.head<2>() / kRange_m;
      line.direction_world = (line.direction_world + across).normalized();
    } else if (line.receiver > 0) {
      line.origin_world += e;  // b_k errs just as equation k does
    }
  }
  return lines;
}

struct Ranges {
  std::vector<double> first, second, sum;
};

Ranges ranges_of(const std::vector<double>& angles_rad, Noise noise, unsigned seed) {
  std::mt19937_64 random(seed);
  const std::vector<Bearing> lines = lines_at(angles_rad);
  Ranges ranges;
  for (int i = 0; i < kTrials; ++i) {
    const std::vector<Bearing> read = disturbed(lines, noise, random);
    double r1 = 0.0, r2 = 0.0;
    if (read.size() == 2) {
      const auto fix = solve_pair(read[0], read[1]);
      r1 = fix->r1_m, r2 = fix->r2_m;
    } else {
      const auto fix = solve_conjugation(read, PaperMotion::Still);
      r1 = fix->ranges_m[0], r2 = fix->ranges_m[1];
    }
    ranges.first.push_back(r1);
    ranges.second.push_back(r2);
    ranges.sum.push_back(r1 + r2);
  }
  return ranges;
}

double variance_of(const std::vector<double>& values) {
  return std::pow(summarise(values).std, 2);
}

// Monte Carlo variance of (r1, r2, r1 + r2), over K's.
Vector3d ratios_to(const Eigen::Matrix2d& K, const Ranges& ranges) {
  return {variance_of(ranges.first) / K(0, 0), variance_of(ranges.second) / K(1, 1), variance_of(ranges.sum) / K.sum()};
}

void add_pair(int angle_deg, unsigned seed, ExperimentSection& section) {
  const double angle = angle_deg * std::numbers::pi / 180.0;
  const Eigen::Matrix2d K = range_covariance(angle, kSigma_m);
  const Ranges white = ranges_of({angle}, Noise::White, seed), real = ranges_of({angle}, Noise::Bearings, seed);
  const Vector3d own = ratios_to(K, white), beside = ratios_to(K, real);
  const Vector3d derived = ratios_to(range_covariance_of_bearings(angle, kSigma_m, kSigma_m), real);
  const auto text = [](const Vector3d& v) { return fmt::format("{:.3f} {:.3f} {:.3f}", v[0], v[1], v[2]); };
  section.tables[0].rows.push_back({fmt::format("{}", angle_deg), text(own), text(beside), text(derived)});
  section.summary["pair"][std::to_string(angle_deg)] = {{"white", {own[0], own[1], own[2]}},
                                                        {"bearings", {beside[0], beside[1], beside[2]}},
                                                        {"bearings_to_derived", {derived[0], derived[1], derived[2]}}};
}

void add_several(const std::string& name, const std::vector<double>& angles_rad, unsigned seed,
                 ExperimentSection& section) {
  const double formula = std::pow(range_sigma(angles_rad, kSigma_m), 2);
  const double own = variance_of(ranges_of(angles_rad, Noise::White, seed).first) / formula;
  const double beside = variance_of(ranges_of(angles_rad, Noise::Bearings, seed).first) / formula;
  section.tables[1].rows.push_back({name, fmt::format("{:.3f}", own), fmt::format("{:.3f}", beside)});
  section.summary["several"][name] = {{"white", own}, {"bearings", beside}};
}

}  // namespace

ExperimentSection targets_formulas(const ExperimentContext& context) {
  ExperimentSection section{
      "formulas",
      "The paper's formulas 12 and 13",
      {fmt::format("Monte Carlo variance over the formula's, {} trials each, 0.1 m of noise at 150 m.", kTrials),
       "The formulas take the equations to err by white noise. Where the directions err, the equations' errors lie "
       "across the lines of sight and share the first one's; what follows for two receivers stands beside."},
      {{"Two receivers (12): variances of r1, r2 and r1 + r2",
        {"angle (deg)", "white noise", "noise on bearings", "the same over what follows from it"},
        {}},
       {"Three receivers and more (13): variance of r1", {"angles (deg)", "white noise", "noise on bearings"}, {}}},
      {},
      {}};
  for (const int angle_deg : {20, 45, 90, 120}) {
    if (context.stop.stop_requested()) return section;
    add_pair(angle_deg, context.seed, section);
  }
  const double deg = std::numbers::pi / 180.0;
  add_several("90 90", {90 * deg, 90 * deg}, context.seed, section);
  add_several("30 60", {30 * deg, 60 * deg}, context.seed, section);
  add_several("20 45 110", {20 * deg, 45 * deg, 110 * deg}, context.seed, section);
  return section;
}

}  // namespace alidade
