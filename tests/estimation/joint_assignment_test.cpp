// SPDX-License-Identifier: Apache-2.0
#include "estimation/joint_assignment.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(JointAssignment, IsTheShareOfAllWaysToAssign) {
  Eigen::MatrixXd likelihood(2, 2);
  likelihood << 4.0, 1.0, 3.0, 2.0;
  const Eigen::Vector2d miss(0.5, 0.25);
  // Ways: none; (1-a), (1-b), (2-a), (2-b), each with the other one missed; (1-a, 2-b), (1-b, 2-a).
  const double sum = 0.5 * 0.25 + 4.0 * 0.25 + 1.0 * 0.25 + 0.5 * 3.0 + 0.5 * 2.0 + 4.0 * 2.0 + 1.0 * 3.0;
  const Eigen::MatrixXd assigned = joint_assignment(likelihood, miss);
  EXPECT_NEAR(assigned(0, 0), (4.0 * 0.25 + 4.0 * 2.0) / sum, 1e-12);
  EXPECT_NEAR(assigned(0, 1), (1.0 * 0.25 + 1.0 * 3.0) / sum, 1e-12);
  EXPECT_NEAR(assigned(1, 1), (0.5 * 2.0 + 4.0 * 2.0) / sum, 1e-12);
  EXPECT_NEAR(assigned.row(0).sum(), 1.0, 1e-12);
  EXPECT_NEAR(assigned.row(1).sum(), 1.0, 1e-12);
}

TEST(JointAssignment, GivesUpWhereTheWaysAreTooMany) {
  const Eigen::MatrixXd assigned = joint_assignment(Eigen::MatrixXd::Ones(12, 12), Eigen::VectorXd::Constant(12, 0.5));
  EXPECT_TRUE(assigned.isZero());
}

}  // namespace
}  // namespace alidade
