// SPDX-License-Identifier: Apache-2.0
#include "tracking/pose_method.h"

#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 61;
constexpr PoseMethod kMethods[] = {PoseMethod::Ekf,  PoseMethod::EkfPaper, PoseMethod::Ukf,  PoseMethod::EkfSlam,
                                   PoseMethod::Epnp, PoseMethod::EpnpLm,   PoseMethod::Sqpnp};

class EstimatePose : public testing::Test {
 protected:
  // The prediction is a few millimetres off and believed to a few centimetres.
  EstimatePose() {
    Vector6d off;
    off << 0.004, -0.003, 0.002, 0.001, -0.001, 0.0005;
    predicted_ = resting_state({}, truth_ * perturbation(off), 1e-2 * Matrix6d::Identity(), 1.0, 1.0);
    for (PointObservation& o : observations_) o.sigma_px = 0.1;
  }

  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  PointMap map_ = test::make_map(camera_, 60, 1, 0.0, random_);
  Eigen::Isometry3d truth_ = map_.keyframes[0].T_world_camera;
  std::vector<PointObservation> observations_ = test::observations_of(map_, 0);
  MotionState predicted_;
};

TEST_F(EstimatePose, GivesThePoseOnExactSightingsByEveryMethod) {
  for (const PoseMethod method : kMethods) {
    const auto update = estimate_pose(method, camera_, predicted_, observations_, {}, true);
    ASSERT_TRUE(update) << static_cast<int>(method);
    const double bound = method == PoseMethod::Ukf ? 1e-3 : 1e-4;  // it looks about as far as the prediction may be off
    EXPECT_LT(difference(truth_, update->T_world_camera).norm(), bound) << static_cast<int>(method);
    EXPECT_EQ(update->inlier_count, static_cast<int>(observations_.size()));
    const Eigen::LLT<Matrix6d> factor(update->covariance);
    EXPECT_EQ(factor.info(), Eigen::Success) << static_cast<int>(method);
    EXPECT_LT(update->covariance.trace(), 1e-4) << static_cast<int>(method);
  }
}

TEST_F(EstimatePose, ChoosesTheSameInliersForEveryMethod) {
  for (std::size_t i = 0; i < observations_.size(); i += 4) observations_[i].pixel.x() += 15;
  for (const PoseMethod method : kMethods) {
    const auto update = estimate_pose(method, camera_, predicted_, observations_, {}, true);
    ASSERT_TRUE(update) << static_cast<int>(method);
    for (std::size_t i = 0; i < observations_.size(); ++i) EXPECT_EQ(update->is_inlier[i], i % 4 != 0) << i;
    EXPECT_LT(difference(truth_, update->T_world_camera).norm(), 1e-3) << static_cast<int>(method);
  }
}

TEST_F(EstimatePose, LeavesThePredictionOutWhereItIsTold) {
  predicted_.covariance.topLeftCorner<6, 6>() = 1e-8 * Matrix6d::Identity();  // sure, and wrong
  for (PointObservation& o : observations_) o.sigma_px = 5;
  const auto held = estimate_pose(PoseMethod::Ekf, camera_, predicted_, observations_, {}, true);
  const auto free = estimate_pose(PoseMethod::Ekf, camera_, predicted_, observations_, {}, false);
  ASSERT_TRUE(held && free);
  EXPECT_LT(difference(predicted_.T_world_body, held->T_world_camera).norm(), 1e-3);
  EXPECT_LT(difference(truth_, free->T_world_camera).norm(), 1e-5);
}

TEST_F(EstimatePose, IsEmptyWithTooFewSightings) {
  observations_.resize(5);
  for (const PoseMethod method : kMethods) {
    EXPECT_FALSE(estimate_pose(method, camera_, predicted_, observations_, {}, true)) << static_cast<int>(method);
  }
}

}  // namespace
}  // namespace alidade
