// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/bundle_adjustment.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/alignment.h"
#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 43;

class BundleAdjustment : public testing::Test {
 protected:
  PointMap perturbed(PointMap map, double sigma_m, double sigma_rad) {
    for (MapPoint& point : map.points) point.p_world += random_.vector(sigma_m);
    for (Keyframe& keyframe : map.keyframes) {
      Vector6d xi;
      xi << random_.vector(sigma_m), random_.vector(sigma_rad);
      keyframe.T_world_camera = keyframe.T_world_camera * perturbation(xi);
    }
    return map;
  }

  // As perturbed, with the first `count` keyframes where they belong.
  PointMap perturbed_but(int count, const PointMap& truth) {
    PointMap map = perturbed(truth, 0.05, 0.01);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      map.keyframes[k].T_world_camera = truth.keyframes[k].T_world_camera;
    }
    return map;
  }

  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  PointMap truth_ = test::make_map(camera_, 80, 6, 0.0, random_);
};

void expect_equal(const PointMap& map, const PointMap& truth, double most) {
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    EXPECT_LT((map.points[i].p_world - truth.points[i].p_world).norm(), most) << "point " << i;
  }
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    EXPECT_LT(difference(map.keyframes[k].T_world_camera, truth.keyframes[k].T_world_camera).norm(), most)
        << "keyframe " << k;
  }
}

TEST_F(BundleAdjustment, ReturnsToTheTruth) {
  BundleOptions options = global_bundle_options(truth_, 2);
  options.max_iterations = 100;
  const BundleResult result = adjust_bundle(camera_, perturbed_but(2, truth_), options);
  expect_equal(result.map, truth_, 1e-4);
  EXPECT_GT(result.rms_px_before, 2.0);
  EXPECT_LT(result.rms_px_after, 1e-2);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.focal_factor, 1.0);
  std::size_t sightings = 0;
  for (const Keyframe& keyframe : truth_.keyframes) sightings += keyframe.sightings.size();
  EXPECT_EQ(result.sighting_count, static_cast<int>(sightings));
}

TEST_F(BundleAdjustment, ReturnsToTheTruthUpToTheFreeGauge) {
  BundleOptions options = global_bundle_options(truth_, 0);
  options.max_iterations = 100;
  PointMap map = adjust_bundle(camera_, perturbed(truth_, 0.05, 0.01), options).map;
  std::vector<Eigen::Vector3d> found, expected;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    found.push_back(map.points[i].p_world);
    expected.push_back(truth_.points[i].p_world);
  }
  const auto similarity = align_points(found, expected, AlignmentKind::Similarity);
  ASSERT_TRUE(similarity);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_LT((*similarity * found[i] - expected[i]).norm(), 1e-4);
}

TEST_F(BundleAdjustment, DoesNotMoveFixedKeyframes) {
  const PointMap before = perturbed(truth_, 0.05, 0.01);
  BundleOptions options;
  options.fixed_keyframes = {1, 4};
  options.free_keyframes = {2, 3};
  const PointMap after = adjust_bundle(camera_, before, options).map;
  for (std::size_t k = 0; k < 6; ++k) {
    const bool is_free = k == 2 || k == 3;
    EXPECT_EQ(after.keyframes[k].T_world_camera.matrix() != before.keyframes[k].T_world_camera.matrix(), is_free) << k;
  }
}

// Point 0 is seen by a fixed keyframe alone, point 1 once: neither moves.
TEST_F(BundleAdjustment, DoesNotMovePointsThatNoFreeKeyframeHolds) {
  PointMap before = perturbed_but(2, truth_);
  for (std::size_t k = 0; k < before.keyframes.size(); ++k) {
    std::erase_if(before.keyframes[k].sightings,
                  [k](const Sighting& s) { return (s.point == 0 && k >= 2) || (s.point == 1 && k != 3); });
  }
  const PointMap after = adjust_bundle(camera_, before, global_bundle_options(before, 2)).map;
  EXPECT_EQ(after.points[0].p_world, before.points[0].p_world);
  EXPECT_EQ(after.points[1].p_world, before.points[1].p_world);
  EXPECT_NE(after.points[2].p_world, before.points[2].p_world);
}

TEST_F(BundleAdjustment, BearsOutlyingSightings) {
  PointMap map = perturbed_but(2, truth_);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    for (std::size_t s = k; s < map.keyframes[k].sightings.size(); s += 20)
      map.keyframes[k].sightings[s].pixel.x() += 60;
  }
  BundleOptions options = global_bundle_options(map, 2);
  options.max_iterations = 100;
  const PointMap after = adjust_bundle(camera_, map, options).map;
  for (std::size_t k = 2; k < 6; ++k) {
    EXPECT_LT(difference(after.keyframes[k].T_world_camera, truth_.keyframes[k].T_world_camera).norm(), 0.01) << k;
  }
}

TEST_F(BundleAdjustment, FindsTheFocalLengthThatFits) {
  PointMap map = test::make_map(camera_, 80, 6, 0.3, random_);
  Camera wrong = camera_;
  wrong.fx /= 1.1;
  wrong.fy /= 1.1;
  BundleOptions options = global_bundle_options(map, 1);
  options.max_iterations = 200;
  const PointMap converged = adjust_bundle(wrong, map, options).map;
  options.refine_focal = true;
  const BundleResult result = adjust_bundle(wrong, converged, options);
  EXPECT_NEAR(result.focal_factor, 1.1, 0.01);
  EXPECT_GT(result.focal_factor_sigma, 0.0);
  EXPECT_LT(result.focal_factor_sigma, 0.01);
  EXPECT_LT(result.rms_px_after, 0.5);
}

