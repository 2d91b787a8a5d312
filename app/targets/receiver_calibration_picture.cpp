// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "app/targets/receiver_scene.h"
#include "view/canvas.h"

namespace alidade {
namespace {

constexpr double kFarOut = 8.0;  // times the median: not drawn, else nothing else is seen

double reach_px(const CalibratedReceiver& one) {
  return kFarOut * std::max(0.05, one.after.median_px.value_or(1.0));
}

ScenePath path_of(const ReceiverCalibrationRun& run) {
  constexpr double kLongestGap_s = 1.5;
  ScenePath path;
  path.colour = run.has_truth() ? palette::kTruth : palette::kEstimate;
  for (std::size_t i = 0; i < run.path.size(); ++i) {
    if (i > 0 && to_seconds(run.path[i].time - run.path[i - 1].time) > kLongestGap_s) {
      path.points_world.push_back(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    path.points_world.push_back(run.path[i].p);
  }
  return path;
}

// 1, 2 or 5 times a power of ten, not above `value`.
double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  return value >= 5 * power ? 5 * power : value >= 2 * power ? 2 * power : power;
}

struct CellMean {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero(), residual_px = Eigen::Vector2d::Zero();
  int count = 0;
};

// By a grid over the image, `columns` wide.
std::vector<CellMean> cell_means(const CalibratedReceiver& one, int columns) {
  const double cell_px = static_cast<double>(one.given.camera->width) / columns;
  std::map<std::pair<int, int>, CellMean> cells;
  for (const SightResidualSample& sample : one.after.samples) {
    if (sample.residual_px.norm() > reach_px(one)) continue;
    const Eigen::Vector2i place = (sample.pixel / cell_px).array().floor().cast<int>();
    CellMean& cell = cells[{place.x(), place.y()}];
    cell.pixel += sample.pixel;
    cell.residual_px += sample.residual_px;
    ++cell.count;
  }
  constexpr int kLeast = 5;
  std::vector<CellMean> means;
  for (auto& [place, cell] : cells) {
    if (cell.count < kLeast) continue;
    cell.pixel /= cell.count;
    cell.residual_px /= cell.count;
    means.push_back(cell);
  }
  return means;
}

}  // namespace

Scene scene_of(const ReceiverCalibrationRun& run) {
  Scene scene;
  scene.up_world = Eigen::Vector3d::UnitZ();
  Eigen::AlignedBox3d box;
  for (const TimedPosition& position : run.path) box.extend(position.p);
  std::vector<Receiver> given, found;
  for (const CalibratedReceiver& one : run.receivers) {
    if (one.is_calibrated()) given.push_back(one.given);
    found.push_back(one.found);
  }
  const double size_m = receiver_size_m(found, box);
  add_receivers(given, size_m, scene);
  for (CameraPyramid& pyramid : scene.cameras) pyramid.colour = palette::kReference;
  scene.labels.clear();  // they are named where they are
  scene.legend = {{"calibrated receivers as given", palette::kReference, PyramidStyle::Hollow}};
  add_receivers(found, size_m, scene);
  scene.legend.back().text = "receivers now";
  scene.paths.push_back(path_of(run));
  scene.legend.push_back({run.has_truth() ? "the known path" : "the path, found with them", scene.paths.back().colour,
                          PyramidStyle::Solid});
  return scene;
}

Plot residuals_over_time(const CalibratedReceiver& one) {
  Series u{"u", {}, {}, SeriesStyle::Dots, curve_colour(0)}, v{"v", {}, {}, SeriesStyle::Dots, curve_colour(1)};
  int left_off = 0;
  for (const SightResidualSample& sample : one.after.samples) {
    if (sample.residual_px.norm() > reach_px(one)) {
      ++left_off;
      continue;
    }
    u.x.push_back(sample.t_s);
    u.y.push_back(sample.residual_px.x());
    v.x.push_back(sample.t_s);
    v.y.push_back(sample.residual_px.y());
  }
  Plot plot{fmt::format("Residuals of {} over time ({} of {} beyond {:.1f} px are left off)", name_of(one.given),
                        left_off, one.after.samples.size(), reach_px(one)),
            "time (s)",
            "residual (px)",
            {},
            false,
            false};
  plot.series = {std::move(u), std::move(v)};
  return plot;
}

cv::Mat draw_residuals(const CalibratedReceiver& one) {
  constexpr double kWidth = 720.0, kMargin = 28.0;  // px; above it, a line of text
  const Camera& camera = *one.given.camera;
  const double scale = kWidth / camera.width;
  const double enlarged = round_down(0.025 * camera.width / std::max(0.05, one.after.median_px.value_or(1.0)));
  Canvas canvas({static_cast<int>(kWidth) + 1, static_cast<int>(camera.height * scale + kMargin) + 1}, palette::kPaper);
  const auto at = [&](const Eigen::Vector2d& pixel) {
    return cv::Point2d((pixel.x() + 0.5) * scale, (pixel.y() + 0.5) * scale + kMargin);
  };
  canvas.write(fmt::format("{}: residuals, enlarged {:.0f} times; thick: means of cells, {:.0f} times",
                           name_of(one.given), enlarged, 2 * enlarged),
               {4, 0.5 * kMargin}, {{14}, palette::kInk, Anchor::Left});
  const cv::Point2d a = at({-0.5, -0.5}), c = at({camera.width - 0.5, camera.height - 0.5});
  const std::vector<cv::Point2d> frame{a, {c.x, a.y}, c, {a.x, c.y}, a};
  canvas.draw_polyline(frame, {{200, 200, 206}, 1.0});
  for (const SightResidualSample& sample : one.after.samples) {
    if (sample.residual_px.norm() > reach_px(one)) continue;
    canvas.draw_line(at(sample.pixel), at(sample.pixel + enlarged * sample.residual_px), {palette::kReference, 0.6});
  }
  for (const CellMean& cell : cell_means(one, 24)) {
    canvas.draw_disc(at(cell.pixel), 2.5, palette::kEstimate);
    canvas.draw_line(at(cell.pixel), at(cell.pixel + 2 * enlarged * cell.residual_px), {palette::kEstimate, 3.0});
  }
  return canvas.picture();
}

}  // namespace alidade
