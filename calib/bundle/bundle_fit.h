// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "calib/bundle/board_bundle.h"

namespace alidade {

struct BundleFitOptions {
  double least_sigma_px = 0.1;    ///< added to the corners' own: print and light err where the image shows no noise
  double outlier_sigmas = 4.0;    ///< a corner beyond it is cut: one in 3000 of a normal distribution in the plane
  double view_scale_limit = 3.0;  ///< a view's own scatter counts up to this many times that of all
  bool weigh_views = true;        ///< a view that scatters more than the middle one counts less, by its variance
  int most_rounds = 8;
};

/// A view with every corner trusted alike, none better than options.least_sigma_px.
BundleView bundle_view(int camera, int frame, std::vector<BoardCorner> corners, const BundleFitOptions& options);

/// A bundle with the corners that it goes by.
struct BundleFit {
  BoardBundle bundle;
  std::vector<BundleView> views;   ///< as given, with weights of 0 for corners that were cut
  double scale = 1;                ///< standard deviation of one coordinate in units of the corners' sigma_px
  std::vector<double> view_scale;  ///< the same of each view alone, from its median
  int iterations = 0;              ///< of the solver, in all
  bool converged = false;
};

/// The bundle of least squares of all corners that agree with it: solved with weights that fade, then without the
/// corners beyond outlier_sigmas of their view's scatter, until none changes sides.
BundleFit fit_bundle(const BoardBundle& start, const BoardShape& shape, std::vector<BundleView> views,
                     const BundleFreedom& freedom, const BundleFitOptions& options = {});

/// A fit with the board's corners free, from one that took the board as bulging at most.
BundleFit fit_corners(const BundleFit& fit, const BoardShape& shape, const BundleFreedom& freedom,
                      const BundleFitOptions& options = {});

/// Median length of the residuals of all corners, px; 0 for none.
double median_px(const BoardBundle& bundle, const BoardShape& shape, std::span<const BundleView> views);

/// Root mean square length of the residuals of the corners with weight (all: also of those without), px; 0 for none.
double rms_px(const BoardBundle& bundle, const BoardShape& shape, std::span<const BundleView> views, bool all = false);

}  // namespace alidade
