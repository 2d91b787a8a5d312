// SPDX-License-Identifier: Apache-2.0
#include "calib/guide/capture_coverage.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

// Corners a little outside of the image count for the cell at its border.
std::size_t cell_of(const ImageExtent& image, const CoverageOptions& options, const Eigen::Vector2d& pixel) {
  const auto place = [](double at, int size, int count) {
    return std::clamp(static_cast<int>((at + 0.5) * count / size), 0, count - 1);
  };
  const int column = place(pixel.x(), image.width, options.columns), row = place(pixel.y(), image.height, options.rows);
  return static_cast<std::size_t>(row * options.columns + column);
}

}  // namespace

void validate(const CoverageOptions& o) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(o.columns >= 1, fmt::format("columns must be >= 1, got {}", o.columns));
  require(o.rows >= 1, fmt::format("rows must be >= 1, got {}", o.rows));
  require(o.corners_per_cell >= 1, fmt::format("corners_per_cell must be >= 1, got {}", o.corners_per_cell));
  require(o.least_tilt_deg > 0 && o.least_tilt_deg <= 45,
          fmt::format("least_tilt_deg must lie in (0, 45], got {}", o.least_tilt_deg));
  require(o.near_share <= 0.8, fmt::format("near_share must be <= 0.8, got {}", o.near_share));
  require(o.far_share > 0 && o.far_share <= o.near_share,
          fmt::format("far_share must lie in (0, near_share], got {}", o.far_share));
  require(o.position_share >= 0 && o.position_share <= 1,
          fmt::format("position_share must lie in [0, 1], got {}", o.position_share));
}

CaptureCoverage coverage_of(const ImageExtent& image, std::span<const BoardView> views,
                            std::span<const std::optional<BoardStance>> stances, const CoverageOptions& options) {
  if (stances.size() != views.size()) throw std::invalid_argument("as many stances as views are needed");
  CaptureCoverage coverage;
  coverage.corners.assign(static_cast<std::size_t>(options.columns * options.rows), 0);
  for (const BoardView& view : views) {
    for (const BoardCorner& corner : view.corners) ++coverage.corners[cell_of(image, options, corner.pixel)];
  }
  for (const auto& stance : stances) {
    if (!stance) continue;
    for (std::size_t i = 0; i < kTilts.size(); ++i) coverage.tilted[i] += stance->tilt == kTilts[i];
    coverage.near += stance->image_share >= options.near_share;
    coverage.far += stance->image_share <= options.far_share;
  }
  return coverage;
}

CoverageShares shares_of(const CaptureCoverage& coverage, const CoverageOptions& options) {
  const auto filled = std::count_if(coverage.corners.begin(), coverage.corners.end(),
                                    [&](int corners) { return corners >= options.corners_per_cell; });
  const auto tilted =
      std::count_if(coverage.tilted.begin(), coverage.tilted.end(), [](int views) { return views > 0; });
  return {static_cast<double>(filled) / static_cast<double>(coverage.corners.size()), static_cast<double>(tilted) / 4,
          0.5 * ((coverage.near > 0) + (coverage.far > 0))};
}

bool is_complete(const CoverageShares& shares, const CoverageOptions& options) {
  return shares.positions >= options.position_share && shares.tilts >= 1 && shares.distances >= 1;
}

Eigen::Vector2d cell_centre_px(const ImageExtent& image, const CoverageOptions& options, int column, int row) {
  return {(column + 0.5) * image.width / options.columns - 0.5, (row + 0.5) * image.height / options.rows - 0.5};
}

}  // namespace alidade
