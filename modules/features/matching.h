// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "features/sift.h"

namespace alidade {

/// Feature `a` of one set is taken for feature `b` of another.
struct Match {
  int a = -1;
  int b = -1;
};

/// Matches by descriptor alone (N×128 float32 each): the nearest neighbour, distinctly nearer than the second
/// (distance < ratio × second), and mutual. Source: Lowe 2004.
std::vector<Match> match_descriptors(const cv::Mat& a, const cv::Mat& b, double ratio);

/// The features of an image sorted into square cells, to look around a place quickly.
class FeatureGrid {
 public:
  FeatureGrid(const Features& features, double cell_px);

  /// Indices of the features within `radius_px` of `pixel`, in rising order of cell and index.
  std::vector<int> within(const Eigen::Vector2d& pixel, double radius_px) const;

 private:
  const Features& features_;
  double cell_px_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<int>> cells_;
};

struct GuidedOptions {
  double ratio = 0.85;         ///< of best to second best distance among the candidates in the window
  double most_distance = 210;  ///< RootSIFT bytes, L2; unrelated descriptors lie about 500 apart
};

/// The feature that a descriptor (128 float32) fits best among `candidates`; empty where none is near enough or the
/// second is about as near.
std::optional<int> best_candidate(const Features& features, const std::vector<int>& candidates, const float* descriptor,
                                  const GuidedOptions& options = {});

}  // namespace alidade
