// SPDX-License-Identifier: Apache-2.0
#include "calib/rigs/rig_calibration.h"

#include <algorithm>
#include <ctime>

#include <fmt/format.h>

#include "calib/rigs/pair_error.h"
#include "calib/rigs/rig_start.h"

namespace alidade {
namespace {

using Outcome = RigCalibrationOutcome;

double processor_time_s() {
  std::timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::vector<PlacedBoard> placed_boards(const RigCameraViews& camera, const CameraCalibration& alone) {
  std::vector<PlacedBoard> boards;
  for (std::size_t i = 0; i < camera.views.size(); ++i) {
    const int repeats = alone.verdicts[i].repeats;
    const std::size_t placed = repeats < 0 ? i : static_cast<std::size_t>(repeats);
    if (alone.verdicts[placed].use == ViewUse::Rejected) continue;
    const int index = alone.frame_of_view[placed];
    boards.push_back({camera.views[i].frame, alone.fit.bundle.T_rig_board[static_cast<std::size_t>(index)],
                      static_cast<int>(camera.views[i].corners.size())});
  }
  return boards;
}

int frame_count(std::span<const RigCameraViews> cameras) {
  int frames = 0;
  for (const RigCameraViews& camera : cameras) {
    for (const BoardView& view : camera.views) frames = std::max(frames, view.frame + 1);
  }
  return frames;
}

// Views of the joint fit: those of moments that a camera placed; a repeated view has its own moment and counts.
std::vector<BundleView> joint_views(std::span<const RigCameraViews> cameras,
                                    std::span<const std::vector<PlacedBoard>> placed, const BundleFitOptions& options) {
  std::vector<BundleView> views;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (const BoardView& view : cameras[c].views) {
      const bool is_placed = std::any_of(placed.begin(), placed.end(), [&](const auto& boards) {
        return std::any_of(boards.begin(), boards.end(), [&](const auto& b) { return b.frame == view.frame; });
      });
      if (!is_placed) continue;
      views.push_back(bundle_view(static_cast<int>(c), view.frame, view.corners, options));
    }
  }
  return views;
}

void fit_jointly(const BoardShape& shape, std::span<const RigCameraViews> cameras,
                 std::span<const std::vector<PlacedBoard>> placed, const std::vector<Eigen::Isometry3d>& T_rig_camera,
                 const CameraCalibrationOptions& options, RigCalibration& rig) {
  BoardBundle start;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    start.cameras.push_back({rig.alone[c].camera, T_rig_camera[c]});
    rig.freedom.intrinsics.push_back(free_intrinsics(rig.alone[c].model.lens));
  }
  start.T_rig_board = place_frames(placed, T_rig_camera, frame_count(cameras));
  const double begin = processor_time_s();
  rig.fit = fit_bundle(start, shape, joint_views(cameras, placed, options.fit), rig.freedom, options.fit);
  rig.freedom.corners = std::any_of(rig.alone.begin(), rig.alone.end(),
                                    [](const CameraCalibration& alone) { return alone.model.free_corners; });
  rig.freedom.warp = !rig.freedom.corners;
  if (rig.freedom.corners) rig.fit = fit_corners(rig.fit, shape, rig.freedom, options.fit);
  rig.solve_s = processor_time_s() - begin;
}

// Whether a camera fits much worse with the others than alone, or must drop most of its views to fit.
bool disagrees(const std::vector<BundleView>& own, double rms_px, double alone_px) {
  const auto dropped = std::count_if(own.begin(), own.end(), [](const BundleView& view) {
    const auto cut = std::count(view.weights.begin(), view.weights.end(), 0.0);
    return 2 * cut > static_cast<std::ptrdiff_t>(view.weights.size());
  });
  constexpr double kLeastNoise = 0.01;  // px; no detector does better
  return rms_px > 3.0 * std::max(alone_px, kLeastNoise) || 2 * dropped > static_cast<std::ptrdiff_t>(own.size());
}

void measure_cameras(const BoardShape& shape, RigCalibration& rig) {
  for (int c = 0; c < static_cast<int>(rig.fit.bundle.cameras.size()); ++c) {
    std::vector<BundleView> own;
    std::copy_if(rig.fit.views.begin(), rig.fit.views.end(), std::back_inserter(own),
                 [c](const BundleView& view) { return view.camera == c; });
    rig.camera_rms_px.push_back(rms_px(rig.fit.bundle, shape, own));
    rig.residuals.push_back(residual_field(rig.fit, shape, c));
    const double alone_px = rig.alone[static_cast<std::size_t>(c)].rms_px;
    if (disagrees(own, rig.camera_rms_px.back(), alone_px)) rig.failed.push_back(c);
  }
}

void judge(const BoardShape& shape, RigCalibration& rig) {
  rig.rms_px = rms_px(rig.fit.bundle, shape, rig.fit.views);
  rig.rms_all_px = rms_px(rig.fit.bundle, shape, rig.fit.views, true);
  measure_cameras(shape, rig);
  rig.outcome = Outcome::Disagreeing;
  if (!rig.failed.empty()) return;
  const auto covariance = bundle_covariance(rig.fit, shape, rig.freedom);
  rig.outcome = covariance ? Outcome::Calibrated : Outcome::Undetermined;
  if (!covariance) return;
  rig.covariance = *covariance;
  for (const CameraCalibration& alone : rig.alone) {
    rig.covariance.left_out = std::max(rig.covariance.left_out, alone.covariance.left_out);
  }
  rig.covariance.shared_and_motion *= rig.covariance.left_out;
  for (int c = 0; c < static_cast<int>(rig.fit.bundle.cameras.size()); ++c) {
    for (int first = 0; first < c; ++first) {
      if (const auto pair = pair_error(rig.fit, rig.freedom, rig.covariance, first, c)) rig.pairs.push_back(*pair);
    }
  }
}

}  // namespace

