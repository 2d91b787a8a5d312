// SPDX-License-Identifier: Apache-2.0
#include "app/board_simulation.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calib/boards/board_text.h"
#include "calib/boards/marker_detection.h"

namespace alidade {
namespace {

BoardSimulationOptions two_images() {
  BoardSimulationOptions options;
  options.board = parse_board("charuco:7x5:30mm:20mm:4X4_50");
  options.camera = {320, 240, 260, 260, 159.5, 119.5, BrownConrady{-0.2}};
  options.images = 2;
  options.poses.least_fill = 0.7;
  options.poses.most_tilt_deg = 20;
  options.rendering.noise_grey = 1;
  options.bulge_mm = {3, -2};
  return options;
}

TEST(BoardSimulation, ShowsTheBoardWhereItsPoseSays) {
  const BoardSimulationOptions options = two_images();
  const BoardSimulation simulation(options);
  ASSERT_EQ(simulation.count(), 2);
  const auto view = detect_markers_board(simulation.image(1), options.board);
  ASSERT_TRUE(view);
  const PlaneBulge bulge{{0.003, -0.002}, {0.075, 0.045}, {0.105, 0.075}};
  const auto corners = corners_m(options.board);
  for (const BoardCorner& corner : view->corners) {
    Eigen::Vector3d p = corners[static_cast<std::size_t>(corner.id)];
    p.z() = height_m(bulge, p.head<2>());
    const auto truth = project(options.camera, simulation.T_board_camera(1).inverse() * p);
    EXPECT_LT((corner.pixel - truth->pixel).norm(), 0.5) << corner.id;
  }
}

TEST(BoardSimulation, IsThatOfItsSeed) {
  BoardSimulationOptions options = two_images();
  const cv::Mat first = BoardSimulation(options).image(0);
  EXPECT_EQ(cv::norm(first, BoardSimulation(options).image(0), cv::NORM_INF), 0);
  options.seed = 2;
  EXPECT_GT(cv::norm(first, BoardSimulation(options).image(0), cv::NORM_INF), 0);
}

TEST(BoardSimulation, SaysWhatItWrote) {
  const nlohmann::json summary = summary_of(two_images(), 1);
  EXPECT_EQ(summary["board"], "charuco:7x5:30mm:20mm:4X4_50");
  EXPECT_EQ(summary["images"], 1);
  EXPECT_EQ(summary["interrupted"], true);
  EXPECT_EQ(report_of(two_images(), {}, 1).warnings.size(), 1u);
  EXPECT_TRUE(report_of(two_images(), {}, 2).warnings.empty());
}

TEST(BoardSimulation, RefusesWhatCannotBe) {
  BoardSimulationOptions options = two_images();
  options.images = 0;
  EXPECT_THROW(BoardSimulation{options}, std::invalid_argument);
  options = two_images();
  options.bulge_mm = {500, 0};
  EXPECT_THROW(BoardSimulation{options}, std::invalid_argument);
}

}  // namespace
}  // namespace alidade
