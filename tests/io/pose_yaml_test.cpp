// SPDX-License-Identifier: Apache-2.0
#include "io/pose_yaml.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "geometry/pose.h"

namespace alidade {
namespace {

TEST(PoseYaml, GivesBackThePose) {
  const Eigen::Isometry3d T = perturbation((Vector6d() << 0.1, -20, 1.0 / 3, 0.3, -2, 0.1).finished());
  const Eigen::Isometry3d back = read_pose("f", YAML::Load(format_pose(T)));
  EXPECT_EQ(back.translation(), T.translation());
  EXPECT_TRUE(back.isApprox(T, 1e-15));
}

TEST(PoseYaml, GivesBackTheCovarianceExactly) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Constant(5, 5, 1.0 / 7);
  C.diagonal() << 1, 2, 3, 4, 0.5;
  EXPECT_EQ(read_covariance("f", YAML::Load(format_covariance(C)), 5), C);
}

TEST(PoseYaml, JudgesACovarianceByItsCorrelations) {
  // The variances of a focal length and of a distortion coefficient; a correlation of 1.1 is impossible, 0.9 is not.
  EXPECT_NO_THROW(read_covariance("f", YAML::Load("[1, 9e-7, 1e-12]"), 2));
  EXPECT_THROW(read_covariance("f", YAML::Load("[1, 11e-7, 1e-12]"), 2), InputError);
  EXPECT_THROW(read_covariance("f", YAML::Load("[1, 1e-9, 0]"), 2), InputError);
  EXPECT_THROW(read_covariance("f", YAML::Load("[1, 0, -1e-12]"), 2), InputError);
}

}  // namespace
}  // namespace alidade
