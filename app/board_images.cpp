// SPDX-License-Identifier: Apache-2.0
#include "app/board_images.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include "app/frame_sources.h"
#include "calib/boards/board_detection.h"
#include "calib/boards/board_guess.h"
#include "calib/boards/board_text.h"
#include "calib/cameras/view_selection.h"
#include "capture/file_sources.h"
#include "core/errors.h"

namespace alidade {
namespace {

constexpr int kFilm = 100;  // more images than anybody photographs one by one
constexpr std::size_t kGuessImages = 8;

cv::Mat to_grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

cv::Mat to_thumbnail(const cv::Mat& grey) {
  const double factor = std::min(1.0, 480.0 / grey.cols);
  cv::Mat small;
  cv::resize(grey, small, {}, factor, factor, cv::INTER_AREA);
  return small;
}

std::unique_ptr<FrameSource> open_images_of_board(const std::string& source) {
  if (!is_camera_name(source)) return open_files(source);
  throw InputError(source, 0, "is a live camera",
                   "take its views with 'alidade guide " + source + " -o capture' and give capture/images");
}

std::vector<cv::Mat> first_images(FrameSource& frames) {
  std::vector<cv::Mat> greys;
  while (greys.size() < kGuessImages) {
    const auto frame = frames.next();
    if (!frame) break;
    greys.push_back(to_grey(frame->image).clone());
  }
  return greys;
}

struct Found {
  Frame frame;
  cv::Mat grey;
  std::optional<BoardView> view;
};

// The next frames, with the board looked for in all at once.
std::vector<Found> next_batch(FrameSource& frames, const Board& board) {
  constexpr std::size_t kBatch = 8;
  std::vector<Found> batch;
  while (batch.size() < kBatch) {
    auto frame = frames.next();
    if (!frame) break;
    batch.push_back({std::move(*frame), {}, {}});
  }
  tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
    batch[i].grey = to_grey(batch[i].frame.image);
    batch[i].view = detect_board(batch[i].grey, board);
  });
  return batch;
}

void keep(Found& found, BoardImages& images) {
  if (images.images.empty()) images.image = {found.grey.cols, found.grey.rows};
  BoardImage image{found.frame.name, found.view.has_value(), {}};
  if (found.view) {
    image.thumbnail = to_thumbnail(found.grey);
    if (images.views.empty()) images.sample = found.frame.image.clone();
    found.view->name = found.frame.name;
    found.view->frame = static_cast<int>(images.images.size());
    found.view->time_s = std::chrono::duration<double>(found.frame.time.time_since_epoch()).count();
    images.views.push_back(std::move(*found.view));
  }
  images.images.push_back(std::move(image));
}

// Markers say which way round they are; a mirrored chessboard is as good a chessboard.
bool is_mirrored(const std::vector<cv::Mat>& greys, const Board& board) {
  if (board.kind == BoardKind::Chessboard) return false;
  return std::any_of(greys.begin(), greys.end(), [&](const cv::Mat& grey) {
    cv::Mat flipped;
    cv::flip(grey, flipped, 1);
    return detect_board(flipped, board).has_value();
  });
}

[[noreturn]] void refuse_without_board(const BoardImages& images, const Board& board) {
  const std::vector<cv::Mat> greys = first_images(*open_files(images.source));
  if (is_mirrored(greys, board)) {
    throw InputError(images.source, 0, fmt::format("the images show a mirrored {}", describe(board)),
                     "switch off the mirroring of the camera or of the program that took them");
  }
  const auto other = guess_board(greys);
  const std::size_t count = images.images.size();
  std::string remedy = "check that the whole board is in the image, sharp and evenly lit";
  if (other && !(other->board == board)) {
    remedy = fmt::format("they seem to show a {}: give --board {}", describe(other->board), board_text(other->board));
    if (other->board.kind == BoardKind::Chessboard && board.kind == BoardKind::Chessboard &&
        other->board.columns * other->board.rows < board.columns * board.rows) {
      remedy += ", or show the whole board (a ChArUco board may be seen in part)";
    }
  }
  throw InputError(images.source, 0,
                   fmt::format("no {} in {}", describe(board),
                               count == 1 ? "the only image" : fmt::format("any of {} images", count)),
                   remedy);
}

}  // namespace

BoardChoice choose_board(const std::string& text, const std::string& source) {
  if (!text.empty()) return {parse_board(text), false, false};
  return choose_board(text, source, *open_images_of_board(source));
}

BoardChoice choose_board(const std::string& text, const std::string& source, FrameSource& frames) {
  if (!text.empty()) return {parse_board(text), false, false};
  const std::vector<cv::Mat> greys = first_images(frames);
  const auto guess = guess_board(greys);
  if (!guess) {
    throw InputError(source, 0, fmt::format("no calibration board is seen in the first {} images", greys.size()),
                     "say which it is with --board, e.g. --board chessboard:9x6:25mm");
  }
  return {guess->board, true, guess->scale_is_assumed};
}

BoardImages read_board_images(const std::string& source, const Board& board, const RunContext& context,
                              FilmViews kept) {
  const auto frames = open_images_of_board(source);
  const auto count = frames->frame_count();
  BoardImages images;
  images.source = source;
  images.has_times = frames->has_times();
  while (!context.stop.stop_requested()) {
    std::vector<Found> batch = next_batch(*frames, board);
    if (batch.empty()) break;
    for (Found& found : batch) keep(found, images);
    context.progress(
        {"finding the board in " + source, static_cast<std::int64_t>(images.images.size()), count.value_or(0), ""});
  }
  if (const auto fault = frames->fault()) context.warn(source + ": " + *fault);
  images.seen = static_cast<int>(images.views.size());
  if (images.views.empty() && !context.stop.stop_requested()) refuse_without_board(images, board);
  if (images.seen > kFilm && kept == FilmViews::StillAndDistinct) {
    std::vector<BoardView> chosen;
    for (const int i : select_views(images.views, images.image)) {
      chosen.push_back(std::move(images.views[static_cast<std::size_t>(i)]));
    }
    images.views = std::move(chosen);
  }
  return images;
}

}  // namespace alidade
