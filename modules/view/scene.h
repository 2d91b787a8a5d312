// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "camera/camera.h"
#include "geometry/point_map.h"
#include "geometry/trajectory.h"
#include "view/colour.h"

namespace alidade {

struct ScenePoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  Rgb colour = palette::kReference;
};

enum class PyramidStyle { Solid, Hollow };

/// A camera drawn as the pyramid of its view, apex in the centre, base in front.
struct CameraPyramid {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Rgb colour = palette::kEstimate;
  PyramidStyle style = PyramidStyle::Hollow;
  double depth_m = 0.0;                        ///< from apex to base; 0: Scene::pyramid_depth_m
  Eigen::Vector2d half_extent = {0.62, 0.46};  ///< of the base at depth 1
};

struct ScenePath {
  std::vector<Eigen::Vector3d> points_world;  ///< a point that is not finite is a gap
  Rgb colour = palette::kEstimate;
  double width_px = 2.0;
};

/// A triangle mesh with a picture on it. Not lit: it looks as the picture does.
struct TexturedSurface {
  std::vector<Eigen::Vector3d> vertices_world;
  std::vector<Eigen::Vector2d> texture_uv;  ///< per vertex; (0, 0) the outer corner of the picture's top-left pixel
  std::vector<Eigen::Vector3i> triangles;
  cv::Mat texture;  ///< CV_8UC3, BGR
};

/// Triangles of one colour, through which what lies behind can be seen. Not lit.
struct TranslucentSurface {
  std::vector<Eigen::Vector3d> vertices_world;
  std::vector<Eigen::Vector3i> triangles;
  Rgb colour = palette::kReference;
  double opacity = 0.15;
};

/// A text at a point, drawn over everything.
struct SceneLabel {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  std::string text;
  Rgb colour = palette::kInk;
};

struct LegendEntry {
  std::string text;
  Rgb colour = palette::kInk;
  PyramidStyle style = PyramidStyle::Solid;
};

/// What there is to see; a value. Lengths in the world's unit (m where the scale is known).
struct Scene {
  std::vector<ScenePoint> points;
  std::vector<CameraPyramid> cameras;
  std::vector<ScenePath> paths;
  std::vector<TexturedSurface> surfaces;
  std::vector<TranslucentSurface> translucent;
  std::vector<SceneLabel> labels;
  std::vector<LegendEntry> legend;
  std::string title;
  Rgb background{250, 250, 252};
  double point_size_px = 2.5;
  double pyramid_depth_m = 0.1;
  Eigen::Vector3d up_world = Eigen::Vector3d::Zero();  ///< what to show upwards; zero: what the cameras take for up
};

/// The five corners of a camera's pyramid in the world: apex, then the base clockwise from the top left as the camera
/// sees it. `scene`: gives the depth where the pyramid leaves it open.
std::vector<Eigen::Vector3d> pyramid_corners(const CameraPyramid& pyramid, const Scene& scene);

/// The points of a map, evenly thinned to at most `most` (software drawing shows a million at 0.5 frames/s).
std::vector<ScenePoint> scene_points(const PointMap& map, std::size_t most = 200'000);

/// The line through the centres, broken where two poses are more than `longest_gap` apart.
ScenePath scene_path(const Trajectory& trajectory, const Rgb& colour,
                     RecordingClock::duration longest_gap = RecordingClock::duration::max());

/// Pyramids for poses evenly spread along the trajectory, at most `most`, first and last among them. The camera, where
/// given, gives the shape of the base.
std::vector<CameraPyramid> scene_pyramids(const Trajectory& trajectory, PyramidStyle style, const Rgb& colour,
                                          const std::optional<Camera>& camera = std::nullopt, std::size_t most = 40);

/// The surface on which a normally distributed point is `sigmas` standard deviations from its mean; flat or drawn out
/// to a line where the covariance (m²) is singular.
TranslucentSurface covariance_ellipsoid(const Eigen::Vector3d& mean_world, const Eigen::Matrix3d& covariance_world,
                                        double sigmas, const Rgb& colour);

/// What the picture of a camera track shows. All in one frame: align the truth first.
struct TrackPicture {
  PointMap map;
  Trajectory estimate;
  std::optional<Trajectory> truth;
  std::optional<Camera> camera;
  std::string title;
};

/// Map, paths and cameras as in the paper's Fig. 7: true cameras solid, estimated ones hollow, with a legend; pyramids
/// sized to the path. Source: Mehralian and Soryani, Fig. 7.
Scene track_scene(const TrackPicture& picture);

}  // namespace alidade
