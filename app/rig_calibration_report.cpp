// SPDX-License-Identifier: Apache-2.0
#include "app/rig_calibration_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "app/camera_calibration_report.h"
#include "app/scene_picture.h"
#include "io/image_files.h"
#include "io/rig_file.h"
#include "view/report.h"

namespace alidade {
namespace {

std::vector<std::string> names_by_moment(const RigCalibrationRun& run, std::size_t camera) {
  std::vector<std::string> names(static_cast<std::size_t>(run.moments.count));
  for (std::size_t i = 0; i < run.moments.of_view[camera].size(); ++i) {
    names[static_cast<std::size_t>(run.moments.of_view[camera][i])] = run.images[camera].views[i].name;
  }
  return names;
}

ReportSection poses_section(const RigCalibrationRun& run) {
  ReportTable table{"", {"camera", "x (mm)", "y (mm)", "z (mm)", "sigma (mm)", "turned (deg)", "sigma (mdeg)"}, {}};
  const double deg = 180.0 / std::numbers::pi;
  for (const RigCamera& camera : rig_of(run).cameras) {
    const Eigen::Vector3d t = 1e3 * camera.T_rig_camera.translation();
    const auto sigma = [&](int first) {
      return camera.pose_covariance ? std::sqrt(camera.pose_covariance->diagonal().segment<3>(first).sum()) : 0.0;
    };
    table.rows.push_back({camera.name, fmt::format("{:.2f}", t.x()), fmt::format("{:.2f}", t.y()),
                          fmt::format("{:.2f}", t.z()), fmt::format("{:.2f}", 1e3 * sigma(0)),
                          fmt::format("{:.3f}", deg * rotation_angle(camera.T_rig_camera.linear())),
                          fmt::format("{:.1f}", 1e3 * deg * sigma(3))});
  }
  return {"Where the cameras stand",
          {"In the frame of the first one; standard deviations of all three axes together."},
          {},
          {},
          {table}};
}

}  // namespace

Scene scene_of(const RigCalibrationRun& run) {
  Scene scene;
  const BoardBundle& bundle = run.result.fit.bundle;
  const auto corners = corners_m(run.board.board);
  const Eigen::Vector3d end = corners.back();
  const std::vector<Eigen::Vector3d> outline{{0, 0, 0}, {end.x(), 0, 0}, {end.x(), end.y(), 0}, {0, end.y(), 0}};
  Eigen::AlignedBox3d box;
  for (std::size_t f = 0; f < bundle.T_rig_board.size(); ++f) {
    const bool is_seen = std::any_of(run.result.fit.views.begin(), run.result.fit.views.end(),
                                     [f](const BundleView& view) { return view.frame == static_cast<int>(f); });
    if (!is_seen) continue;
    ScenePath path{{}, palette::kReference, 1.0};
    for (const std::size_t i : {0, 1, 2, 3, 0}) path.points_world.push_back(bundle.T_rig_board[f] * outline[i]);
    for (const Eigen::Vector3d& point : path.points_world) box.extend(point);
    scene.paths.push_back(std::move(path));
  }
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    box.extend(bundle.cameras[c].T_rig_camera.translation());
  }
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    const auto& [camera, T_rig_camera] = bundle.cameras[c];
    const Eigen::Vector2d half(0.5 * camera.width / camera.fx, 0.5 * camera.height / camera.fy);
    scene.cameras.push_back({T_rig_camera, curve_colour(c), PyramidStyle::Hollow, 0.12 * box.diagonal().norm(), half});
    scene.labels.push_back({T_rig_camera.translation(), run.names[c], curve_colour(c)});
  }
  scene.up_world = -Eigen::Vector3d::UnitY();
  scene.legend = {{"boards", palette::kReference, PyramidStyle::Hollow}};
  return scene;
}

void write_rig_calibration(RigCalibrationRun& run, const ResultDirectory& directory,
                           const std::vector<std::string>& arguments, const std::string& options_yaml) {
  const RigCalibration& rig = run.result;
  write_camera_rig(directory.path("rig.yaml"), rig_of(run));
  Report report;
  report.title = fmt::format("Calibration of {} cameras", run.names.size());
  report.arguments = arguments;
  const auto scene = draw_scene(scene_of(run), {0.6, 0.35, 1.0}, "the rig", run.warnings);
  report.summary = figure_rows(run);
  report.warnings = run.warnings;
  report.sections.push_back(poses_section(run));
  if (scene) {
    write_image(directory.path("scene.png"), *scene);
    report.sections.back().figures.push_back({*scene, "", FigureFormat::Png});
  }
  report.links = {{"rig.yaml", "all cameras with their poses and covariances"}};
  const BoardShape shape = shape_of(run.board.board);
  for (std::size_t c = 0; c < run.names.size(); ++c) {
    const std::string& name = run.names[c];
    const int index = static_cast<int>(c);
    write_corners(directory.path(name + "-corners.csv"), rig.fit, shape, index, names_by_moment(run, c));
    report.links.push_back({name + "-corners.csv", "every corner with its residual"});
    auto section = camera_section({rig.fit, rig.freedom, rig.covariance, rig.residuals[c], index}, run.board.board,
                                  name + "-", directory);
    section.title = "Camera " + name;
    report.sections.push_back(std::move(section));
    auto bad = bad_views_section(rig.fit, index, run.images[c].views, run.moments.of_view[c], run.images[c]);
    bad.title = "Images of " + name + " with corners that were cut";
    report.sections.push_back(std::move(bad));
    report.sections.push_back(undistorted_section(rig.fit.bundle.cameras[c].camera, run.images[c].sample));
  }
  report.options = options_yaml;
  directory.write_text("options.yaml", options_yaml);
  write_report(directory.path("report.html"), report);
}

}  // namespace alidade
