// SPDX-License-Identifier: Apache-2.0
#include "tracking/world_frame.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruction/bundle_adjustment.h"
#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 71;

// A world in metres, and the map of it that a single camera makes: in a frame and a scale of its own.
class WorldFrame : public testing::Test {
 protected:
  WorldFrame() {
    map_of_world_.scale = 0.3;
    map_of_world_.T_target_source = random_.pose();
    for (const Keyframe& keyframe : world_.keyframes) {
      FrameReport report;
      report.index = keyframe.frame;
      report.time = keyframe.time;
      report.state = FrameState::Tracked;
      report.T_world_camera = keyframe.T_world_camera;
      report.covariance = keyframe.covariance;
      truth_.push_back(report);
    }
    reports_ = transform(map_of_world_, truth_);
  }

  // Where a similarity from the map moves a point of the world.
  Eigen::Vector3d moved(const Similarity& T_metric_map, const Eigen::Vector3d& p_world) const {
    return T_metric_map * (map_of_world_ * p_world);
  }

  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  PointMap world_ = test::make_map(camera_, 40, 5, 0.0, random_);
  Similarity map_of_world_;
  std::vector<FrameReport> truth_, reports_;
};

// Pixels do not change with frame and scale; covariances do with the scale: a point's turn along, a pose's stay in its
// axes.
TEST_F(WorldFrame, MovesMapsWithTheirCovariances) {
  world_.points[3].covariance_world = Eigen::Vector3d(1, 2, 3).asDiagonal();
  Matrix6d A;
  for (double& value : A.reshaped()) value = random_.normal();
  world_.keyframes[1].covariance = A * A.transpose();
  const PointMap map = transform(map_of_world_, world_);
  EXPECT_LT(reprojection_rms_px(camera_, map), 1e-9);
  const Eigen::Matrix3d R = map_of_world_.T_target_source.linear();
  const Eigen::Matrix3d expected = 0.09 * R * world_.points[3].covariance_world * R.transpose();
  EXPECT_LT((map.points[3].covariance_world - expected).norm(), 1e-12);
  const Vector6d scales = (Vector6d() << 0.3, 0.3, 0.3, 1, 1, 1).finished();
  const Matrix6d expected_pose = scales.asDiagonal() * world_.keyframes[1].covariance * scales.asDiagonal();
  EXPECT_LT((map.keyframes[1].covariance - expected_pose).norm(), 1e-12);
}

TEST_F(WorldFrame, MovesReportsLikeKeyframes) {
  truth_[2].covariance = Matrix6d::Ones();
  const auto reports = transform(map_of_world_, truth_);
  const PointMap map = transform(map_of_world_, world_);
  EXPECT_LT((reports[2].T_world_camera.matrix() - map.keyframes[2].T_world_camera.matrix()).norm(), 1e-12);
  EXPECT_NEAR(reports[2].covariance(0, 0), 0.09, 1e-12);
  EXPECT_NEAR(reports[2].covariance(1, 4), 0.3, 1e-12);
  EXPECT_NEAR(reports[2].covariance(5, 5), 1.0, 1e-12);
}

TEST_F(WorldFrame, IsFoundFromGivenPoses) {
  Trajectory given;
  for (std::size_t i : {1u, 3u}) given.push_back({truth_[i].time, truth_[i].T_world_camera, std::nullopt});
  const auto similarity = similarity_to_given_poses(reports_, given);
  ASSERT_TRUE(similarity);
  EXPECT_NEAR(similarity->scale, 1 / 0.3, 1e-9);
  for (const MapPoint& point : world_.points)
    EXPECT_LT((moved(*similarity, point.p_world) - point.p_world).norm(), 1e-9);
}

TEST_F(WorldFrame, IsNotFoundFromOneGivenPose) {
  Trajectory given{{truth_[1].time, truth_[1].T_world_camera, std::nullopt}};
  EXPECT_FALSE(similarity_to_given_poses(reports_, given));
  given.push_back({truth_[3].time, truth_[3].T_world_camera, std::nullopt});
  reports_[3].state = FrameState::Lost;
  EXPECT_FALSE(similarity_to_given_poses(reports_, given));
  reports_[3].state = FrameState::Predicted;
  EXPECT_TRUE(similarity_to_given_poses(reports_, given));
  given[1].T_world_camera.translation() = given[0].T_world_camera.translation();
  EXPECT_FALSE(similarity_to_given_poses(reports_, given));
}

TEST_F(WorldFrame, HasTheScaleOfAKnownDistance) {
  const double distance = (truth_[0].T_world_camera.translation() - truth_[4].T_world_camera.translation()).norm();
  const auto similarity = similarity_from_distance(reports_, {0, 4, distance});
  ASSERT_TRUE(similarity);
  EXPECT_NEAR(similarity->scale, 1 / 0.3, 1e-9);
  EXPECT_TRUE(similarity->T_target_source.matrix().isIdentity());
  EXPECT_FALSE(similarity_from_distance(reports_, {0, 5, distance}));
  EXPECT_FALSE(similarity_from_distance(reports_, {2, 2, distance}));
  reports_[4].state = FrameState::Waiting;
  EXPECT_FALSE(similarity_from_distance(reports_, {0, 4, distance}));
}

