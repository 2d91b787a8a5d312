// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/spline_path.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/simulated_flight.h"

namespace alidade {
namespace {

SplinePath spline_of_flight() {
  std::vector<Eigen::Vector3d> p;
  for (int k = 0; k < 40; ++k) p.push_back(test::simulated_position(10.0 + 0.4 * (k - 1)));
  return spline_through(10.0, 0.4, p);
}

TEST(SplinePath, GoesThroughWhatItWasMadeOf) {
  const SplinePath path = spline_of_flight();
  for (const double t : {12.0, 14.13, 18.77}) {
    EXPECT_LT((path.at(t)->p_world - test::simulated_position(t)).norm(), 2e-3) << t;
    const Eigen::Vector3d slope = (path.at(t + 1e-5)->p_world - path.at(t - 1e-5)->p_world) / 2e-5;
    EXPECT_LT((slope - path.at(t)->v_world).norm(), 1e-6) << t;
  }
}

TEST(SplinePath, EndsWithItsLastKnot) {
  const SplinePath path = spline_of_flight();
  EXPECT_NEAR(path.end_s(), 10.0 + 37 * 0.4, 1e-12);
  EXPECT_FALSE(path.at(9.999));
  EXPECT_FALSE(path.at(path.end_s() + 0.001));
  EXPECT_FALSE(path.at(std::nan("")));
  EXPECT_EQ(path.interval_at(0.0), 0);
  EXPECT_EQ(path.interval_at(1e6), 36);
  EXPECT_FALSE(SplinePath{}.at(0.0));
}

TEST(SplineWeights, AddUpToOneAndTheirSlopesToNone) {
  for (const double u : {-0.3, 0.0, 0.4, 1.0, 1.2}) {
    EXPECT_NEAR(spline_weights(u).sum(), 1.0, 1e-12);
    EXPECT_NEAR(spline_slopes(u).sum(), 0.0, 1e-12);
    const Eigen::Vector4d slope = (spline_weights(u + 1e-6) - spline_weights(u - 1e-6)) / 2e-6;
    EXPECT_LT((slope - spline_slopes(u)).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace alidade
