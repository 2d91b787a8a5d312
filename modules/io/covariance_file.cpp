// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/errors.h"
#include "io/text_rows.h"
#include "io/trajectory_file.h"
#include "io/trajectory_writer.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kColumns = 22;  // t_ns and the upper triangle of a 6x6 matrix

Timestamp parse_time(const fs::path& path, const TextRow& row) {
  const std::string& text = row.fields[0];
  std::int64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw InputError(path.string(), row.line, fmt::format("t_ns is not an integer: '{}'", text),
                     "write the file again with 'alidade track camera'");
  }
  return Timestamp(std::chrono::nanoseconds(count));
}

Matrix6d parse_covariance(const fs::path& path, const TextRow& row) {
  Matrix6d P;
  std::size_t column = 1;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) P(i, j) = P(j, i) = finite_number(path, row, column++);
  }
  const Vector6d eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix6d>(P, Eigen::EigenvaluesOnly).eigenvalues();
  if (eigenvalues.minCoeff() < -1e-9 * eigenvalues.cwiseAbs().maxCoeff()) {
    throw InputError(path.string(), row.line, "the covariance is not positive semi-definite",
                     "write the file again with 'alidade track camera'");
  }
  return P;
}

}  // namespace

fs::path covariance_path(const fs::path& trajectory_path) {
  const std::string stem = trajectory_path.stem().string();
  return trajectory_path.parent_path() / (stem == "trajectory" ? "covariance.csv" : stem + ".covariance.csv");
}

void write_covariances(const fs::path& path, const Trajectory& trajectory) {
  CovarianceWriter writer(path);
  for (const StampedPose& pose : trajectory) writer.write(pose);
  writer.commit();
}

Trajectory read_covariances(const fs::path& path, Trajectory trajectory) {
  const std::vector<TextRow> rows = read_rows(path);
  if (rows.empty() || rows[0].fields[0] != "t_ns") {
    throw InputError(path.string(), rows.empty() ? 0 : rows[0].line, "has no header line with t_ns and 21 entries",
                     "write the file again with 'alidade track camera'");
  }
  for (const TextRow& row : rows) {
    if (row.fields.size() != kColumns) {
      throw InputError(path.string(), row.line,
                       fmt::format("has {} columns, must have {}", row.fields.size(), kColumns),
                       "write the file again with 'alidade track camera'");
    }
    if (&row == &rows[0]) continue;
    const Timestamp time = parse_time(path, row);
    const auto pose = std::lower_bound(trajectory.begin(), trajectory.end(), time,
                                       [](const StampedPose& p, Timestamp t) { return p.time < t; });
    if (pose == trajectory.end() || pose->time != time) {
      throw InputError(path.string(), row.line, fmt::format("the trajectory has no pose at {} s", format_seconds(time)),
                       "keep the covariances beside the trajectory they belong to");
    }
    pose->covariance = parse_covariance(path, row);
  }
  return trajectory;
}

}  // namespace alidade
