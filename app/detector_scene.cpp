// SPDX-License-Identifier: Apache-2.0
#include "app/detector_scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace alidade {
namespace {

// How the view of a camera (x right, y down, z forward) lies in the frame of a model.
Eigen::Matrix3d R_model_view(const LineModel& model) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (std::holds_alternative<Lighthouse1>(model) || std::holds_alternative<Lighthouse2>(model)) {
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // x forward, z up
  } else if (std::holds_alternative<Lighthouse2Full>(model)) {
    R << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // looks along -z, y up
  }
  return R;
}

}  // namespace

void add_detectors(const std::vector<LineDetector>& detectors, const DetectorLook& look, Scene& scene) {
  std::map<std::string, Eigen::AlignedBox3d> stations;
  for (const LineDetector& detector : detectors) {
    CameraPyramid pyramid;
    pyramid.T_world_camera = detector.T_world_station * detector.T_station_detector;
    pyramid.T_world_camera.translation() = centre_world(detector);
    pyramid.T_world_camera.linear() *= R_model_view(detector.model);
    pyramid.colour = look.colour;
    pyramid.depth_m = look.size_m;
    // A line detector sees far to both sides of its focal line, and nothing of where along it.
    if (!std::holds_alternative<PixelAxis>(detector.model)) pyramid.half_extent = {0.55, 0.16};
    scene.cameras.push_back(pyramid);
    stations[detector.station].extend(centre_world(detector));
  }
  constexpr std::size_t kMostLabels = 24;
  if (!look.is_labelled || stations.size() > kMostLabels) return;
  for (const auto& [name, box] : stations) {
    scene.labels.push_back({box.center() + Eigen::Vector3d(0, 0, 1.2 * look.size_m), name, look.colour});
  }
}

void add_station_covariances(const DetectorRig& rig, double most_m, Scene& scene) {
  double largest = 0.0;
  for (const auto& [name, C] : rig.station_covariance) {
    largest = std::max(largest, std::sqrt(C.topLeftCorner<3, 3>().trace()));
  }
  if (rig.station_covariance.empty()) return;
  const double sigmas = enlargement(largest, most_m);
  std::map<std::string, Eigen::Isometry3d> T_world_station;
  for (const LineDetector& detector : rig.detectors) T_world_station[detector.station] = detector.T_world_station;
  for (const auto& [name, C] : rig.station_covariance) {
    const Eigen::Isometry3d& T = T_world_station.at(name);
    const Eigen::Matrix3d C_world = T.linear() * C.topLeftCorner<3, 3>() * T.linear().transpose();
    scene.translucent.push_back(covariance_ellipsoid(T.translation(), C_world, sigmas, palette::kTruth));
  }
  scene.legend.push_back(
      {fmt::format("stations, {:g} standard deviations", sigmas), palette::kTruth, PyramidStyle::Hollow});
}

double enlargement(double sigma_m, double most_m) {
  if (!(sigma_m > 0) || !std::isfinite(sigma_m)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(most_m / sigma_m)));
  return std::max(1.0, 3.0 * decade * sigma_m <= most_m ? 3.0 * decade : decade);
}

}  // namespace alidade
