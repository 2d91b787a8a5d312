// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/rotation.h"

namespace alidade::test {

/// Random vectors and poses from one seed, which a failing test prints by SCOPED_TRACE.
class RandomGeometry {
 public:
  explicit RandomGeometry(unsigned seed) : engine_(seed) {}

  double normal(double sigma = 1.0) { return std::normal_distribution<double>(0.0, sigma)(engine_); }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Eigen::Vector3d vector(double sigma = 1.0) { return {normal(sigma), normal(sigma), normal(sigma)}; }
  Eigen::Vector3d direction() { return vector().normalized(); }

  Eigen::Isometry3d pose(double sigma_m = 1.0) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = exp_so3(uniform(0.0, 3.0) * direction());
    T.translation() = vector(sigma_m);
    return T;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace alidade::test
