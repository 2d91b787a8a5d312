// SPDX-License-Identifier: Apache-2.0
#include "tracking/world_frame.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "reconstruction/map_point.h"

namespace alidade {
namespace {

const FrameReport* posed_report(const std::vector<FrameReport>& reports, int frame) {
  const auto found = std::find_if(reports.begin(), reports.end(),
                                  [frame](const FrameReport& r) { return r.index == frame && r.has_pose(); });
  return found == reports.end() ? nullptr : &*found;
}

Matrix6d scaled(Matrix6d covariance, double scale) {
  covariance.topRows<3>() *= scale;
  covariance.leftCols<3>() *= scale;
  return covariance;
}

Eigen::Isometry3d moved(const Similarity& similarity, const Eigen::Isometry3d& T_map_camera) {
  StampedPose pose;
  pose.T_world_camera = T_map_camera;
  return transform(similarity, pose).T_world_camera;
}

using MarkerCorners = std::array<Eigen::Vector3d, 4>;

std::optional<MarkerCorners> triangulate_corners(const Camera& camera, const std::vector<FrameReport>& reports,
                                                 const std::vector<FrameMarkers>& seen, int id) {
  std::array<std::vector<PosedSighting>, 4> sightings;
  for (const FrameMarkers& frame : seen) {
    const FrameReport* report = posed_report(reports, frame.frame);
    if (!report) continue;
    for (const MarkerSighting& marker : frame.markers) {
      if (marker.id != id) continue;
      for (std::size_t c = 0; c < 4; ++c) {
        sightings[c].push_back({report->T_world_camera, Matrix6d::Zero(), marker.corners[c], 0.5});
      }
    }
  }
  MapPointOptions options;
  options.gate_chi2 = 200.0;  // corners are found a few pixels off where a marker is small; the square tells in the end
  MarkerCorners corners;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto corner = triangulate(camera, sightings[c], options);
    if (!corner) return std::nullopt;
    corners[c] = corner->p_world;
  }
  return corners;
}

// Mean side, empty where the four sides differ too much for a square.
std::optional<double> side_of_square(const MarkerCorners& corners) {
  std::array<double, 4> sides;
  for (std::size_t c = 0; c < 4; ++c) sides[c] = (corners[(c + 1) % 4] - corners[c]).norm();
  const auto [shortest, longest] = std::minmax_element(sides.begin(), sides.end());
  if (!(*shortest > 0.95 * *longest)) return std::nullopt;
  return 0.25 * (sides[0] + sides[1] + sides[2] + sides[3]);
}

Eigen::Isometry3d marker_frame(const MarkerCorners& c) {  // corners clockwise from the top left
  const Eigen::Vector3d x = ((c[1] + c[2]) - (c[0] + c[3])).normalized();
  const Eigen::Vector3d up = (c[0] + c[1]) - (c[3] + c[2]);
  const Eigen::Vector3d y = (up - up.dot(x) * x).normalized();
  Eigen::Isometry3d T_map_marker = Eigen::Isometry3d::Identity();
  T_map_marker.linear() << x, y, x.cross(y);
  T_map_marker.translation() = 0.25 * (c[0] + c[1] + c[2] + c[3]);
  return T_map_marker;
}

// Among the frames with poses; -1 where there is none.
int most_frequent_marker(const std::vector<FrameReport>& reports, const std::vector<FrameMarkers>& seen) {
  std::map<int, int> count;
  for (const FrameMarkers& frame : seen) {
    if (!posed_report(reports, frame.frame)) continue;
    for (const MarkerSighting& marker : frame.markers) ++count[marker.id];
  }
  const auto most =
      std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == count.end() ? -1 : most->first;
}

}  // namespace

PointMap transform(const Similarity& similarity, PointMap map) {
  const Eigen::Matrix3d sR = similarity.scale * similarity.T_target_source.linear();
  for (MapPoint& point : map.points) {
    point.p_world = similarity * point.p_world;
    point.covariance_world = sR * point.covariance_world * sR.transpose();
  }
  for (Keyframe& keyframe : map.keyframes) {
    keyframe.T_world_camera = moved(similarity, keyframe.T_world_camera);
    keyframe.covariance = scaled(keyframe.covariance, similarity.scale);
  }
  return map;
}

std::vector<FrameReport> transform(const Similarity& similarity, std::vector<FrameReport> reports) {
  for (FrameReport& report : reports) {
    report.T_world_camera = moved(similarity, report.T_world_camera);
    report.covariance = scaled(report.covariance, similarity.scale);
    report.likelihood.T_world_body = moved(similarity, report.likelihood.T_world_body);
    report.likelihood.information = scaled(report.likelihood.information, 1.0 / similarity.scale);
    report.likelihood.gradient.head<3>() /= similarity.scale;
  }
  return reports;
}

std::optional<Similarity> similarity_to_given_poses(const std::vector<FrameReport>& reports, const Trajectory& given) {
  std::vector<Eigen::Isometry3d> map_poses, metric_poses;
  for (const FrameReport& report : reports) {
    if (!report.has_pose()) continue;
    const auto found = std::find_if(given.begin(), given.end(), [&](const StampedPose& pose) {
      return std::abs(to_seconds(pose.time - report.time)) < 1e-3;
    });
    if (found == given.end()) continue;
    map_poses.push_back(report.T_world_camera);
    metric_poses.push_back(found->T_world_camera);
  }
  double map_length = 0, metric_length = 0;
  for (std::size_t i = 1; i < map_poses.size(); ++i) {
    map_length += (map_poses[i].translation() - map_poses[0].translation()).norm();
    metric_length += (metric_poses[i].translation() - metric_poses[0].translation()).norm();
  }
  if (!(map_length > 0) || !(metric_length > 0)) return std::nullopt;
  Similarity similarity;
  similarity.scale = metric_length / map_length;
  similarity.T_target_source.linear() = metric_poses[0].linear() * map_poses[0].linear().transpose();
  similarity.T_target_source.translation() =
      metric_poses[0].translation() -
      similarity.T_target_source.linear() * (similarity.scale * map_poses[0].translation());
  return similarity;
}

std::optional<Similarity> similarity_from_distance(const std::vector<FrameReport>& reports,
                                                   const KnownDistance& known) {
  const FrameReport* a = posed_report(reports, known.frame_a);
  const FrameReport* b = posed_report(reports, known.frame_b);
  if (!a || !b) return std::nullopt;
  const double length = (a->T_world_camera.translation() - b->T_world_camera.translation()).norm();
  if (!(length > 0)) return std::nullopt;
  Similarity similarity;
  similarity.scale = known.distance_m / length;
  return similarity;
}

std::optional<Similarity> similarity_from_marker(const Camera& camera, const std::vector<FrameReport>& reports,
                                                 const std::vector<FrameMarkers>& seen, double side_m,
                                                 std::optional<int> id) {
  const auto corners = triangulate_corners(camera, reports, seen, id.value_or(most_frequent_marker(reports, seen)));
  if (!corners) return std::nullopt;
  const auto side = side_of_square(*corners);
  if (!side) return std::nullopt;
  const Eigen::Isometry3d T_marker_map = marker_frame(*corners).inverse();
  Similarity similarity;
  similarity.scale = side_m / *side;
  similarity.T_target_source.linear() = T_marker_map.linear();
  similarity.T_target_source.translation() = similarity.scale * T_marker_map.translation();
  return similarity;
}

}  // namespace alidade
