// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/residual_field.h"

#include <algorithm>
#include <cmath>

namespace alidade {
namespace {

constexpr int kLeastCorners = 6;

struct CellSums {
  std::vector<Eigen::Vector2d> sum;
  std::vector<double> squares;
};

ResidualField empty_field(const Camera& camera, int columns) {
  ResidualField field;
  field.columns = columns;
  field.rows = std::max(1, static_cast<int>(std::lround(static_cast<double>(columns) * camera.height / camera.width)));
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      ResidualCell cell;
      cell.centre_px << (column + 0.5) * camera.width / columns - 0.5, (row + 0.5) * camera.height / field.rows - 0.5;
      field.cells.push_back(cell);
    }
  }
  return field;
}

std::size_t cell_of(const ResidualField& field, const Camera& camera, const Eigen::Vector2d& pixel) {
  const int column =
      std::clamp(static_cast<int>((pixel.x() + 0.5) * field.columns / camera.width), 0, field.columns - 1);
  const int row = std::clamp(static_cast<int>((pixel.y() + 0.5) * field.rows / camera.height), 0, field.rows - 1);
  return static_cast<std::size_t>(row * field.columns + column);
}

// A mean of n residuals of variance s² has s²/n of noise in its square.
void judge(const CellSums& sums, ResidualField& field) {
  double within = 0, means = 0, expected = 0;
  int corners = 0, cells = 0;
  for (std::size_t i = 0; i < field.cells.size(); ++i) {
    const ResidualCell& cell = field.cells[i];
    if (cell.count < kLeastCorners) continue;
    const double scatter = sums.squares[i] - cell.count * cell.mean_px.squaredNorm();
    within += scatter;
    corners += cell.count - 1;
    means += cell.mean_px.squaredNorm();
    expected += scatter / (cell.count * (cell.count - 1.0));
    ++cells;
  }
  if (cells == 0) return;
  field.noise_px = std::sqrt(within / corners);
  field.systematic_px = std::sqrt(std::max(0.0, (means - expected) / cells));
}

}  // namespace

ResidualField residual_field(const BundleFit& fit, const BoardShape& shape, int camera, int columns) {
  const Camera& lens = fit.bundle.cameras[static_cast<std::size_t>(camera)].camera;
  ResidualField field = empty_field(lens, columns);
  CellSums sums{std::vector<Eigen::Vector2d>(field.cells.size(), Eigen::Vector2d::Zero()),
                std::vector<double>(field.cells.size(), 0.0)};
  for (const BundleView& view : fit.views) {
    if (view.camera != camera) continue;
    const auto residuals = residuals_px(fit.bundle, shape, view);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (view.weights[i] <= 0) continue;
      const std::size_t cell = cell_of(field, lens, view.corners[i].pixel);
      sums.sum[cell] += residuals[i];
      sums.squares[cell] += residuals[i].squaredNorm();
      ++field.cells[cell].count;
    }
  }
  for (std::size_t i = 0; i < field.cells.size(); ++i) {
    if (field.cells[i].count > 0) field.cells[i].mean_px = sums.sum[i] / field.cells[i].count;
  }
  judge(sums, field);
  return field;
}

double coverage(const ResidualField& field) {
  const auto seen = std::count_if(field.cells.begin(), field.cells.end(), [](const auto& c) { return c.count > 0; });
  return field.cells.empty() ? 0.0 : static_cast<double>(seen) / static_cast<double>(field.cells.size());
}

}  // namespace alidade
