// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/epipolar_matching.h"

#include <cmath>
#include <limits>

#include <opencv2/core/hal/hal.hpp>
#include <opencv2/core/utility.hpp>

#include "geometry/rotation.h"

namespace alidade {
namespace {

using NormalisedPixels = Eigen::Matrix3Xf;  // homogeneous; NaN where the lens model has no answer: in no band

NormalisedPixels normalise(const Camera& camera, const PosedFeatures& image) {
  NormalisedPixels x(3, static_cast<Eigen::Index>(image.subset.size()));
  x.setConstant(std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < image.subset.size(); ++i) {
    const auto xy = undistort(camera, image.features.pixels[static_cast<std::size_t>(image.subset[i])]);
    if (xy) x.col(static_cast<Eigen::Index>(i)) << xy->cast<float>(), 1.0f;
  }
  return x;
}

// For every feature of `a` the position in b.subset of its distinct nearest neighbour in the band, or -1.
std::vector<int> nearest_in_band(const PosedFeatures& a, const NormalisedPixels& x_a, const PosedFeatures& b,
                                 const NormalisedPixels& x_b, const Eigen::Matrix3f& E, float band,
                                 const EpipolarOptions& options) {
  std::vector<int> nearest(a.subset.size(), -1);
  const auto match_range = [&](const cv::Range& range) {
    Eigen::RowVectorXf off;
    for (int i = range.start; i < range.end; ++i) {
      const Eigen::Vector3f line = E * x_a.col(i);
      const float limit = band * line.head<2>().norm();
      if (!(limit > 0)) continue;
      off.noalias() = line.transpose() * x_b;
      const float* row = a.features.descriptors.ptr<float>(a.subset[static_cast<std::size_t>(i)]);
      float best = std::numeric_limits<float>::max();
      float second = best;
      for (Eigen::Index j = 0; j < off.cols(); ++j) {
        if (!(std::abs(off(j)) <= limit)) continue;
        const int feature = b.subset[static_cast<std::size_t>(j)];
        const float d = cv::hal::normL2Sqr_(row, b.features.descriptors.ptr<float>(feature), 128);
        if (d < best) {
          second = best;
          best = d;
          nearest[static_cast<std::size_t>(i)] = static_cast<int>(j);
        } else if (d < second) {
          second = d;
        }
      }
      const bool distinct =
          std::sqrt(best) < options.ratio * std::sqrt(second) && std::sqrt(best) < options.most_distance;
      if (!distinct) nearest[static_cast<std::size_t>(i)] = -1;
    }
  };
  cv::parallel_for_(cv::Range(0, static_cast<int>(a.subset.size())), match_range);  // each i writes its own slot only
  return nearest;
}

}  // namespace

std::vector<Match> match_along_epipolar_lines(const Camera& camera, const PosedFeatures& a, const PosedFeatures& b,
                                              const EpipolarOptions& options) {
  const Eigen::Isometry3d T_b_a = b.T_world_camera.inverse() * a.T_world_camera;
  if (!(T_b_a.translation().norm() > 0)) return {};
  const Eigen::Matrix3f E = (skew(T_b_a.translation().normalized()) * T_b_a.linear()).cast<float>();
  const float band = static_cast<float>(options.band_px / (0.5 * (camera.fx + camera.fy)));
  const NormalisedPixels x_a = normalise(camera, a);
  const NormalisedPixels x_b = normalise(camera, b);
  const auto of_a = nearest_in_band(a, x_a, b, x_b, E, band, options);
  const auto of_b = nearest_in_band(b, x_b, a, x_a, E.transpose(), band, options);
  std::vector<Match> matches;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const int j = of_a[i];
    if (j < 0 || of_b[static_cast<std::size_t>(j)] != static_cast<int>(i)) continue;
    matches.push_back({a.subset[i], b.subset[static_cast<std::size_t>(j)]});
  }
  return matches;
}

}  // namespace alidade
