// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include <opencv2/core/mat.hpp>

namespace alidade {

/// Writes an MP4 movie through libav, for VideoWriter, which see.
class MovieWriter {
 public:
  MovieWriter(const std::filesystem::path& path, cv::Size size, double fps_hz, int rate_factor);
  ~MovieWriter();
  MovieWriter(MovieWriter&&) noexcept;
  MovieWriter& operator=(MovieWriter&&) noexcept;

  void write(const cv::Mat& image);
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alidade
