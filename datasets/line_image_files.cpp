// SPDX-License-Identifier: Apache-2.0
#include "datasets/line_image_files.h"

#include "io/image_files.h"
#include "io/line_images.h"

namespace alidade {

LineImageFilesWriter::LineImageFilesWriter(const LineImageScene& scene, const std::filesystem::path& directory)
    : scene_(scene), directory_(directory) {}

void LineImageFilesWriter::write(const LineImageBlock& block) {
  for (std::size_t d = 0; d < block.images.size(); ++d) {
    write_image(directory_ / line_image_name(scene_.detectors[d].id, parts_), block.images[d]);
  }
  ++parts_;
}

void LineImageFilesWriter::commit() {
  const LineImageNoise noise = noise_of(scene_.look);
  LineImageSet set;
  set.rate_hz = scene_.scene.rate_hz;
  set.spot_sigma_px = scene_.look.spot_sigma_px;
  set.read_noise = noise.read;
  set.counts_per_electron = noise.shot;
  set.signs = scene_.signs;
  write_line_image_set(directory_, set);
}

}  // namespace alidade
