// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace alidade {

/// Options of a texture of fallen leaves: figures of all sizes over each other, the smaller ones on top, with fractal
/// noise. Like natural pictures it has structure at every scale, so that features are found near and far.
struct LeafTextureOptions {
  Eigen::Vector2d size_m{1.0, 1.0};  ///< what it covers
  double texel_m = 0.003;            ///< resolution
  double largest_m = 0.25;           ///< radius of the largest figures
  double smallest_m = 0.008;         ///< and of the smallest
  double coverage = 0.5;             ///< of the area by the largest figures; smaller ones cover less, as radius^0.7
  cv::Vec3d tone{150, 150, 150};     ///< BGR, the mean colour of the figures
  double noise_grey = 9.0;           ///< amplitude of the fractal noise, grey levels
  std::uint64_t seed = 1;
};

/// The texture, CV_8UC3 (BGR), of size_m / texel_m pixels (at least 8 × 8). The same seed gives the same bytes, and the
/// same figures at another resolution. Source of the model: Lee, Mumford, Huang, Occlusion models for natural images,
/// IJCV 2001.
cv::Mat leaf_texture(const LeafTextureOptions& options);

}  // namespace alidade
