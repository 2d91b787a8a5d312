// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/camera_calibration_run.h"
#include "app/result_directory.h"

namespace alidade {

/// One camera of a joint fit, for the pictures that judge it.
struct FittedCamera {
  const BundleFit& fit;
  const BundleFreedom& freedom;
  const BundleCovariance& covariance;
  const ResidualField& residuals;
  int camera = 0;
};

/// Coverage, residuals over the image and by radius, and the uncertainty map of a camera; each is also written to the
/// directory as PREFIXcoverage.png and so on.
ReportSection camera_section(const FittedCamera& of, const Board& board, const std::string& prefix,
                             const ResultDirectory& directory);

/// `sample` without distortion, beside the original.
ReportSection undistorted_section(const Camera& camera, const cv::Mat& sample);

/// Images whose corners were cut, with the cut ones marked.
ReportSection bad_views_section(const BundleFit& fit, int camera, const std::vector<BoardView>& views,
                                const std::vector<int>& frame_of_view, const BoardImages& images);

/// Writes camera.yaml (with covariance), views.csv, corners.csv, pictures, options.yaml and report.html; the commit is
/// the caller's.
void write_camera_calibration(const CameraCalibrationRun& run, const ResultDirectory& directory,
                              const std::vector<std::string>& arguments, const std::string& options_yaml);

/// The images' corners, one row each: image, corner, x_px, y_px, sigma_px, residual_x_px, residual_y_px, used.
void write_corners(const std::filesystem::path& path, const BundleFit& fit, const BoardShape& shape, int camera,
                   const std::vector<std::string>& names_by_frame);

}  // namespace alidade
