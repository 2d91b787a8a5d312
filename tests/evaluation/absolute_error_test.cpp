// SPDX-License-Identifier: Apache-2.0
#include "evaluation/absolute_error.h"

#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/evaluation/paths.h"

namespace alidade {
namespace {

TEST(AbsoluteErrors, AreDistanceAndAngleOfEachPair) {
  PairedTrajectories pairs{test::winding_path(2), test::winding_path(2)};
  Vector6d xi;
  xi << 3, 0, 4, 0, 0.01, 0;
  pairs.estimate[1].T_world_camera = pairs.truth[1].T_world_camera * perturbation(xi);
  const AbsoluteErrors errors = absolute_errors(pairs);
  EXPECT_NEAR(errors.translation_m.values[0], 0.0, 1e-12);
  EXPECT_NEAR(errors.translation_m.values[1], 5.0, 1e-12);
  EXPECT_NEAR(errors.rotation_deg.values[0], 0.0, 1e-12);
  EXPECT_NEAR(errors.rotation_deg.values[1], 0.01 * 180 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(errors.translation_m.statistics.max, 5.0, 1e-12);
}

TEST(AbsoluteErrors, RefuseUnequalLengths) {
  EXPECT_THROW(absolute_errors({test::winding_path(2), test::winding_path(3)}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
