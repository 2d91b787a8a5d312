// SPDX-License-Identifier: Apache-2.0
#include "io/trajectory_file.h"

#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/pose_files.h"
#include "io/text_rows.h"
#include "io/trajectory_writer.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

constexpr double kKittiRateHz = 10.0;
constexpr const char* kKnownFormats =
    "give TUM (timestamp tx ty tz qx qy qz qw), KITTI (12 numbers), EuRoC csv (t_ns, x, y, z, qw, qx, qy, qz)";

[[noreturn]] void refuse(const fs::path& path, int line, const std::string& what, const std::string& remedy) {
  throw InputError(path.string(), line, what, remedy);
}

TrajectoryFormat recognise(const fs::path& path, const TextRow& row) {
  const std::size_t columns = row.fields.size();
  if (row.commas && columns >= 8) return TrajectoryFormat::Euroc;
  if (!row.commas && columns == 8) return TrajectoryFormat::Tum;
  if (!row.commas && columns == 12) return TrajectoryFormat::Kitti;
  refuse(path, row.line, fmt::format("has {} columns, which is no known trajectory format", columns), kKnownFormats);
}

Eigen::Vector3d position(const fs::path& path, const TextRow& row) {
  return {finite_number(path, row, 1), finite_number(path, row, 2), finite_number(path, row, 3)};
}

// Coefficients in Eigen's order x y z w.
Eigen::Matrix3d rotation(const fs::path& path, int line, const Eigen::Vector4d& coefficients) {
  constexpr double kRounding = 0.02;  // two digits behind the point
  const double norm = coefficients.norm();
  if (!(std::abs(norm - 1.0) < kRounding)) {
    refuse(path, line, fmt::format("the quaternion's norm must be 1, got {:.6g}", norm),
           "check the columns' order and remove lines without a pose");
  }
  return Eigen::Quaterniond(coefficients / norm).toRotationMatrix();
}

StampedPose parse_tum(const fs::path& path, const TextRow& row) {
  const auto time = parse_seconds(row.fields[0]);
  if (!time) {
    refuse(path, row.line, fmt::format("the timestamp is not a time in seconds: '{}'", row.fields[0]),
           "TUM timestamps are decimal seconds; correct or remove the line");
  }
  StampedPose pose;
  pose.time = *time;
  pose.T_world_camera.translation() = position(path, row);
  pose.T_world_camera.linear() = rotation(path, row.line,
                                          {finite_number(path, row, 4), finite_number(path, row, 5),
                                           finite_number(path, row, 6), finite_number(path, row, 7)});
  return pose;
}

StampedPose parse_euroc(const fs::path& path, const TextRow& row) {
  const std::string& text = row.fields[0];
  std::int64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size()) {
    refuse(path, row.line, fmt::format("the timestamp is not an integer of nanoseconds: '{}'", text),
           "correct or remove the line");
  }
  StampedPose pose;
  pose.time = Timestamp(std::chrono::nanoseconds(count));
  pose.T_world_camera.translation() = position(path, row);
  pose.T_world_camera.linear() = rotation(path, row.line,
                                          {finite_number(path, row, 5), finite_number(path, row, 6),
                                           finite_number(path, row, 7), finite_number(path, row, 4)});
  return pose;
}

StampedPose parse_kitti(const fs::path& path, const TextRow& row) {
  Eigen::Matrix<double, 3, 4> M;
  for (int i = 0; i < 12; ++i) M(i / 4, i % 4) = finite_number(path, row, static_cast<std::size_t>(i));
  StampedPose pose;
  pose.T_world_camera.linear() = nearest_rotation(M.leftCols<3>(), path, row.line);
  pose.T_world_camera.translation() = M.col(3);
  return pose;
}

StampedPose parse(const fs::path& path, const TextRow& row, TrajectoryFormat format) {
  if (format == TrajectoryFormat::Kitti) return parse_kitti(path, row);
  return format == TrajectoryFormat::Euroc ? parse_euroc(path, row) : parse_tum(path, row);
}

void require_order(const fs::path& path, int line, const Trajectory& poses) {
  const std::size_t n = poses.size();
  if (n < 2) return;
  const Timestamp last = poses[n - 1].time, before = poses[n - 2].time;
  const bool repeated = last == before && n >= 3 && poses[n - 3].time == before;
  if (last > before || (last == before && !repeated)) return;
  refuse(path, line,
         fmt::format("times must increase, got {} s after {} s", format_seconds(last), format_seconds(before)),
         "sort the lines by time and remove repetitions");
}

