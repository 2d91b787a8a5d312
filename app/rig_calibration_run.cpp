// SPDX-License-Identifier: Apache-2.0
#include "app/rig_calibration_run.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/boards/board_text.h"

namespace alidade {
namespace {

std::size_t shared_moments(const RigCalibrationRun& run, const PairError& pair) {
  const auto of = [&](int camera) {
    std::vector<int> moments = run.moments.of_view[static_cast<std::size_t>(camera)];
    std::sort(moments.begin(), moments.end());
    return moments;
  };
  std::vector<int> both;
  const auto a = of(pair.first), b = of(pair.second);
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both.size();
}

const std::string& name_of_camera(const RigCalibrationRun& run, int camera) {
  return run.names[static_cast<std::size_t>(camera)];
}

std::string pair_name(const RigCalibrationRun& run, const PairError& pair) {
  return name_of_camera(run, pair.first) + " - " + name_of_camera(run, pair.second);
}

std::string_view name_of(MomentsBy by) {
  switch (by) {
    case MomentsBy::Time:
      return "time";
    case MomentsBy::Number:
      return "the number in their names";
    case MomentsBy::Order:
      return "order";
    case MomentsBy::Motion:
      return "the board's motion";
  }
  return "";
}

nlohmann::json camera_summary(const RigCalibrationRun& run, std::size_t c) {
  const RigCalibration& rig = run.result;
  const CameraCalibration& alone = rig.alone[c];
  nlohmann::json summary{{"name", run.names[c]},
                         {"source", run.images[c].source},
                         {"images", run.images[c].images.size()},
                         {"images_with_board", run.images[c].seen},
                         {"lens", name_of(alone.model.lens)},
                         {"rms_px", rig.camera_rms_px[c]},
                         {"alone_rms_px", alone.rms_px},
                         {"lens_fits", lens_fits(rig.residuals[c])}};
  if (!run.clocks.empty()) {
    summary["clock_offset_s"] = run.clocks[c].offset_s;
    summary["clock_offset_sigma_s"] = run.clocks[c].sigma_s;
  }
  if (alone.held_out_rms_px) summary["held_out_rms_px"] = *alone.held_out_rms_px;
  for (std::size_t i = 0; i < alone.verdicts.size(); ++i) {
    summary["views"].push_back({{"image", run.images[c].views[i].name},
                                {"rms_px", alone.verdicts[i].rms_px},
                                {"verdict", describe(alone.verdicts[i], run.images[c].views[i], run.images[c].views)}});
  }
  return summary;
}

}  // namespace

std::vector<RigCameraViews> rig_views(const RigCalibrationRun& run) {
  std::vector<RigCameraViews> cameras;
  for (std::size_t c = 0; c < run.images.size(); ++c) {
    RigCameraViews camera{run.names[c], run.images[c].image, run.images[c].views};
    for (std::size_t i = 0; i < camera.views.size(); ++i) camera.views[i].frame = run.moments.of_view[c][i];
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

CameraRig rig_of(const RigCalibrationRun& run) {
  const RigCalibration& result = run.result;
  const BundleLayout layout(result.fit.bundle, result.freedom);
  CameraRig rig;
  for (std::size_t c = 0; c < run.names.size(); ++c) {
    const BundleCamera& fitted = result.fit.bundle.cameras[c];
    const int index = static_cast<int>(c);
    RigCamera camera{run.names[c], fitted.camera, fitted.T_rig_camera};
    camera.intrinsics_covariance = intrinsics_covariance(result.covariance, layout, fitted.camera, index);
    if (!run.clocks.empty()) camera.clock_offset_s = run.clocks[c].offset_s;
    if (c > 0) camera.pose_covariance = camera_pose_covariance(result, index);
    rig.cameras.push_back(std::move(camera));
  }
  return rig;
}

void add_warnings(RigCalibrationRun& run) {
  const RigCalibration& rig = run.result;
  if (run.board.is_guessed) {
    run.warnings.push_back(
        fmt::format("the board was guessed: {} (--board {})", describe(run.board.board), board_text(run.board.board)));
  }
  if (run.board.scale_is_assumed) {
    run.warnings.push_back("the size of its squares is assumed: distances between cameras have the wrong scale");
  }
  for (std::size_t c = 0; c < run.names.size(); ++c) {
    const CameraCalibration& alone = rig.alone[c];
    for (std::size_t i = 0; i < alone.verdicts.size(); ++i) {
      if (alone.verdicts[i].use != ViewUse::Rejected) continue;
      const auto& views = run.images[c].views;
      run.warnings.push_back(views[i].name + ": " + describe(alone.verdicts[i], views[i], views));
    }
    if (!lens_fits(rig.residuals[c])) {
      run.warnings.push_back(fmt::format(
          "camera '{}': its lens '{}' does not fit: {:.3f} px of systematic error "
          "remain beside {:.3f} px of noise",
          run.names[c], name_of(alone.model.lens), rig.residuals[c].systematic_px, rig.residuals[c].noise_px));
    }
    if (rig.camera_rms_px[c] > 2.0 * alone.rms_px + 0.05) {
      run.warnings.push_back(
          fmt::format("camera '{}': {:.3f} px together, but {:.3f} px alone: its images may not be "
                      "of the same moments as the others'",
                      run.names[c], rig.camera_rms_px[c], alone.rms_px));
    }
  }
  if (rig.covariance.within_views > 1) {
    run.warnings.push_back(
        fmt::format("corners of an image err together (a board that is not flat, motion, light): "
                    "uncertainties are {:.1f} times those of independent errors",
                    std::sqrt(rig.covariance.within_views)));
  }
}

std::vector<ReportRow> figure_rows(const RigCalibrationRun& run) {
  const RigCalibration& rig = run.result;
  std::vector<ReportRow> rows{
      {"board", describe(run.board.board), "", Verdict::None, run.board.is_guessed ? "guessed" : ""},
      {"moments", std::to_string(run.moments.count), "", Verdict::None,
       fmt::format("images belong together by {}", name_of(run.moments.by))},
      {"reprojection error, RMS of the corners used", fmt::format("{:.3f}", rig.rms_px), "px"}};
  for (std::size_t c = 0; c < run.names.size(); ++c) {
    const bool is_good = lens_fits(rig.residuals[c]) && rig.camera_rms_px[c] <= 2.0 * rig.alone[c].rms_px + 0.05;
    rows.push_back({run.names[c] + ", RMS", fmt::format("{:.3f}", rig.camera_rms_px[c]), "px",
                    is_good ? Verdict::Good : Verdict::Poor,
                    fmt::format("lens {}; alone {:.3f}", name_of(rig.alone[c].model.lens), rig.alone[c].rms_px)});
  }
  for (std::size_t c = 1; c < run.clocks.size(); ++c) {
    const ClockOffset& clock = run.clocks[c];
    rows.push_back({fmt::format("{}, clock offset to {}", run.names[c], run.names[0]),
                    fmt::format("{:.3f} ± {:.3f}", 1e3 * clock.offset_s, 1e3 * clock.sigma_s), "ms", Verdict::None,
                    fmt::format("{:.3f} px at {} moments", clock.rms_px, clock.moments)});
  }
  for (const PairError& pair : rig.pairs) {
    rows.push_back({pair_name(run, pair) + ", epipolar error, RMS", fmt::format("{:.3f}", pair.epipolar_rms_px), "px",
                    pair.epipolar_rms_px < 2.0 * rig.rms_px + 0.05 ? Verdict::Good : Verdict::Poor,
                    fmt::format("{} corners at {} moments", pair.corners, shared_moments(run, pair))});
    rows.push_back({pair_name(run, pair) + ", baseline",
                    fmt::format("{:.3f} ± {:.3f}", 1e3 * pair.baseline_m, 1e3 * pair.baseline_sigma_m), "mm"});
  }
  return rows;
}

nlohmann::json summary_of(const RigCalibrationRun& run) {
  const RigCalibration& rig = run.result;
  nlohmann::json summary{{"board", board_text(run.board.board)},
                         {"board_guessed", run.board.is_guessed},
                         {"moments", run.moments.count},
                         {"moments_by", name_of(run.moments.by)},
                         {"rms_px", rig.rms_px},
                         {"rms_all_px", rig.rms_all_px},
                         {"variance_within_views", rig.covariance.within_views},
                         {"calibration_s", run.calibration_s},
                         {"joint_solve_s", rig.solve_s},
                         {"warnings", run.warnings}};
  for (std::size_t c = 0; c < run.names.size(); ++c) summary["cameras"].push_back(camera_summary(run, c));
  for (const PairError& pair : rig.pairs) {
    summary["pairs"].push_back({{"first", name_of_camera(run, pair.first)},
                                {"second", name_of_camera(run, pair.second)},
                                {"corners", pair.corners},
                                {"epipolar_rms_px", pair.epipolar_rms_px},
                                {"baseline_m", pair.baseline_m},
                                {"baseline_sigma_m", pair.baseline_sigma_m}});
  }
  return summary;
}

}  // namespace alidade
