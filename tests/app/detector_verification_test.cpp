// SPDX-License-Identifier: Apache-2.0
#include "app/detector_verification.h"

#include <cmath>

#include <gtest/gtest.h>

#include "app/detector_scene.h"

namespace alidade {
namespace {

Eigen::Vector3d place(double t) {
  return {std::sin(t), std::cos(2 * t), 0.3 * t};
}

// A body that does not turn, for 4 s; the estimate before is off by a centimetre to and fro.
DetectorVerification motions() {
  DetectorVerification v;
  for (double t = 0; t < 4.0; t += 0.02) {
    StampedPose pose{Timestamp(from_seconds(t)), Eigen::Isometry3d::Identity(), {}};
    pose.T_world_camera.translation() = place(t);
    if (t < 3.0) v.after.motion.push_back(pose);
    pose.T_world_camera.translation().x() += std::lround(t / 0.02) % 2 == 0 ? 0.01 : -0.01;
    v.before.motion.push_back(pose);
  }
  return v;
}

VerificationData data() {
  VerificationData d;
  d.readings = {{Timestamp(from_seconds(0)), 0, 0, 0, 0}, {Timestamp(from_seconds(4)), 0, 0, 0, 0}};
  for (double t = -1.0; t < 5.0; t += 0.02) {
    const Eigen::Vector3d p = place(t);
    d.reference.push_back({Timestamp(from_seconds(t)), Eigen::Vector3d(-p.y(), p.x(), p.z() + 7)});
  }
  return d;
}

TEST(ReferenceErrors, AreThoseAfterTheRigidAlignment) {
  const auto errors = reference_errors(motions(), data());
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors->asked, 200, 1);
  EXPECT_NEAR(errors->answered, 150, 1);
  EXPECT_LT(errors->after_m.max, 1e-4);
  EXPECT_NEAR(errors->before_m.mean, 0.01, 1e-3);
  EXPECT_FALSE(errors->onboard_m);
}

TEST(ReferenceErrors, ComparesAtTheInstantsOfTheOtherEstimate) {
  VerificationData d = data();
  for (double t = 0.1; t < 2.0; t += 0.1) d.onboard.push_back({Timestamp(from_seconds(t)), 1.1 * place(t)});
  const auto errors = reference_errors(motions(), d);
  ASSERT_TRUE(errors && errors->onboard_m);
  EXPECT_EQ(errors->asked, static_cast<int>(d.onboard.size()));
  EXPECT_EQ(errors->onboard_m->count, d.onboard.size());
  EXPECT_GT(errors->onboard_m->mean, 100 * errors->after_m.mean);
}

TEST(ReferenceErrors, AreEmptyWithoutAReference) {
  VerificationData d = data();
  d.reference.clear();
  EXPECT_FALSE(reference_errors(motions(), d));
}

TEST(Enlargement, IsTheLargestRoundFactorThatFits) {
  EXPECT_DOUBLE_EQ(enlargement(1e-3, 0.1), 100.0);
  EXPECT_DOUBLE_EQ(enlargement(1e-3, 0.05), 30.0);
  EXPECT_DOUBLE_EQ(enlargement(1.0, 0.1), 1.0);
  EXPECT_DOUBLE_EQ(enlargement(0.0, 0.1), 1.0);
}

}  // namespace
}  // namespace alidade
