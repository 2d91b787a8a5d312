// SPDX-License-Identifier: Apache-2.0
#include "features/flow.h"

#include <stdexcept>

#include <opencv2/video/tracking.hpp>

namespace alidade {
namespace {

std::vector<cv::Point2f> as_cv(const std::vector<Eigen::Vector2d>& points) {
  std::vector<cv::Point2f> result;
  result.reserve(points.size());
  for (const auto& p : points) result.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  return result;
}

void follow(const FlowImage& from, const FlowImage& to, const std::vector<cv::Point2f>& points,
            std::vector<cv::Point2f>& found, std::vector<unsigned char>& ok, const FlowOptions& options) {
  std::vector<float> error;
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.003);
  cv::calcOpticalFlowPyrLK(from.pyramid, to.pyramid, points, found, ok, error,
                           cv::Size(options.window_px, options.window_px), options.levels, until,
                           cv::OPTFLOW_USE_INITIAL_FLOW, options.least_eigenvalue);
}

}  // namespace

FlowImage make_flow_image(const cv::Mat& grey, const FlowOptions& options) {
  FlowImage image;
  image.grey = grey;
  cv::buildOpticalFlowPyramid(grey, image.pyramid, cv::Size(options.window_px, options.window_px), options.levels);
  return image;
}

std::vector<std::optional<Eigen::Vector2d>> follow_points(const FlowImage& from, const FlowImage& to,
                                                          const std::vector<Eigen::Vector2d>& points,
                                                          const std::vector<Eigen::Vector2d>& guesses,
                                                          const FlowOptions& options) {
  if (points.size() != guesses.size()) throw std::invalid_argument("follow_points: one guess per point");
  std::vector<std::optional<Eigen::Vector2d>> result(points.size());
  if (points.empty()) return result;
  const std::vector<cv::Point2f> start = as_cv(points);
  std::vector<cv::Point2f> forward = as_cv(guesses);
  std::vector<cv::Point2f> back = start;
  std::vector<unsigned char> ok, back_ok;
  follow(from, to, start, forward, ok, options);
  follow(to, from, forward, back, back_ok, options);
  const cv::Rect2f frame(0, 0, static_cast<float>(to.grey.cols - 1), static_cast<float>(to.grey.rows - 1));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!ok[i] || !back_ok[i] || !frame.contains(forward[i])) continue;
    if (cv::norm(back[i] - start[i]) > options.most_return_px) continue;
    result[i] = Eigen::Vector2d(forward[i].x, forward[i].y);
  }
  return result;
}

}  // namespace alidade
