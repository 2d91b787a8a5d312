// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "calib/bundle/bundle_fit.h"
#include "calib/cameras/camera_start.h"

namespace alidade {

/// What a fit may find beside the board's poses.
struct CameraModel {
  LensModel lens = LensModel::Brown;
  bool free_corners = false;  ///< of the board: for prints that are not regular

  BundleFreedom freedom() const;
};

/// A fit of one camera with one lens to views (frames numbered from 0); empty where there is no start.
std::optional<BundleFit> fit_camera(const CameraModel& model, const ImageExtent& image, const BoardShape& shape,
                                    const std::vector<BundleView>& views, const BundleFitOptions& options);

/// How a model does on views that it was not fitted to.
struct LensTrial {
  CameraModel model;
  double training_rms_px = 0;  ///< of the fit to all views, its own outliers left out
  double held_out_median_px = 0;
  double held_out_rms_px = 0;  ///< of all corners of views that were left out, the board placed by each view alone
};

/// Lengths of residuals of all corners of views that were left out, the board placed by each view alone.
struct HeldOutError {
  double rms_px = 0;
  double median_px = 0;
};

/// k-fold cross-validation: view i is held out in fold i mod `folds`. Empty where a fold has no fit or less than three
/// views to fit.
std::optional<HeldOutError> held_out_error(const CameraModel& model, const ImageExtent& image, const BoardShape& shape,
                                           const std::vector<BundleView>& views, const BundleFitOptions& options,
                                           int folds);

}  // namespace alidade
