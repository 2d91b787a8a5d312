// SPDX-License-Identifier: Apache-2.0
#include "io/pose_yaml.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/errors.h"
#include "io/yaml_nodes.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

// Judged on the correlations, as the variances of a camera's parameters lie ten orders of magnitude apart.
bool is_covariance(const Eigen::MatrixXd& C) {
  if (!(C.diagonal().minCoeff() >= 0)) return false;
  Eigen::MatrixXd correlation = C;
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    if (C(i, i) == 0 && !C.row(i).isZero(0)) return false;
    const double scale = C(i, i) > 0 ? 1.0 / std::sqrt(C(i, i)) : 1.0;
    correlation.row(i) *= scale;
    correlation.col(i) *= scale;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= -1e-9;
}

}  // namespace

Eigen::Isometry3d read_pose(const Path& path, const YAML::Node& node) {
  require_yaml_map(path, node, "{translation_m: [0, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}");
  constexpr std::array<std::string_view, 2> kKeys{"translation_m", "quaternion_wxyz"};
  refuse_unknown_keys(path, node, kKeys);
  const auto t = yaml_numbers(path, yaml_value(path, node, "translation_m", "the pose"), 3, "[0, 0, 1.5]");
  const YAML::Node rotation = yaml_value(path, node, "quaternion_wxyz", "the pose");
  const auto w = yaml_numbers(path, rotation, 4, "[1, 0, 0, 0]");
  const Eigen::Quaterniond q(w[0], w[1], w[2], w[3]);
  if (!(std::abs(q.norm() - 1.0) < 1e-3)) {
    throw InputError(path, yaml_line(rotation), fmt::format("the quaternion's length must be 1, got {:.6g}", q.norm()),
                     "its order is w, x, y, z");
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
  return T;
}

std::string format_pose(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t = T.translation();
  return fmt::format("{{translation_m: [{}, {}, {}], quaternion_wxyz: [{}, {}, {}, {}]}}", t.x(), t.y(), t.z(), q.w(),
                     q.x(), q.y(), q.z());
}

Eigen::MatrixXd read_covariance(const Path& path, const YAML::Node& node, int size) {
  const std::string example = fmt::format("the upper triangle of the {}x{} matrix, row by row", size, size);
  const auto values = yaml_numbers(path, node, static_cast<std::size_t>(size * (size + 1) / 2), example.c_str());
  Eigen::MatrixXd C(size, size);
  std::size_t next = 0;
  for (int i = 0; i < size; ++i) {
    for (int j = i; j < size; ++j) C(i, j) = C(j, i) = values[next++];
  }
  if (!is_covariance(C)) {
    throw InputError(path, yaml_line(node), "the covariance is not positive semi-definite",
                     "calibrate again, or leave it out");
  }
  return C;
}

std::string format_covariance(const Eigen::MatrixXd& C) {
  std::vector<double> triangle;
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    for (Eigen::Index j = i; j < C.cols(); ++j) triangle.push_back(C(i, j));
  }
  return fmt::format("[{}]", fmt::join(triangle, ", "));
}

}  // namespace alidade
