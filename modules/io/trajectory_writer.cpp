// SPDX-License-Identifier: Apache-2.0
#include "io/trajectory_writer.h"

#include <array>

#include <fmt/format.h>

#include "io/trajectory_file.h"

namespace alidade {
namespace {

std::string column_names() {
  constexpr std::array<const char*, 6> kAxes{"x", "y", "z", "rx", "ry", "rz"};
  std::string names = "t_ns";
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = i; j < 6; ++j) {
      const char* unit = j < 3 ? "m2" : i < 3 ? "m_rad" : "rad2";
      names += fmt::format(",{}_{}_{}", kAxes[i], kAxes[j], unit);
    }
  }
  return names;
}

}  // namespace

TumWriter::TumWriter(const std::filesystem::path& path, std::string_view what) : file_(path) {
  file_.write(fmt::format("# timestamp[s] tx ty tz[m] qx qy qz qw: {} to world\n", what));
}

void TumWriter::write(const StampedPose& pose) {
  const Eigen::Vector3d t = pose.T_world_camera.translation();
  Eigen::Quaterniond q(pose.T_world_camera.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  file_.write(fmt::format("{} {} {} {} {} {} {} {}\n", format_seconds(pose.time), t.x(), t.y(), t.z(), q.x(), q.y(),
                          q.z(), q.w()));
}

CovarianceWriter::CovarianceWriter(const std::filesystem::path& path, std::string_view what) : file_(path) {
  file_.write(
      fmt::format("# covariance of xi = (translation, rotation vector) on the right of T_world_{0}, in {0} axes;"
                  " upper triangle; m^2, m rad, rad^2\n{1}\n",
                  what, column_names()));
}

void CovarianceWriter::write(const StampedPose& pose) {
  if (!pose.covariance) return;
  std::string line = fmt::format("{}", pose.time.time_since_epoch().count());
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) line += fmt::format(",{}", (*pose.covariance)(i, j));
  }
  file_.write(line + '\n');
}

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& path, std::string_view what)
    : poses_(path, what), covariances_(covariance_path(path), what) {}

void TrajectoryWriter::write(const StampedPose& pose) {
  poses_.write(pose);
  covariances_.write(pose);
}

void TrajectoryWriter::commit() {
  covariances_.commit();
  poses_.commit();
}

}  // namespace alidade