TEST_F(BundleAdjustment, IsTheSameTwiceToTheBit) {
  const PointMap map = perturbed_but(2, truth_);
  const auto first = adjust_bundle(camera_, map, global_bundle_options(map, 2));
  const auto second = adjust_bundle(camera_, map, global_bundle_options(map, 2));
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    ASSERT_EQ(first.map.points[i].p_world, second.map.points[i].p_world) << i;
  }
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    ASSERT_EQ(first.map.keyframes[k].T_world_camera.matrix(), second.map.keyframes[k].T_world_camera.matrix()) << k;
  }
}

TEST_F(BundleAdjustment, LeavesAMapWithoutSightingsAsItIs) {
  for (Keyframe& keyframe : truth_.keyframes) keyframe.sightings.clear();
  const BundleResult result = adjust_bundle(camera_, truth_, global_bundle_options(truth_, 1));
  EXPECT_EQ(result.sighting_count, 0);
  EXPECT_EQ(result.rms_px_before, 0.0);
  expect_equal(result.map, truth_, 1e-15);
}

TEST_F(BundleAdjustment, RefusesIndicesOutOfRange) {
  BundleOptions options;
  options.free_keyframes = {6};
  EXPECT_THROW(adjust_bundle(camera_, truth_, options), std::invalid_argument);
  options.free_keyframes = {0};
  options.fixed_keyframes = {-1};
  EXPECT_THROW(adjust_bundle(camera_, truth_, options), std::invalid_argument);
  truth_.keyframes[0].sightings[0].point = 80;
  EXPECT_THROW(adjust_bundle(camera_, truth_, global_bundle_options(truth_, 1)), std::invalid_argument);
}

TEST_F(BundleAdjustment, OfAllKeyframesHoldsTheFirst) {
  const BundleOptions options = global_bundle_options(truth_, 2);
  EXPECT_EQ(options.fixed_keyframes, (std::vector<int>{0, 1}));
  EXPECT_EQ(options.free_keyframes, (std::vector<int>{2, 3, 4, 5}));
}

TEST_F(BundleAdjustment, LosesOutlyingSightingsAndThePointsThatTheyLeaveAlone) {
  for (Keyframe& keyframe : truth_.keyframes) {
    keyframe.sightings = {keyframe.sightings[0], keyframe.sightings[1]};
    for (int i = 0; i < 2; ++i) keyframe.sightings[static_cast<std::size_t>(i)].point = i;
    for (Sighting& s : keyframe.sightings) {
      const Eigen::Vector3d& p_world = truth_.points[static_cast<std::size_t>(s.point)].p_world;
      s.pixel = project(camera_, keyframe.T_world_camera.inverse() * p_world)->pixel;
      s.sigma_px = 2.0;
    }
  }
  truth_.keyframes[0].sightings[0].pixel.x() += 7.9;                                     // below four sigmas
  truth_.keyframes[1].sightings[0].pixel.y() += 8.1;                                     // beyond
  for (std::size_t k = 1; k < 6; ++k) truth_.keyframes[k].sightings[1].pixel.x() -= 30;  // one sighting left
  const SightingCut cut = remove_outlying_sightings(camera_, truth_, 4.0);
  EXPECT_EQ(cut.removed, 1 + 6);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& left = cut.map.keyframes[k].sightings;
    ASSERT_EQ(left.size(), k == 1 ? 0u : 1u) << k;
    if (k != 1) {
      EXPECT_EQ(left[0].point, 0);
    }
  }
}

TEST_F(BundleAdjustment, LosesSightingsBehindTheCamera) {
  for (std::size_t k = 0; k < 6; ++k) {
    Keyframe& keyframe = truth_.keyframes[k];
    if (k == 2) keyframe.T_world_camera.linear() *= exp_so3(Eigen::Vector3d(0, 3.14159265, 0));
  }
  const SightingCut cut = remove_outlying_sightings(camera_, truth_, 1e6);
  EXPECT_TRUE(cut.map.keyframes[2].sightings.empty());
  EXPECT_EQ(cut.map.keyframes[3].sightings.size(), truth_.keyframes[3].sightings.size());
}

// Noise of 1.5 px announced as 0.5 px; a tenth of outliers hardly moves the median, and all of the mean square.
TEST_F(BundleAdjustment, MeasuresTheNoiseByTheMedian) {
  PointMap map = test::make_map(camera_, 300, 6, 1.5, random_);
  for (Keyframe& keyframe : map.keyframes) {
    for (Sighting& s : keyframe.sightings) s.sigma_px = 0.5;
  }
  EXPECT_NEAR(reprojection_sigma(camera_, map), 3.0, 0.15);
  EXPECT_NEAR(reprojection_rms_px(camera_, map), 1.5 * std::sqrt(2.0), 0.1);
  for (Keyframe& keyframe : map.keyframes) {
    for (std::size_t s = 0; s < keyframe.sightings.size(); s += 10) keyframe.sightings[s].pixel.x() += 100;
  }
  EXPECT_NEAR(reprojection_sigma(camera_, map), 3.2, 0.25);
  EXPECT_GT(reprojection_rms_px(camera_, map), 20.0);
  EXPECT_EQ(reprojection_sigma(camera_, {}), 1.0);
  EXPECT_EQ(reprojection_rms_px(camera_, {}), 0.0);
}

}  // namespace
}  // namespace alidade
