// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "calib/bundle/bundle_fit.h"
#include "calib/bundle/projection_uncertainty.h"
#include "calib/cameras/residual_field.h"
#include "view/plot.h"

namespace alidade {

/// Where corners were seen in one camera's image; those that were cut are marked.
cv::Mat draw_coverage(const BundleFit& fit, int camera);

/// Every corner's residual as an arrow, much enlarged (the scale is written), and the cells' means as thick ones.
cv::Mat draw_residuals(const BundleFit& fit, const BoardShape& shape, const ResidualField& field, int camera);

/// How uncertain a pixel is, over the image, with lines of equal uncertainty written in px.
cv::Mat draw_uncertainty(const UncertaintyMap& map, const Camera& camera);

/// A bar of a bar chart.
struct Bar {
  std::string name;
  double value = 0;
  bool is_bad = false;
};

/// Bars side by side, the bad ones in another colour, names below them turned upwards.
cv::Mat draw_bars(const std::string& title, const std::vector<Bar>& bars);

/// Residuals along the radius and across it, by distance from the principal point.
Plot radial_residual_plot(const BundleFit& fit, const BoardShape& shape, int camera);

}  // namespace alidade
