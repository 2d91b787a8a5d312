// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "camera/detector_rig.h"

namespace alidade {

/// Reads a rig of line detectors, our YAML (T_a_b maps points of b into a):
///
///   stations:                 # what stands rigidly together
///     - name: north
///       T_world_station: {translation_m: [2, 0, 1.5], quaternion_wxyz: [1, 0, 0, 0]}
///       covariance: [...]     # may be left out: upper triangle by rows (21) of the 6×6 covariance of the right
///                             # perturbation (translation, rotation) of T_world_station; m², m·rad, rad²
///   detectors:
///     - id: 0
///       station: north
///       model: lighthouse1    # focal_line, line_camera, lighthouse1, lighthouse2, lighthouse2_full, pixel
///       sweep: 0              # of a lighthouse: 0 or 1
///       terms: {phase: 0.018, tilt: -0.005, curve: 0.004, gibmag: 0.017, gibphase: 1.7, ogeemag: 0, ogeephase: 0}
///       sigma_rad: 1e-4       # of a reading; may be left out (1e-4 rad, 0.5 px)
///       T_station_detector: {translation_m: [0, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}  # may be left out: identity
///     - {id: 4, station: south, model: line_camera, width_px: 2048, intrinsics_px: {f: 1500, c: 1023.5},
///        distortion: {k1: -0.1, k2: 0, k3: 0}, sigma_px: 0.1}
///     - {id: 5, station: south, model: pixel, axis: x, camera: {model: pinhole, ...}}  # as in a camera file
///
/// Throws InputError, with the line where there is one, for a file that is none or is damaged, a key or model that is
/// not known, an id that two detectors have, a station that is not listed, and what is no number or no pose.
DetectorRig read_detector_rig(const std::filesystem::path& path);

/// Writes our YAML; read_detector_rig gives the rig back, rotations to the last digit but one. Stations come in the
/// order of their first detector. Throws DeviceError where the file system refuses, std::invalid_argument where two
/// detectors of a station have different T_world_station.
void write_detector_rig(const std::filesystem::path& path, const DetectorRig& rig);

/// Says what is impossible about a detector's model or noise ("sweep must be 0 or 1, got 2"); empty where nothing is.
std::optional<std::string> find_fault(const LineDetector& detector);

}  // namespace alidade
