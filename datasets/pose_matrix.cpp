// SPDX-License-Identifier: Apache-2.0
#include "datasets/pose_matrix.h"

#include <Eigen/SVD>

#include "core/errors.h"
#include "io/camera_file.h"
#include "io/image_files.h"

namespace alidade {

Eigen::Isometry3d pose_from(const std::filesystem::path& path, int line, const Eigen::Matrix3d& R,
                            const Eigen::Vector3d& t) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  if (!((nearest - R).norm() < 1e-2) || nearest.determinant() < 0) {
    throw InputError(path, line, "the pose's matrix is no rotation", "");
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = nearest;
  T.translation() = t;
  return T;
}

std::optional<Camera> find_camera(const std::filesystem::path& folder, const char* name,
                                  const std::filesystem::path& image) {
  for (const auto& place : {folder / name, folder / ".." / name}) {
    if (!std::filesystem::exists(place)) continue;
    const cv::Mat pixels = read_image(image);
    return read_camera(place, ImageSize{pixels.cols, pixels.rows});
  }
  return std::nullopt;
}

}  // namespace alidade
