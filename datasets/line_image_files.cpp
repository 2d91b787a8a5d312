// SPDX-License-Identifier: Apache-2.0
#include "datasets/line_image_recording.h"

#include "io/image_files.h"
#include "io/line_images.h"

namespace alidade {

void write_line_images(const LineImageScene& scene, int rows, const std::filesystem::path& directory) {
  const LineImageNoise noise = noise_of(scene.look);
  LineImageSet set;
  set.rate_hz = scene.rate_hz;
  set.spot_sigma_px = scene.look.spot_sigma_px;
  set.read_noise = noise.read;
  set.counts_per_electron = noise.shot;
  set.signs = scene.signs;
  for (const LineDetector& detector : scene.detectors) {
    write_image(directory / line_image_name(detector.id), render_line_image(scene, detector, rows));
  }
  write_line_image_set(directory, set);  // last: with it the recording is whole
}

}  // namespace alidade
