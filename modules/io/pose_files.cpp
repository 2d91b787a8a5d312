// SPDX-License-Identifier: Apache-2.0
#include "io/pose_files.h"

#include <algorithm>
#include <charconv>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "core/errors.h"
#include "io/natural_order.h"
#include "io/text_rows.h"

namespace alidade {
namespace {

constexpr double kSevenScenesRateHz = 30.0;
constexpr std::int64_t kMostFrames = 1'000'000'000;  // a year; beyond it the name holds a date or the like

void require_columns(const std::filesystem::path& path, const TextRow& row, std::size_t columns,
                     std::string_view what) {
  if (row.fields.size() == columns) return;
  throw InputError(path.string(), row.line, fmt::format("has {} columns, {} has {}", row.fields.size(), what, columns),
                   "copy the file again from its source");
}

void require_rows(const std::filesystem::path& path, const std::vector<TextRow>& rows, std::size_t count,
                  std::string_view what) {
  if (rows.size() == count) return;
  throw InputError(path.string(), rows.empty() ? 0 : rows.back().line,
                   fmt::format("has {} rows of numbers, {} has {}", rows.size(), what, count),
                   "copy the file again from its source");
}

Eigen::RowVector3d three_numbers(const std::filesystem::path& path, const TextRow& row) {
  return {finite_number(path, row, 0), finite_number(path, row, 1), finite_number(path, row, 2)};
}

std::int64_t frame_number(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  const std::size_t last = name.find_last_of("0123456789", name.rfind(".pose.txt"));
  const std::size_t before = last == std::string::npos ? last : name.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  std::int64_t number = 0;
  if (last == std::string::npos ||
      std::from_chars(name.data() + first, name.data() + last + 1, number).ec != std::errc() || number > kMostFrames) {
    throw InputError(path.string(), 0, "has no frame number in its name", "name pose files like frame-000012.pose.txt");
  }
  return number;
}

// What the compilers of the set's authors wrote for a number that is none.
bool says_lost(const std::vector<TextRow>& rows) {
  for (const TextRow& row : rows) {
    for (const std::string& field : row.fields) {
      for (const char* word : {"#IN", "#QNAN", "inf", "INF", "nan", "NaN", "NAN"}) {
        if (field.find(word) != std::string::npos) return true;
      }
    }
  }
  return false;
}

}  // namespace

std::vector<std::filesystem::path> files_ending_in(const std::filesystem::path& folder, std::string_view suffix) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename().string().ends_with(suffix)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return natural_less(a.filename().native(), b.filename().native()); });
  return files;
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R, const std::filesystem::path& path, int line) {
  constexpr double kRounding = 1e-2;
  if (!((R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRounding) || R.determinant() < 0) {
    throw InputError(path.string(), line, "the 3x3 part of the pose is not a rotation",
                     "check the order of the numbers (rows of [R t]) and that no scale is in it");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

std::optional<Eigen::Isometry3d> read_pose_matrix(const std::filesystem::path& path) {
  const std::vector<TextRow> rows = read_rows(path);
  require_rows(path, rows, 4, "a 4x4 pose");
  for (const TextRow& row : rows) require_columns(path, row, 4, "a row of a 4x4 pose");
  if (says_lost(rows)) return std::nullopt;
  Eigen::Matrix4d M;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) M(i, j) = finite_number(path, rows[i], j);
  }
  if (!M.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-6)) {
    throw InputError(path.string(), rows[3].line, "the last row of a pose must be 0 0 0 1", "check the row order");
  }
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() = nearest_rotation(M.topLeftCorner<3, 3>(), path, rows[0].line);
  T_world_camera.translation() = M.topRightCorner<3, 1>();
  return T_world_camera;
}

Eigen::Isometry3d read_strecha_pose(const std::filesystem::path& path) {
  constexpr int kFirstRotationRow = 4, kCentreRow = 7, kSizeRow = 8;
  const std::vector<TextRow> rows = read_rows(path);
  require_rows(path, rows, 9, "a camera file (K, distortion, R, centre, size)");
  for (int i = 0; i < kSizeRow; ++i) require_columns(path, rows[i], 3, "this row of a camera file");
  require_columns(path, rows[kSizeRow], 2, "the size row of a camera file");
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) R.row(i) = three_numbers(path, rows[kFirstRotationRow + i]);
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() = nearest_rotation(R, path, rows[kFirstRotationRow].line);
  T_world_camera.translation() = three_numbers(path, rows[kCentreRow]).transpose();
  return T_world_camera;
}

Trajectory read_seven_scenes(const std::vector<std::filesystem::path>& files) {
  Trajectory poses;
  for (const auto& file : files) {
    const Timestamp time(from_seconds(static_cast<double>(frame_number(file)) / kSevenScenesRateHz));
    if (const auto T_world_camera = read_pose_matrix(file)) poses.push_back({time, *T_world_camera, std::nullopt});
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.time < b.time; });
  return poses;
}

Trajectory read_strecha(const std::vector<std::filesystem::path>& files) {
  Trajectory poses;
  for (const auto& file : files) {
    poses.push_back({Timestamp(std::chrono::seconds(poses.size())), read_strecha_pose(file), std::nullopt});
  }
  return poses;
}

}  // namespace alidade
