// SPDX-License-Identifier: Apache-2.0
#include "app/board_simulation.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/boards/board_drawing.h"
#include "calib/boards/board_pattern.h"
#include "calib/boards/board_text.h"

namespace alidade {
namespace {

// Fine enough for the nearest board: one and a half texels to a pixel, a whole number of them to a square.
PlaneTexture texture_of(const BoardSimulationOptions& options) {
  constexpr double kTexelsPerPixel = 1.5;
  const Board& board = options.board;
  const Eigen::Vector2d size_m = pattern_of(board).extent.sizes();
  const double per_m = kTexelsPerPixel * options.poses.most_fill *
                       std::max(options.camera.width / size_m.x(), options.camera.height / size_m.y());
  const double pixels_per_m = std::ceil(per_m * board.square_m) / board.square_m;
  const BoardDrawing drawing = draw_board(board, pixels_per_m, 0.5 * (board.square_m + board.gap_m));
  return {drawing.image, drawing.pixels_per_m, drawing.origin_px};
}

PlaneRenderOptions rendering_of(const BoardSimulationOptions& options, int i) {
  const Eigen::AlignedBox2d extent = pattern_of(options.board).extent;
  PlaneRenderOptions rendering = options.rendering;
  rendering.bulge = {1e-3 * options.bulge_mm, extent.center(), 0.5 * extent.sizes()};
  rendering.seed = options.seed * 1'000'003U + static_cast<unsigned>(i);  // no two images share their noise
  return rendering;
}

}  // namespace

void validate(const BoardSimulationOptions& o) {
  if (o.images < 1 || o.images > 100'000) {
    throw std::invalid_argument(fmt::format("images must be 1..100000, got {}", o.images));
  }
  if (!(o.bulge_mm.cwiseAbs().array() <= 100).all()) {
    throw std::invalid_argument(
        fmt::format("bulge_mm must be -100..100 mm, got {} and {}", o.bulge_mm.x(), o.bulge_mm.y()));
  }
  if (const auto fault = find_fault(o.camera)) throw std::invalid_argument(*fault);
  validate(o.poses);
  validate(o.rendering);
}

BoardSimulation::BoardSimulation(const BoardSimulationOptions& options)
    : options_((validate(options), options)),
      renderer_(options.camera, texture_of(options)),
      T_camera_board_(
          board_poses(options.camera, pattern_of(options.board).extent, options.images, options.seed, options.poses)) {}

cv::Mat BoardSimulation::image(int i) const {
  return renderer_.render(T_camera_board_.at(static_cast<std::size_t>(i)), rendering_of(options_, i));
}

nlohmann::json summary_of(const BoardSimulationOptions& options, int written) {
  return {{"board", board_text(options.board)},
          {"images", written},
          {"images_wanted", options.images},
          {"width_px", options.camera.width},
          {"height_px", options.camera.height},
          {"bulge_mm", {options.bulge_mm.x(), options.bulge_mm.y()}},
          {"seed", options.seed},
          {"interrupted", written < options.images}};
}

Report report_of(const BoardSimulationOptions& options, const std::vector<cv::Mat>& shown, int written) {
  Report report;
  report.title = "Simulated board";
  const auto row = [](const char* name, const std::string& value, const char* unit) {
    return ReportRow{name, value, unit, Verdict::None, ""};
  };
  report.summary = {row("board", describe(options.board), ""),
                    row("images", fmt::format("{} of {}", written, options.images), ""),
                    row("size", fmt::format("{}x{}", options.camera.width, options.camera.height), "px"),
                    row("blur", fmt::format("{:g}", options.rendering.blur_px), "px"),
                    row("pixel noise", fmt::format("{:g}", options.rendering.noise_grey), "grey levels"),
                    row("bulge", fmt::format("{:g}, {:g}", options.bulge_mm.x(), options.bulge_mm.y()), "mm")};
  if (written < options.images) report.warnings.emplace_back("interrupted: there are fewer images than wanted");
  ReportSection images{"Images", {}, {}, {}};
  for (const auto& image : shown) images.figures.push_back({image, "", FigureFormat::Jpeg});
  report.sections = {images};
  report.links = {{"truth.tum", "true pose of the camera in the board's frame, image i at i seconds (TUM)"},
                  {"camera.yaml", "the true camera"}};
  return report;
}

}  // namespace alidade
