// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/two_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "geometry/rotation.h"
#include "geometry/triangulation.h"

namespace alidade {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kConfidence = 0.9999;

// The pairs that the camera model can undistort, in normalised coordinates.
struct NormalisedPairs {
  std::vector<cv::Point2d> a, b;
  std::vector<int> index;
};

NormalisedPairs normalise(const Camera& camera, const std::vector<PixelPair>& pairs) {
  NormalisedPairs result;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto a = undistort(camera, pairs[i].a);
    const auto b = undistort(camera, pairs[i].b);
    if (!a || !b) continue;
    result.a.emplace_back(a->x(), a->y());
    result.b.emplace_back(b->x(), b->y());
    result.index.push_back(static_cast<int>(i));
  }
  return result;
}

Eigen::Vector3d direction(const cv::Point2d& p) {
  return Eigen::Vector3d(p.x, p.y, 1.0).normalized();
}

// The pairs among `candidates` whose rays meet in front of both cameras, and the median angle at which they meet.
struct Frontal {
  std::vector<int> members;
  double median_parallax_deg = 0;
};

Frontal find_frontal(const NormalisedPairs& pairs, const std::vector<int>& candidates, const Eigen::Isometry3d& T_a_b,
                     double threshold) {
  Frontal frontal;
  std::vector<double> angles;
  for (int k : candidates) {
    const Eigen::Vector3d da = direction(pairs.a[static_cast<std::size_t>(k)]);
    const Eigen::Vector3d db = T_a_b.linear() * direction(pairs.b[static_cast<std::size_t>(k)]);
    const Ray rays[] = {{Eigen::Vector3d::Zero(), da, threshold}, {T_a_b.translation(), db, threshold}};
    const auto meeting = intersect_rays(rays, 1e-6);
    if (!meeting) continue;
    const Eigen::Vector3d p_b = T_a_b.inverse() * meeting->p_world;
    const Eigen::Vector2d off_a = meeting->p_world.head<2>() / meeting->p_world.z() - da.head<2>() / da.z();
    const auto& b = pairs.b[static_cast<std::size_t>(k)];
    const Eigen::Vector2d off_b = p_b.head<2>() / p_b.z() - Eigen::Vector2d(b.x, b.y);
    if (std::max(off_a.norm(), off_b.norm()) > 1.5 * threshold) continue;
    frontal.members.push_back(k);
    angles.push_back(meeting->largest_angle_rad);
  }
  if (angles.empty()) return frontal;
  const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
  std::nth_element(angles.begin(), middle, angles.end());
  frontal.median_parallax_deg = *middle / kDegree;
  return frontal;
}

std::vector<int> marked(const cv::Mat& mask) {
  std::vector<int> indices;
  for (int i = 0; i < static_cast<int>(mask.total()); ++i) {
    if (mask.at<unsigned char>(i)) indices.push_back(i);
  }
  return indices;
}

// x_b = R_b_a (x_a - t) in OpenCV's words p_b = R p_a + t; ours is T_a_b.
Eigen::Isometry3d from_opencv(const cv::Mat& R, const cv::Mat& t) {
  Eigen::Isometry3d T_b_a = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  cv::cv2eigen(R, rotation);
  cv::cv2eigen(t, translation);
  T_b_a.linear() = rotation;
  T_b_a.translation() = translation.normalized();
  return T_b_a.inverse();
}

struct Candidate {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  Frontal frontal;
};

Candidate best_of(const NormalisedPairs& pairs, const std::vector<int>& inliers,
                  const std::vector<Eigen::Isometry3d>& poses, double threshold, std::size_t* runner_up = nullptr) {
  Candidate best;
  std::size_t second = 0;
  for (const Eigen::Isometry3d& T : poses) {
    Frontal frontal = find_frontal(pairs, inliers, T, threshold);
    if (frontal.members.size() > best.frontal.members.size()) {
      second = best.frontal.members.size();
      best = {T, std::move(frontal)};
    } else {
      second = std::max(second, frontal.members.size());
    }
  }
  if (runner_up) *runner_up = second;
  return best;
}

Candidate from_essential(const NormalisedPairs& pairs, const cv::Mat& E, const std::vector<int>& inliers,
                         double threshold) {
  cv::Mat R1, R2, t;
  cv::decomposeEssentialMat(E.rowRange(0, 3), R1, R2, t);
  return best_of(pairs, inliers, {from_opencv(R1, t), from_opencv(R1, -t), from_opencv(R2, t), from_opencv(R2, -t)},
                 threshold);
}

