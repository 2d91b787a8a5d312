// SPDX-License-Identifier: Apache-2.0
#include "uav/batch/motion_solver.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/uav/flown_scene.h"

namespace alidade {
namespace {

struct Prepared {
  TargetScene scene;
  MotionFrame frame;
  std::vector<BearingRows> rows;
};

Prepared prepare(unsigned seed) {
  TargetSceneOptions options;
  options.targets = 1;
  options.seed = seed;
  Prepared prepared{make_target_scene(options), {}, {}};
  const auto bearings = bearings_of_target(prepared.scene, 0);
  prepared.frame = frame_of(bearings);
  prepared.rows = rows_of(bearings, prepared.frame);
  return prepared;
}

TEST(MotionSolver, MovesAlongAParabola) {
  MotionVector<9> x;
  x << 1, 2, 3, 4, 5, 6, 2, 0, -2;
  EXPECT_TRUE(position_of<9>(x, 3.0).isApprox(Eigen::Vector3d(1 + 12 + 9, 2 + 15, 3 + 18 - 9)));
  EXPECT_TRUE(position_of<6>(x.head<6>(), 3.0).isApprox(Eigen::Vector3d(13, 17, 21)));
}

TEST(MotionSolver, ComesToTheSameFromAfar) {
  const Prepared prepared = prepare(4);
  const auto best = solve_motion<6>(prepared.rows, {}, {});
  ASSERT_EQ(best.outcome, MotionOutcome::Determined);
  MotionVector<6> off;
  off << 8, -6, 7, 3, -2, 4;
  const auto again = refine_motion<6>(prepared.rows, {}, {}, best.x + off);
  ASSERT_EQ(again.outcome, MotionOutcome::Determined);
  EXPECT_LT((again.x - best.x).norm(), 1e-5);
  EXPECT_NEAR(again.chi2, best.chi2, 1e-6);
}

TEST(MotionSolver, IsLeastWhereItEnds) {
  const Prepared prepared = prepare(5);
  const auto best = solve_motion<6>(prepared.rows, {}, {});
  const auto chi2_at = [&](const MotionVector<6>& x) {
    double sum = 0.0;
    for (const BearingRows& row : prepared.rows) {
      sum += bearing_error(row, position_of<6>(x, row.t_s)).error.squaredNorm();
    }
    return sum;
  };
  EXPECT_NEAR(chi2_at(best.x), best.chi2, 1e-9);
  for (int i = 0; i < 6; ++i) {
    for (double step : {-1e-3, 1e-3}) EXPECT_GT(chi2_at(best.x + step * MotionVector<6>::Unit(i)), best.chi2);
  }
}

TEST(MotionSolver, DoesNotStartBehindAReceiver) {
  const Prepared prepared = prepare(6);
  const MotionVector<6> nowhere = MotionVector<6>::Constant(-1e4);
  EXPECT_EQ(refine_motion<6>(prepared.rows, {}, {}, nowhere).outcome, MotionOutcome::BehindReceiver);
}

}  // namespace
}  // namespace alidade
