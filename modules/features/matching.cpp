// SPDX-License-Identifier: Apache-2.0
#include "features/matching.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/core/hal/hal.hpp>
#include <opencv2/features2d.hpp>

namespace alidade {
namespace {

std::vector<int> distinct_neighbours(const cv::Mat& a, const cv::Mat& b, double ratio) {
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_L2).knnMatch(a, b, nearest, 2);
  std::vector<int> neighbour(static_cast<std::size_t>(a.rows), -1);
  for (const auto& pair : nearest) {
    if (pair.size() < 2 || pair[0].distance >= ratio * pair[1].distance) continue;
    neighbour[static_cast<std::size_t>(pair[0].queryIdx)] = pair[0].trainIdx;
  }
  return neighbour;
}

}  // namespace

std::vector<Match> match_descriptors(const cv::Mat& a, const cv::Mat& b, double ratio) {
  if (a.rows < 2 || b.rows < 2) return {};
  const std::vector<int> neighbour = distinct_neighbours(a, b, ratio);
  // Mutual: only the rows that were chosen have to choose back.
  std::vector<int> chosen;
  for (int j : neighbour) {
    if (j >= 0) chosen.push_back(j);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  if (chosen.empty()) return {};
  cv::Mat chosen_rows(static_cast<int>(chosen.size()), b.cols, b.type());
  for (std::size_t k = 0; k < chosen.size(); ++k) b.row(chosen[k]).copyTo(chosen_rows.row(static_cast<int>(k)));
  std::vector<cv::DMatch> back;
  cv::BFMatcher(cv::NORM_L2).match(chosen_rows, a, back);
  std::vector<int> nearest_a(static_cast<std::size_t>(b.rows), -1);
  for (const cv::DMatch& m : back) nearest_a[static_cast<std::size_t>(chosen[m.queryIdx])] = m.trainIdx;

  std::vector<Match> matches;
  for (int i = 0; i < a.rows; ++i) {
    const int j = neighbour[static_cast<std::size_t>(i)];
    if (j >= 0 && nearest_a[static_cast<std::size_t>(j)] == i) matches.push_back({i, j});
  }
  return matches;
}

FeatureGrid::FeatureGrid(const Features& features, double cell_px) : features_(features), cell_px_(cell_px) {
  Eigen::Vector2d far = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& pixel : features.pixels) far = far.cwiseMax(pixel);
  columns_ = static_cast<int>(far.x() / cell_px) + 1;
  rows_ = static_cast<int>(far.y() / cell_px) + 1;
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int i = 0; i < features.size(); ++i) {
    const Eigen::Vector2d& pixel = features.pixels[static_cast<std::size_t>(i)];
    const int column = std::clamp(static_cast<int>(pixel.x() / cell_px), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(pixel.y() / cell_px), 0, rows_ - 1);
    cells_[static_cast<std::size_t>(row * columns_ + column)].push_back(i);
  }
}

std::vector<int> FeatureGrid::within(const Eigen::Vector2d& pixel, double radius_px) const {
  const auto cell_of = [this](double coordinate, int count) {
    return std::clamp(static_cast<int>(std::floor(coordinate / cell_px_)), 0, count - 1);
  };
  std::vector<int> found;
  for (int row = cell_of(pixel.y() - radius_px, rows_); row <= cell_of(pixel.y() + radius_px, rows_); ++row) {
    for (int column = cell_of(pixel.x() - radius_px, columns_); column <= cell_of(pixel.x() + radius_px, columns_);
         ++column) {
      for (int i : cells_[static_cast<std::size_t>(row * columns_ + column)]) {
        if ((features_.pixels[static_cast<std::size_t>(i)] - pixel).norm() <= radius_px) found.push_back(i);
      }
    }
  }
  return found;
}

std::optional<int> best_candidate(const Features& features, const std::vector<int>& candidates, const float* descriptor,
                                  const GuidedOptions& options) {
  int best = -1;
  float nearest = std::numeric_limits<float>::max();
  float second = nearest;
  for (int i : candidates) {
    const float squared = cv::hal::normL2Sqr_(features.descriptors.ptr<float>(i), descriptor, 128);
    if (squared < nearest) {
      second = nearest;
      nearest = squared;
      best = i;
    } else {
      second = std::min(second, squared);
    }
  }
  if (best < 0 || std::sqrt(nearest) > options.most_distance) return std::nullopt;
  if (std::sqrt(nearest) >= options.ratio * std::sqrt(second)) return std::nullopt;
  return best;
}

}  // namespace alidade