// A marker that faces the cameras: its x is world y, its y up, its z towards them.
class MarkerFrame : public WorldFrame {
 protected:
  MarkerFrame() {
    T_world_marker_.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    T_world_marker_.translation() = Eigen::Vector3d(0.2, -0.3, 0.4);
  }

  MarkerSighting see(int id, const Eigen::Isometry3d& T_world_marker, double side_m, std::size_t frame,
                     double stretch = 1.0) const {
    const double h = 0.5 * side_m;
    const std::array<Eigen::Vector3d, 4> corners{
        {{-h, h * stretch, 0}, {h, h * stretch, 0}, {h, -h * stretch, 0}, {-h, -h * stretch, 0}}};
    MarkerSighting sighting{id, {}};
    const Eigen::Isometry3d T_camera_marker = truth_[frame].T_world_camera.inverse() * T_world_marker;
    for (std::size_t c = 0; c < 4; ++c) sighting.corners[c] = project(camera_, T_camera_marker * corners[c])->pixel;
    return sighting;
  }

  Eigen::Isometry3d T_world_marker_ = Eigen::Isometry3d::Identity();
};

TEST_F(MarkerFrame, IsFoundFromAMarker) {
  std::vector<FrameMarkers> seen;
  for (std::size_t k = 0; k < 3; ++k) seen.push_back({static_cast<int>(k), {see(7, T_world_marker_, 0.25, k)}});
  const auto similarity = similarity_from_marker(camera_, reports_, seen, 0.25);
  ASSERT_TRUE(similarity);
  EXPECT_NEAR(similarity->scale, 1 / 0.3, 1e-6);
  for (const MapPoint& point : world_.points) {
    const Eigen::Vector3d p_marker = T_world_marker_.inverse() * point.p_world;
    EXPECT_LT((moved(*similarity, point.p_world) - p_marker).norm(), 1e-5);
  }
}

TEST_F(MarkerFrame, IsOfTheMarkerSeenMostOftenOrOfTheOneAskedFor) {
  Eigen::Isometry3d T_world_other = T_world_marker_;
  T_world_other.translation() = Eigen::Vector3d(0.5, 0.6, -0.2);
  std::vector<FrameMarkers> seen;
  for (std::size_t k = 0; k < 3; ++k) {
    seen.push_back({static_cast<int>(k), {see(9, T_world_marker_, 0.25, k)}});
    if (k < 2) seen.back().markers.push_back(see(4, T_world_other, 0.25, k));
  }
  const auto most = similarity_from_marker(camera_, reports_, seen, 0.25);
  const auto asked = similarity_from_marker(camera_, reports_, seen, 0.25, 4);
  ASSERT_TRUE(most && asked);
  EXPECT_LT(moved(*most, T_world_marker_.translation()).norm(), 1e-5);
  EXPECT_LT(moved(*asked, T_world_other.translation()).norm(), 1e-5);
  EXPECT_FALSE(similarity_from_marker(camera_, reports_, seen, 0.25, 5));
}

// Marker 9 is in more frames, but only one of them has a pose.
TEST_F(MarkerFrame, CountsOnlyFramesWithPoses) {
  Eigen::Isometry3d T_world_other = T_world_marker_;
  T_world_other.translation() = Eigen::Vector3d(0.5, 0.6, -0.2);
  std::vector<FrameMarkers> seen;
  for (std::size_t k = 0; k < 5; ++k) {
    seen.push_back({static_cast<int>(k), {}});
    if (k >= 1) seen.back().markers.push_back(see(9, T_world_marker_, 0.25, k));
    if (k < 2) seen.back().markers.push_back(see(4, T_world_other, 0.25, k));
    if (k >= 2) reports_[k].state = FrameState::Lost;
  }
  const auto similarity = similarity_from_marker(camera_, reports_, seen, 0.25);
  ASSERT_TRUE(similarity);
  EXPECT_LT(moved(*similarity, T_world_other.translation()).norm(), 1e-5);
}

TEST_F(MarkerFrame, IsNotFoundFromOneSightOrFromNoSquare) {
  EXPECT_FALSE(similarity_from_marker(camera_, reports_, {}, 0.25));
  EXPECT_FALSE(similarity_from_marker(camera_, reports_, {{0, {see(7, T_world_marker_, 0.25, 0)}}}, 0.25));
  for (const auto& [stretch, is_square] : {std::pair{1.08, false}, std::pair{1.03, true}}) {
    std::vector<FrameMarkers> seen;
    for (std::size_t k = 0; k < 3; ++k) {
      seen.push_back({static_cast<int>(k), {see(7, T_world_marker_, 0.25, k, stretch)}});
    }
    EXPECT_EQ(similarity_from_marker(camera_, reports_, seen, 0.25).has_value(), is_square) << stretch;
  }
}

TEST(FrameReport, HasAPoseWhileTrackedOrPredicted) {
  FrameReport report;
  std::vector<std::string> words;
  for (const FrameState state : {FrameState::Waiting, FrameState::Tracked, FrameState::Predicted, FrameState::Lost}) {
    report.state = state;
    EXPECT_EQ(report.has_pose(), state == FrameState::Tracked || state == FrameState::Predicted);
    words.emplace_back(to_string(state));
  }
  EXPECT_EQ(words, (std::vector<std::string>{"waiting", "tracked", "predicted", "lost"}));
}

}  // namespace
}  // namespace alidade
