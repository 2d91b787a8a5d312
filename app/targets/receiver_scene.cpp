// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_scene.h"

#include <algorithm>

namespace alidade {

void add_receivers(std::span<const Receiver> receivers, double size_m, Scene& scene) {
  for (const Receiver& receiver : receivers) {
    CameraPyramid pyramid;
    pyramid.T_world_camera = receiver.T_world_receiver;
    pyramid.colour = palette::kInk;
    pyramid.depth_m = size_m;
    if (receiver.camera) {
      pyramid.half_extent = {0.5 * receiver.camera->width / receiver.camera->fx,
                             0.5 * receiver.camera->height / receiver.camera->fy};
    }
    scene.cameras.push_back(pyramid);
    scene.labels.push_back({receiver.T_world_receiver.translation(), receiver.name, palette::kInk});
  }
  scene.legend.push_back({"receivers", palette::kInk, PyramidStyle::Hollow});
}

double receiver_size_m(std::span<const Receiver> receivers, Eigen::AlignedBox3d box) {
  for (const Receiver& receiver : receivers) box.extend(Eigen::Vector3d(receiver.T_world_receiver.translation()));
  return box.isEmpty() ? 1.0 : std::max(1e-3, 0.04 * box.diagonal().norm());
}

}  // namespace alidade
