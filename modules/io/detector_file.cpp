// SPDX-License-Identifier: Apache-2.0
#include "io/detector_file.h"

#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/camera_records.h"
#include "io/pose_yaml.h"

namespace alidade {
namespace {

std::string format_terms(const SweepTerms& t) {
  return fmt::format("{{phase: {}, tilt: {}, curve: {}, gibmag: {}, gibphase: {}, ogeemag: {}, ogeephase: {}}}",
                     t.phase, t.tilt, t.curve, t.gibmag, t.gibphase, t.ogeemag, t.ogeephase);
}

template <typename Sweep>
std::string format_sweep(const char* name, const Sweep& sweep) {
  return fmt::format("    model: {}\n    sweep: {}\n    terms: {}\n", name, sweep.sweep, format_terms(sweep.terms));
}

struct ModelFormat {
  std::string operator()(const FocalLine&) const { return "    model: focal_line\n"; }
  std::string operator()(const LineCamera& m) const {
    return fmt::format(
        "    model: line_camera\n    width_px: {}\n    intrinsics_px: {{f: {}, c: {}}}\n"
        "    distortion: {{k1: {}, k2: {}, k3: {}}}\n",
        m.width, m.f, m.c, m.k1, m.k2, m.k3);
  }
  std::string operator()(const Lighthouse1& m) const { return format_sweep("lighthouse1", m); }
  std::string operator()(const Lighthouse2& m) const { return format_sweep("lighthouse2", m); }
  std::string operator()(const Lighthouse2Full& m) const { return format_sweep("lighthouse2_full", m); }
  std::string operator()(const PixelAxis& m) const {
    return fmt::format("    model: pixel\n    axis: {}\n    camera:\n{}", m.axis == 0 ? "x" : "y",
                       format_camera(m.camera, "      "));
  }
};

struct FindFault {
  std::optional<std::string> operator()(const FocalLine&) const { return std::nullopt; }
  std::optional<std::string> operator()(const LineCamera& m) const {
    if (m.width <= 0) return fmt::format("width must be > 0 px, got {}", m.width);
    if (!(m.f > 0)) return fmt::format("f must be > 0 px, got {}", m.f);
    if (!(m.c > -0.5 && m.c < m.width)) return fmt::format("c must lie in the line (0..{} px), got {}", m.width, m.c);
    return std::nullopt;
  }
  std::optional<std::string> operator()(const PixelAxis& m) const { return find_fault(m.camera); }
  template <typename Sweep>
  std::optional<std::string> operator()(const Sweep& m) const {
    if (m.sweep != 0 && m.sweep != 1) return fmt::format("sweep must be 0 or 1, got {}", m.sweep);
    if (!(std::abs(m.terms.tilt) < 0.5)) return fmt::format("tilt must be within 0.5 rad, got {}", m.terms.tilt);
    return std::nullopt;
  }
};

// Each station once, in the order of the detectors.
std::vector<const LineDetector*> firsts_of_stations(const std::vector<LineDetector>& detectors) {
  std::vector<const LineDetector*> firsts;
  for (const LineDetector& detector : detectors) {
    const auto same = [&](const LineDetector* first) { return first->station == detector.station; };
    const auto found = std::find_if(firsts.begin(), firsts.end(), same);
    if (found == firsts.end()) {
      firsts.push_back(&detector);
    } else if ((*found)->T_world_station.matrix() != detector.T_world_station.matrix()) {
      throw std::invalid_argument("write_detector_rig: a station with two poses: " + detector.station);
    }
  }
  return firsts;
}

}  // namespace

std::optional<std::string> find_fault(const LineDetector& detector) {
  const char* unit = reads_pixels(detector.model) ? "px" : "rad";
  if (!(detector.sigma > 0) || !std::isfinite(detector.sigma)) {
    return fmt::format("sigma must be > 0 {}, got {}", unit, detector.sigma);
  }
  return std::visit(FindFault{}, detector.model);
}

void write_detector_rig(const std::filesystem::path& path, const DetectorRig& rig) {
  std::string text = "# T_a_b maps points of b into a; quaternions in the order w, x, y, z; angles in rad\nstations:\n";
  for (const LineDetector* first : firsts_of_stations(rig.detectors)) {
    text += fmt::format("  - name: {}\n    T_world_station: {}\n", quoted_yaml(first->station),
                        format_pose(first->T_world_station));
    const auto covariance = rig.station_covariance.find(first->station);
    if (covariance == rig.station_covariance.end()) continue;
    text += "    # of the right perturbation (translation, rotation): upper triangle by rows, m2, m rad, rad2\n";
    text += fmt::format("    covariance: {}\n", format_covariance(covariance->second));
  }
  text += "detectors:\n";
  for (const LineDetector& detector : rig.detectors) {
    text += fmt::format("  - id: {}\n    station: {}\n", detector.id, quoted_yaml(detector.station));
    text += std::visit(ModelFormat{}, detector.model);
    text += fmt::format("    {}: {}\n", reads_pixels(detector.model) ? "sigma_px" : "sigma_rad", detector.sigma);
    if (!detector.T_station_detector.isApprox(Eigen::Isometry3d::Identity(), 0)) {
      text += fmt::format("    T_station_detector: {}\n", format_pose(detector.T_station_detector));
    }
  }
  write_file(path, text);
}

}  // namespace alidade
