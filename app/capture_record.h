// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <opencv2/core.hpp>

#include "app/result_directory.h"
#include "calib/boards/board.h"
#include "calib/guide/capture_guide.h"
#include "core/time.h"
#include "view/report.h"

namespace alidade {

/// A frame that the guide took.
struct AcceptedImage {
  std::string file;  ///< below the result directory
  int frame = 0;     ///< of the source
  Timestamp time{};
};

/// A guided capture, for those who tell of it.
struct CaptureRecord {
  std::string source;  ///< FrameSource::describe
  Board board;
  ImageExtent image;
  double enough_px = 0;
  int frames = 0, boards = 0;  ///< seen, and of these with the board
  std::vector<AcceptedImage> accepted;
  std::vector<std::optional<BoardStance>> stances;  ///< of these
  GuideStep last;
  cv::Mat sample;  ///< the last accepted frame
  std::vector<std::string> warnings;
  bool interrupted = false;
};

/// What a front end shows of a frame, one JSON object; numbers that are not known are left out.
nlohmann::json guide_event(int frame, double time_s, const GuideStep& step);

/// "hold the board at the top left, its left side 30 deg nearer, filling 60 % of the image".
std::string describe(const CaptureWish& wish, const ImageExtent& image);

/// What still keeps a capture from being enough, in words; empty where it is.
std::vector<std::string> missing_words(const CaptureRecord& record);

/// Writes views.csv: the accepted images, how the board stands in them.
void write_views(const CaptureRecord& record, const ResultDirectory& directory);

/// The content of summary.json.
nlohmann::json summary_of(const CaptureRecord& record);

Report report_of(const CaptureRecord& record, const std::vector<std::string>& arguments, const std::string& options);

}  // namespace alidade
