// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "capture/frame_source.h"
#include "core/time.h"
#include "geometry/pose.h"
#include "geometry/trajectory.h"

namespace alidade {

/// One image of a data set and what is known of it.
struct DatasetFrame {
  Timestamp time{};
  std::filesystem::path image;
  std::optional<std::filesystem::path> depth;       ///< registered to the image; unit: Dataset::depth_unit_m
  std::optional<Eigen::Isometry3d> T_world_camera;  ///< the true pose at `time`, where the data has one
  Timestamp depth_time{};                           ///< of the depth image
};

/// A folder of a public data set, read whole but for the pixels.
struct Dataset {
  std::string kind;                    ///< "strecha", "seven-scenes", "kitti", "tum-rgbd"
  std::filesystem::path folder;        ///< as it was named
  std::vector<DatasetFrame> frames{};  ///< in order of time, at least one
  std::optional<Camera> camera{};      ///< where the data says one for all of its images
  Trajectory truth{};           ///< true poses at the times at which they were measured; may be denser than frames
  double depth_unit_m = 0.001;  ///< metres per step of a depth image
  bool timed = false;           ///< whether the times mean seconds; if not they count the images
};

/// Reads `folder` if its files show that it is a data set of a kind that is known; empty where they do not.
/// Throws InputError where it is one and a file of it is damaged or missing.
std::optional<Dataset> open_dataset(const std::filesystem::path& folder);

/// The images of a data set as a source (read ahead in a thread).
std::unique_ptr<FrameSource> open_frames(const Dataset& dataset);

// One file per source of data; each is empty where the folder is not of its kind, and throws as open_dataset.

/// Strecha's multi-view stereo benchmark: an image and a NAME.camera for each. The folder may also hold them in
/// images/ (or urd/) and gt_dense_cameras/. x ~ K Rᵀ (X − C): the file's R is R_world_camera, C the centre, in m.
/// Source: Strecha et al., On benchmarking camera calibration and multi-view stereo, CVPR 2008.
std::optional<Dataset> open_strecha(const std::filesystem::path& folder);

/// Microsoft 7-Scenes: frame-000000.color.jpg (or .png) and frame-000000.pose.txt (4×4 T_world_camera, m), 30 Hz.
/// The poses are the depth camera's; depth is not registered to colour and so not given. The camera comes from
/// camera.txt in the folder or above it.
std::optional<Dataset> open_seven_scenes(const std::filesystem::path& folder);

/// A KITTI odometry sequence: image_l/, image_0/ or image_2/, calib.txt, and poses.txt or ../../poses/NAME.txt (3×4
/// T_world_camera of the left grey camera, m; moved to the colour camera where its images are used). Times come from
/// times.txt, else 10 Hz.
std::optional<Dataset> open_kitti(const std::filesystem::path& folder);

/// A TUM RGB-D sequence: rgb.txt, and where there are such depth.txt (5000 = 1 m), groundtruth.txt (motion capture,
/// interpolated at the images' times across gaps of at most 0.1 s) and camera.txt (else the published intrinsics of
/// freiburg1, 2 and 3 where the folder is named after one).
std::optional<Dataset> open_tum_rgbd(const std::filesystem::path& folder);

}  // namespace alidade
