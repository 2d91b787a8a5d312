// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>

#include <opencv2/core/mat.hpp>

#include "app/reading_source.h"
#include "io/line_images.h"
#include "marker1d/line_signal.h"

namespace alidade {

/// Readings from a recording of line images: spots are found in the rows of all detectors and told apart by the codes
/// and colours of lines.yaml. One part of each detector's images is in memory at a time.
class LineImageSource : public ReadingSource {
 public:
  /// Throws InputError for a directory that is no such recording, an image of a detector that is not there or has no
  /// line of pixels, a marker of no body, and markers that cannot be told apart.
  LineImageSource(const std::filesystem::path& directory, std::span<const LineDetector> detectors,
                  std::span<const RigidBody> bodies, std::stop_token stop);

  /// Throws InputError for an image that is damaged, has another width than its detector, or ends before the others.
  std::optional<LineReading> next() override;
  SourceExtent extent() const override;
  bool finds_readings() const override { return true; }
  std::vector<DetectorSignal> signals() const override;

 private:
  // A detector's images, as far as they were read.
  struct Strip {
    LineImageFiles files;
    int width = 0;  // px; of the detector
    std::size_t next_part = 0;
    cv::Mat image;  // the part at hand
    int next_row = 0;
    std::int64_t rows = 0, bytes = 0;  // of the parts before
    std::int64_t part_bytes = 0;       // of the part at hand

    bool is_used_up() const { return next_row == image.rows; }
    const std::filesystem::path& path() const { return files.parts[next_part - 1]; }
  };

  LineSignalOptions options_of(const Strip& strip) const;
  void read_part(Strip& strip) const;
  bool read_parts();
  std::vector<cv::Mat> next_rows();

  std::stop_token stop_;
  LineImageSet set_;
  std::vector<Strip> strips_;
  std::optional<LineSignals> signals_;
  std::deque<LineReading> readings_;
  std::int64_t bytes_ = 0;  // of all images
  bool is_finished_ = false;
};

}  // namespace alidade
