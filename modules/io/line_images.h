// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "camera/marker_sign.h"
#include "core/time.h"

namespace alidade {

/// The images of one detector, whose rows are its successive exposures.
struct LineImageFiles {
  int detector = 0;                          ///< LineDetector::id
  std::vector<std::filesystem::path> parts;  ///< one after the other, without a gap
};

/// A directory of recorded line images: lines.yaml and, per detector, detector_ID.png or, of a long recording,
/// detector_ID_0.png, detector_ID_1.png, … 8 or 16 bits, grey or colour. Row 0 of all detectors is at first_time.
///
///   rate_hz: 250
///   first_time_s: 0.0                # optional
///   spot_sigma_px: 1.2               # optional, as all below but the markers
///   noise: {read: 7.0, shot: 0.6}    # counts, and counts per electron
///   saturation: 250                  # counts
///   markers:
///     - {id: 1, code: "1110110011100", phase: 0, colour: [0.1, 0.2, 1.0]}   # code, phase, colour: optional;
///                                                                           # colour: blue, green, red
struct LineImageSet {
  double rate_hz = 0.0;
  Timestamp first_time{};
  std::optional<double> spot_sigma_px;
  double read_noise = 0.0;           ///< counts; 0: not known
  double counts_per_electron = 0.0;  ///< 0: not known
  double saturation = 0.0;           ///< counts; 0: the largest value of the images' type
  std::vector<MarkerSign> signs;
  std::vector<LineImageFiles> detectors;  ///< by id
};

/// Reads lines.yaml and lists the images. Throws InputError naming file and line for what is damaged, unknown or
/// impossible in it, a directory without images, an image of no detector, and parts that are missing or doubled.
LineImageSet read_line_image_set(const std::filesystem::path& directory);

/// Writes lines.yaml, whose directory must exist; the images are written by write_image and read by read_line_image
/// (io/image_files.h). Throws DeviceError.
void write_line_image_set(const std::filesystem::path& directory, const LineImageSet& set);

/// "detector_ID.png", or of a part "detector_ID_PART.png".
std::filesystem::path line_image_name(int detector, std::optional<int> part = std::nullopt);

}  // namespace alidade