TrajectoryFile read_file(const fs::path& path) {
  const std::vector<TextRow> rows = read_rows(path);
  if (rows.empty()) refuse(path, 0, "holds no pose", kKnownFormats);
  TrajectoryFile file{path, recognise(path, rows[0]), true, {}};
  file.has_times = file.format != TrajectoryFormat::Kitti;
  for (const TextRow& row : rows) {
    if (row.fields.size() != rows[0].fields.size() || row.commas != rows[0].commas) {
      refuse(path, row.line,
             fmt::format("has {} columns, the lines before have {}", row.fields.size(), rows[0].fields.size()),
             "correct the line; one file holds one format");
    }
    file.poses.push_back(parse(path, row, file.format));
    if (!file.has_times) file.poses.back().time = Timestamp(std::chrono::seconds(file.poses.size() - 1));
    require_order(path, row.line, file.poses);
  }
  return file;
}

Trajectory with_times_of(const fs::path& times_path, const Trajectory& poses, const fs::path& poses_path) {
  const std::vector<TextRow> rows = read_rows(times_path);
  if (rows.size() != poses.size()) {
    refuse(times_path, 0, fmt::format("has {} times, {} has {} poses", rows.size(), poses_path.string(), poses.size()),
           "both need one line per frame");
  }
  Trajectory timed;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto time = parse_seconds(rows[i].fields[0]);
    if (!time) refuse(times_path, rows[i].line, "is not a time in seconds", "correct the line");
    timed.push_back(poses[i]);
    timed.back().time = *time;
    require_order(times_path, rows[i].line, timed);
  }
  return timed;
}

// A file of poses without times, in a folder of frames that are timed by times.txt or by KITTI's rate.
TrajectoryFile read_frames(const fs::path& folder, const fs::path& poses_path) {
  TrajectoryFile file = read_file(poses_path);
  if (file.has_times) return file;
  file.has_times = true;
  if (fs::exists(folder / "times.txt")) {
    file.poses = with_times_of(folder / "times.txt", file.poses, poses_path);
    return file;
  }
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    file.poses[i].time = Timestamp(from_seconds(static_cast<double>(i) / kKittiRateHz));
  }
  return file;
}

std::optional<TrajectoryFile> read_named_file(const fs::path& folder) {
  for (const char* name : {"trajectory.tum", "truth.tum", "groundtruth.txt", "poses.txt", "data.csv",
                           "state_groundtruth_estimate0/data.csv", "mav0/state_groundtruth_estimate0/data.csv"}) {
    if (fs::exists(folder / name)) return read_frames(folder, folder / name);
  }
  const fs::path sequence = fs::weakly_canonical(folder);
  const fs::path kitti = sequence.parent_path().parent_path() / "poses" / (sequence.filename().string() + ".txt");
  if (fs::exists(kitti)) return read_frames(folder, kitti);
  return std::nullopt;
}

TrajectoryFile read_folder(const fs::path& folder) {
  if (auto file = read_named_file(folder)) return *std::move(file);
  if (const auto files = files_ending_in(folder, ".pose.txt"); !files.empty()) {
    Trajectory poses = read_seven_scenes(files);
    if (poses.empty()) refuse(folder, 0, "all of its poses are marked as lost", "give another sequence");
    return {folder, TrajectoryFormat::SevenScenes, true, std::move(poses)};
  }
  for (const fs::path& place : {folder, folder / "gt_dense_cameras"}) {
    if (!fs::is_directory(place)) continue;
    const auto files = files_ending_in(place, ".camera");
    if (!files.empty()) return {place, TrajectoryFormat::Strecha, true, read_strecha(files)};
  }
  refuse(folder, 0, "holds no known trajectory",
         "expected trajectory.tum, truth.tum, groundtruth.txt, poses.txt, data.csv, *.pose.txt or *.camera");
}

}  // namespace

TrajectoryFile read_trajectory(const fs::path& path) {
  if (!fs::exists(path)) refuse(path, 0, "does not exist", "check the path");
  return fs::is_directory(path) ? read_folder(path) : read_file(path);
}

void write_trajectory_tum(const fs::path& path, const Trajectory& trajectory) {
  TumWriter writer(path);
  for (const StampedPose& pose : trajectory) writer.write(pose);
  writer.commit();
}

}  // namespace alidade
