// SPDX-License-Identifier: Apache-2.0
#include "io/video_writer.h"

#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <opencv2/core.hpp>

#include "core/time.h"
#include "io/lossless_encoder.h"
#include "io/matroska_writer.h"
#include "io/movie_writer.h"

namespace alidade {

struct VideoWriter::State {
  std::filesystem::path path;
  cv::Size size;
  VideoOptions options;
  std::optional<MovieWriter> movie;
  std::optional<LosslessEncoder> encoder;  // these two from the first frame on, which says what is to be packed
  std::optional<MatroskaWriter> lossless;
  int image_type = -1;  // of the first frame
  std::int64_t next_index = 0;
  bool closed = false;

  void start_lossless();
  void write(const cv::Mat& image);
  std::chrono::nanoseconds time_of(std::int64_t index) const {
    return from_seconds(static_cast<double>(index) / options.fps_hz);
  }
};

void VideoWriter::State::start_lossless() {
  encoder.emplace(LosslessFormat{image_type == CV_8UC1 ? PixelLayout::Grey8 : PixelLayout::Bgr24, size});
  lossless.emplace(path, encoder->track(time_of(1)));
}

void VideoWriter::State::write(const cv::Mat& image) {
  if (movie) {
    movie->write(image);
  } else {
    if (!lossless) start_lossless();
    lossless->write(time_of(next_index), encoder->encode(image));
  }
  ++next_index;
}

VideoWriter::VideoWriter(const std::filesystem::path& path, cv::Size size, const VideoOptions& options)
    : state_(std::make_unique<State>()) {
  if (size.width <= 0 || size.height <= 0) throw std::invalid_argument("VideoWriter: the size must be > 0 px");
  if (!(options.fps_hz > 0) || !std::isfinite(options.fps_hz)) {
    throw std::invalid_argument("VideoWriter: fps_hz must be > 0");
  }
  state_->path = path;
  state_->size = size;
  state_->options = options;
  if (options.kind == VideoKind::Movie) state_->movie.emplace(path, size, options.fps_hz, options.rate_factor);
}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

void VideoWriter::write(const cv::Mat& image) {
  State& s = *state_;
  const bool type_fits = image.type() == CV_8UC1 || image.type() == CV_8UC3;
  if (s.closed) throw std::invalid_argument("VideoWriter::write after close");
  if (!type_fits || image.size() != s.size) throw std::invalid_argument("VideoWriter::write: another size or type");
  if (s.image_type < 0) s.image_type = image.type();
  if (image.type() != s.image_type) throw std::invalid_argument("VideoWriter::write: grey and colour in one video");
  s.write(image);
}

void VideoWriter::close() {
  State& s = *state_;
  if (s.closed) throw std::invalid_argument("VideoWriter::close twice");
  if (s.next_index == 0) throw std::invalid_argument("VideoWriter::close: a video needs a frame");
  if (s.movie) s.movie->close();
  if (s.lossless) s.lossless->close();
  s.closed = true;
}

}  // namespace alidade
