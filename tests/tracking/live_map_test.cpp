// SPDX-License-Identifier: Apache-2.0
#include "tracking/live_map.h"

#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

// Keyframe 0 sees points 0, 1, 2; keyframe 1 sees 2, 1; keyframe 2 sees 4. Nobody sees point 3. Point i is i + 1 m
// deep.
PointMap five_points() {
  PointMap map;
  map.points.resize(5);
  for (int i = 0; i < 5; ++i) map.points[static_cast<std::size_t>(i)].p_world = {0, 0, i + 1.0};
  map.keyframes.resize(3);
  const std::vector<std::vector<int>> seen{{0, 1, 2}, {2, 1}, {4}};
  for (std::size_t k = 0; k < 3; ++k) {
    for (int point : seen[k])
      map.keyframes[k].sightings.push_back({point, {10.0 * point, 1.0 * static_cast<double>(k)}, 0.5});
    map.keyframes[k].T_world_camera.translation().z() = -1.0 * static_cast<double>(k);
    map.keyframes[k].covariance = static_cast<double>(k) * Matrix6d::Identity();
  }
  return map;
}

TEST(LiveMap, IndexesTheViewsOfEveryPoint) {
  const auto views = index_views(five_points());
  ASSERT_EQ(views.size(), 5u);
  ASSERT_EQ(views[2].size(), 2u);
  EXPECT_EQ(views[2][0].keyframe, 0);
  EXPECT_EQ(views[2][0].sighting, 2);
  EXPECT_EQ(views[2][1].keyframe, 1);
  EXPECT_EQ(views[2][1].sighting, 0);
  EXPECT_TRUE(views[3].empty());
}

TEST(LiveMap, PosesTheSightingsOfAPoint) {
  const PointMap map = five_points();
  const auto sightings = posed_sightings(map, index_views(map)[1]);
  ASSERT_EQ(sightings.size(), 2u);
  EXPECT_EQ(sightings[1].pixel, Eigen::Vector2d(10, 1));
  EXPECT_EQ(sightings[1].sigma_px, 0.5);
  EXPECT_EQ(sightings[1].T_world_camera.translation().z(), -1.0);
  EXPECT_EQ(sightings[1].pose_covariance, map.keyframes[1].covariance);
}

TEST(LiveMap, CountsSharedPoints) {
  EXPECT_EQ(shared_points(five_points(), 0), (std::vector<int>{0, 2, 0}));
  EXPECT_EQ(shared_points(five_points(), 2), (std::vector<int>{0, 0, 0}));
}

TEST(LiveMap, HasLivingPointsSeenTwice) {
  PointMap map = five_points();
  EXPECT_EQ(living_points(map), (std::vector<int>{1, 2}));
  map.keyframes.clear();
  EXPECT_EQ(living_points(map), (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(LiveMap, DropsUnseenPointsAndRenumbers) {
  const PointMap map = without_unseen_points(five_points());
  ASSERT_EQ(map.points.size(), 4u);
  EXPECT_EQ(map.points[3].p_world.z(), 5.0);
  EXPECT_EQ(map.keyframes[2].sightings[0].point, 3);
  EXPECT_EQ(map.keyframes[1].sightings[0].point, 2);
  PointMap loaded = five_points();
  loaded.keyframes.clear();
  EXPECT_EQ(without_unseen_points(loaded).points.size(), 5u);
}

TEST(LiveMap, KnowsTheMedianDepth) {
  PointMap map = five_points();
  EXPECT_DOUBLE_EQ(median_depth(map, 0), 2.0);
  EXPECT_DOUBLE_EQ(median_depth(map, 2), 7.0);
  map.keyframes[0].sightings.clear();
  EXPECT_EQ(median_depth(map, 0), 0.0);
}

TEST(LiveMap, FreesTheFeaturesOfRemovedSightings) {
  LiveMap live;
  live.map = five_points();
  live.features.resize(3);
  live.features[0].point_of_feature = {-1, 2, 0, 1};
  live.features[1].point_of_feature = {1, 2};
  live.features[2].point_of_feature = {4};
  live.map.keyframes[0].sightings.erase(live.map.keyframes[0].sightings.begin() + 2);  // point 2
  release_removed_sightings(live);
  EXPECT_EQ(live.features[0].point_of_feature, (std::vector<int>{-1, -1, 0, 1}));
  EXPECT_EQ(live.features[1].point_of_feature, (std::vector<int>{1, 2}));
  EXPECT_EQ(live.features[2].point_of_feature, (std::vector<int>{4}));
}

}  // namespace
}  // namespace alidade