// A plane leaves up to two motions; fit only if one of them explains clearly more points.
std::optional<Candidate> from_plane(const NormalisedPairs& pairs, const cv::Mat& H, const std::vector<int>& inliers,
                                    double threshold) {
  std::vector<cv::Mat> rotations, translations, normals;
  cv::decomposeHomographyMat(H, cv::Mat::eye(3, 3, CV_64F), rotations, translations, normals);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    if (cv::norm(translations[i]) > 1e-6) poses.push_back(from_opencv(rotations[i], translations[i]));
  }
  std::size_t runner_up = 0;
  Candidate best = best_of(pairs, inliers, poses, threshold, &runner_up);
  if (static_cast<double>(runner_up) > 0.7 * static_cast<double>(best.frontal.members.size())) return std::nullopt;
  return best;
}

TwoViewOutcome judge(const TwoViewGeometry& g, std::size_t pair_count, const TwoViewOptions& options) {
  if (static_cast<int>(g.inliers.size()) < options.least_inliers ||
      static_cast<double>(g.inliers.size()) < options.least_share * static_cast<double>(pair_count)) {
    // Far points meet nowhere: without parallax few pairs are frontal, and that is the better reason to give.
    if (g.homography_share > options.planar_share && g.median_parallax_deg < options.least_parallax_deg) {
      return TwoViewOutcome::TooLittleParallax;
    }
    return TwoViewOutcome::NoCommonMotion;
  }
  if (g.median_parallax_deg < options.least_parallax_deg) return TwoViewOutcome::TooLittleParallax;
  return TwoViewOutcome::Solved;
}

}  // namespace

TwoViewGeometry solve_two_views(const Camera& camera, const std::vector<PixelPair>& all_pairs,
                                const TwoViewOptions& options) {
  TwoViewGeometry result;
  const NormalisedPairs pairs = normalise(camera, all_pairs);
  if (static_cast<int>(pairs.a.size()) < options.least_inliers) return result;
  const double threshold = options.threshold_px / (0.5 * (camera.fx + camera.fy));

  cv::Mat mask;
  const cv::Mat E =
      cv::findEssentialMat(pairs.a, pairs.b, 1.0, cv::Point2d(), cv::RANSAC, kConfidence, threshold, mask);
  if (E.empty()) {
    result.outcome = TwoViewOutcome::NoCommonMotion;
    return result;
  }
  const std::vector<int> inliers = marked(mask);
  cv::Mat plane_mask;
  const cv::Mat H = cv::findHomography(pairs.a, pairs.b, cv::RANSAC, 2.0 * threshold, plane_mask, 2000, kConfidence);
  const std::vector<int> plane_inliers = H.empty() ? std::vector<int>{} : marked(plane_mask);
  result.homography_share =
      inliers.empty() ? 0.0 : static_cast<double>(plane_inliers.size()) / static_cast<double>(inliers.size());

  Candidate chosen = from_essential(pairs, E, inliers, threshold);
  bool ambiguous = false;
  if (result.homography_share > options.planar_share &&
      chosen.frontal.median_parallax_deg >= options.least_parallax_deg) {
    const auto planar = from_plane(pairs, H, plane_inliers, threshold);
    ambiguous = !planar;
    if (planar) chosen = *planar;
  }
  result.T_a_b = chosen.T_a_b;
  result.median_parallax_deg = chosen.frontal.median_parallax_deg;
  for (int k : chosen.frontal.members) result.inliers.push_back(pairs.index[static_cast<std::size_t>(k)]);
  result.outcome = ambiguous ? TwoViewOutcome::PlanarAmbiguity : judge(result, pairs.a.size(), options);
  return result;
}

std::string explain(const TwoViewGeometry& g, const TwoViewOptions& options) {
  switch (g.outcome) {
    case TwoViewOutcome::Solved:
      return fmt::format("{} points, parallax {:.1f} deg", g.inliers.size(), g.median_parallax_deg);
    case TwoViewOutcome::TooFewMatches:
      return fmt::format("fewer than {} matches: do the images overlap, and are they sharp?", options.least_inliers);
    case TwoViewOutcome::NoCommonMotion:
      return fmt::format("only {} matches agree on one motion: do the images overlap?", g.inliers.size());
    case TwoViewOutcome::TooLittleParallax:
      return fmt::format(
          "parallax {:.2f} of the {:.1f} deg needed: move the camera sideways, rotation alone gives no depth",
          g.median_parallax_deg, options.least_parallax_deg);
    case TwoViewOutcome::PlanarAmbiguity:
      return "the scene is one plane seen from too little apart: move on, or bring depth into view";
  }
  return {};
}

}  // namespace alidade
