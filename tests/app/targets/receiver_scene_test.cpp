// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_scene.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::vector<Receiver> finder_and_camera() {
  Receiver finder, watcher;
  finder.name = "hill";
  watcher.id = 1;
  watcher.name = "roof";
  watcher.T_world_receiver.translation() = Eigen::Vector3d(30, 40, 0);
  watcher.camera = Camera{};
  watcher.camera->width = 800;
  watcher.camera->height = 400;
  watcher.camera->fx = 400;
  watcher.camera->fy = 800;
  return {finder, watcher};
}

TEST(ReceiverScene, HasAPyramidAndANameForEachReceiver) {
  Scene scene;
  add_receivers(finder_and_camera(), 2.5, scene);
  ASSERT_EQ(scene.cameras.size(), 2u);
  ASSERT_EQ(scene.labels.size(), 2u);
  EXPECT_EQ(scene.labels[0].text, "hill");
  EXPECT_EQ(scene.labels[1].text, "roof");
  EXPECT_EQ(scene.labels[1].p_world, Eigen::Vector3d(30, 40, 0));
  EXPECT_EQ(scene.cameras[1].depth_m, 2.5);
  EXPECT_EQ(scene.cameras[1].half_extent, Eigen::Vector2d(1.0, 0.25));  // a camera's own view
  EXPECT_EQ(scene.cameras[0].half_extent, CameraPyramid{}.half_extent);
  EXPECT_EQ(scene.legend.size(), 1u);
}

TEST(ReceiverScene, SizesReceiversByAllThatThereIsToSee) {
  EXPECT_NEAR(receiver_size_m(finder_and_camera(), {}), 0.04 * 50.0, 1e-12);
  const Eigen::AlignedBox3d far_off(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(300, 400, 0));
  EXPECT_NEAR(receiver_size_m(finder_and_camera(), far_off), 0.04 * 500.0, 1e-12);
  EXPECT_EQ(receiver_size_m({}, {}), 1.0);
  EXPECT_EQ(receiver_size_m(std::vector<Receiver>(2), {}), 1e-3);  // both in one place
}

}  // namespace
}  // namespace alidade
