// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "datasets/line_image_scene.h"

namespace alidade {

/// Writes what a scene's detectors record as io/line_images.h reads it: lines.yaml with the codes and the phases of
/// `signs` (none: unknown), and an image per detector and block. Throws DeviceError where the file system refuses.
class LineImageFilesWriter {
 public:
  /// The directory must exist.
  LineImageFilesWriter(const LineImageScene& scene, const std::filesystem::path& directory);

  void write(const LineImageBlock& block);

  /// Once, and last: with lines.yaml the recording is whole.
  void commit();

 private:
  LineImageScene scene_;
  std::filesystem::path directory_;
  int parts_ = 0;
};

}  // namespace alidade
