// SPDX-License-Identifier: Apache-2.0
#include "app/posed_images.h"

#include <algorithm>

#include "io/image_files.h"

namespace alidade {

bool has_depth(const Dataset& dataset) {
  return std::any_of(dataset.frames.begin(), dataset.frames.end(),
                     [](const DatasetFrame& frame) { return frame.depth.has_value(); });
}

std::optional<PosedImage> posed_image(const CameraSource& source, const ImageFrame& frame, const Trajectory& poses) {
  constexpr std::chrono::milliseconds kLongestGap{100}, kHalfSpan{15};
  const auto T = pose_at(poses, frame.time, kLongestGap);
  if (!T) return std::nullopt;
  PosedImage image{frame, *T, Vector6d::Zero(), {}, 1.0};
  image.twist = twist_at(poses, frame.time, kHalfSpan, kLongestGap).value_or(Vector6d(Vector6d::Zero()));
  if (!source.dataset || !has_depth(*source.dataset)) return image;
  const DatasetFrame& listed = source.dataset->frames[static_cast<std::size_t>(frame.index)];
  if (!listed.depth) return std::nullopt;
  image.depth = read_depth(*listed.depth);
  image.depth_delay_s = to_seconds(listed.depth_time - listed.time);
  image.depth_unit_m = source.dataset->depth_unit_m;
  return image;
}

}  // namespace alidade
