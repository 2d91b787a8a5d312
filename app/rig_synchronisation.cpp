// SPDX-License-Identifier: Apache-2.0
#include "app/rig_synchronisation.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "calib/cameras/view_selection.h"
#include "calib/clocks/synchronised_views.h"
#include "core/errors.h"

namespace alidade {
namespace {

void require_times(const BoardImages& camera) {
  if (!camera.has_times) {
    throw InputError(camera.source, 0, "its images have no times, so that no clock can be found",
                     "give a video, or a folder with times.csv (columns t_ns and image)");
  }
  const auto stuck = std::adjacent_find(camera.views.begin(), camera.views.end(),
                                        [](const BoardView& a, const BoardView& b) { return b.time_s <= a.time_s; });
  if (stuck != camera.views.end()) {
    throw InputError(camera.source, 0,
                     fmt::format("{} is no later than {}, the image before it", std::next(stuck)->name, stuck->name),
                     "correct the times of its images");
  }
}

// From still and distinct views: a lens is to be known before its film tells times.
CameraCalibration calibrate_alone(const BoardImages& camera, const Board& board,
                                  const CameraCalibrationOptions& options, const RunContext& context) {
  std::vector<BoardView> views;
  for (const int i : select_views(camera.views, camera.image)) {
    views.push_back(camera.views[static_cast<std::size_t>(i)]);
  }
  CameraCalibration alone = calibrate_camera(camera.image, board, views, options, context.progress, context.stop);
  const bool is_stopped = alone.outcome == CameraCalibrationOutcome::Stopped;
  if (alone.outcome != CameraCalibrationOutcome::Calibrated && !is_stopped) {
    throw InputError(camera.source, 0, "no calibration: " + explain(alone), "");
  }
  return alone;
}

// Views of common moments, which still tell the image that they are nearest to.
void take_synchronised(RigCalibrationRun& run) {
  std::vector<RigCameraViews> films;
  std::vector<double> offsets_s;
  for (std::size_t c = 0; c < run.images.size(); ++c) {
    films.push_back({run.names[c], run.images[c].image, run.images[c].views});
    offsets_s.push_back(run.clocks[c].offset_s);
  }
  const auto synchronised = synchronise(films, offsets_s);
  run.moments = {MomentsBy::Motion, 0, {}};
  for (std::size_t c = 0; c < synchronised.size(); ++c) {
    std::map<std::string, int> image_of;
    for (const BoardView& view : run.images[c].views) image_of[view.name] = view.frame;
    run.images[c].views = synchronised[c].views;
    auto& moments = run.moments.of_view.emplace_back();
    for (BoardView& view : run.images[c].views) {
      moments.push_back(view.frame);
      run.moments.count = std::max(run.moments.count, view.frame + 1);
      view.frame = image_of.at(view.name);
    }
  }
}

}  // namespace

void synchronise_cameras(RigCalibrationRun& run, const CameraCalibrationOptions& options, const RunContext& context) {
  for (const BoardImages& camera : run.images) require_times(camera);
  FilmedBoard board{shape_of(run.board.board)};
  std::vector<CameraFilm> films;
  for (const BoardImages& camera : run.images) {
    const CameraCalibration alone = calibrate_alone(camera, run.board.board, options, context);
    if (context.stop.stop_requested()) return;
    if (films.empty()) board.warp = alone.fit.bundle.warp;
    films.push_back({alone.camera, BoardFilm(camera.views)});
  }
  std::vector<ClockOffset> clocks(1);
  for (std::size_t c = 1; c < films.size(); ++c) {
    context.progress({"matching the board's motion in " + run.images[c].source, static_cast<std::int64_t>(c),
                      static_cast<std::int64_t>(films.size() - 1), ""});
    clocks.push_back(find_clock_offset(board, films.front(), films[c]));
    if (context.stop.stop_requested()) return;
    if (clocks.back().outcome == ClockOffsetOutcome::Found) continue;
    throw InputError(run.images[c].source, 0,
                     fmt::format("no time offset to {}: {}", run.images[0].source, explain(clocks.back().outcome)), "");
  }
  run.clocks = std::move(clocks);
  take_synchronised(run);
}

}  // namespace alidade