RigCalibration calibrate_rig(const Board& board, std::span<const RigCameraViews> cameras,
                             const CameraCalibrationOptions& options, const ProgressSink& progress,
                             const std::stop_token& stop) {
  RigCalibration rig;
  std::vector<std::vector<PlacedBoard>> placed;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    rig.alone.push_back(calibrate_camera(cameras[c].image, board, cameras[c].views, options, progress, stop));
    if (rig.alone.back().outcome == CameraCalibrationOutcome::Stopped) {
      rig.outcome = Outcome::Stopped;
      return rig;
    }
    if (rig.alone.back().outcome != CameraCalibrationOutcome::Calibrated) {
      rig.outcome = Outcome::CameraFailed;
      rig.failed = {static_cast<int>(c)};
      return rig;
    }
    placed.push_back(placed_boards(cameras[c], rig.alone.back()));
  }
  const auto chained = chain_cameras(placed);
  if (const auto* untied = std::get_if<Untied>(&chained)) {
    rig.outcome = Outcome::Untied;
    rig.failed = untied->cameras;
    return rig;
  }
  const BoardShape shape = shape_of(board);
  fit_jointly(shape, cameras, placed, std::get<std::vector<Eigen::Isometry3d>>(chained), options, rig);
  judge(shape, rig);
  return rig;
}

std::string explain(const RigCalibration& rig, std::span<const RigCameraViews> cameras) {
  const auto name = [&] { return cameras[static_cast<std::size_t>(rig.failed.front())].name; };
  switch (rig.outcome) {
    case Outcome::Calibrated:
      return "";
    case Outcome::CameraFailed:
      return fmt::format("camera '{}': {}", name(), explain(rig.alone[static_cast<std::size_t>(rig.failed.front())]));
    case Outcome::Untied:
      return fmt::format(
          "camera '{}' never sees the board at a moment at which the others do; show it the board "
          "together with one of them, and check that images of one moment bear the same number",
          name());
    case Outcome::Disagreeing:
      return fmt::format(
          "camera '{}' and the others do not show the same board at the same moments; check that images of one "
          "moment bear the same number, and that no camera was moved on the rig in between",
          name());
    case Outcome::Undetermined:
      return "the images do not determine where the cameras stand; show the board to more of them at once";
    case Outcome::Stopped:
      return "stopped";
  }
  return "";
}

Matrix6d camera_pose_covariance(const RigCalibration& rig, int index) {
  const BundleLayout layout(rig.fit.bundle, rig.freedom);
  return rig.covariance.shared_and_motion.block<6, 6>(layout.pose_at(index), layout.pose_at(index));
}

}  // namespace alidade
