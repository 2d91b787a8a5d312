// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/view_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "calib/cameras/view_diversity.h"

namespace alidade {
namespace {

// Speed of the board at each view, px from frame to frame: the faster of before and after.
std::vector<double> speeds_px(std::span<const BoardView> views) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  std::vector<double> speeds(views.size(), kUnknown);
  for (std::size_t i = 0; i + 1 < views.size(); ++i) {
    const int frames = views[i + 1].frame - views[i].frame;
    const auto motion = view_motion_px(views[i], views[i + 1]);
    if (!motion || frames < 1 || frames > 5) continue;
    const double speed = *motion / frames;
    for (const std::size_t side : {i, i + 1}) {
      speeds[side] = std::isfinite(speeds[side]) ? std::max(speeds[side], speed) : speed;
    }
  }
  return speeds;
}

}  // namespace

std::optional<double> view_motion_px(const BoardView& from, const BoardView& to) {
  const CommonMotion motion = common_motion(from.corners, to.corners);
  return motion.corners > 0 ? std::optional(motion.rms_px) : std::nullopt;
}

std::vector<int> select_views(std::span<const BoardView> views, const ImageExtent& image,
                              const ViewSelectionOptions& options) {
  const std::vector<double> speeds = speeds_px(views);
  std::vector<int> by_speed(views.size());
  std::iota(by_speed.begin(), by_speed.end(), 0);
  std::stable_sort(by_speed.begin(), by_speed.end(), [&](int a, int b) {
    return speeds[static_cast<std::size_t>(a)] < speeds[static_cast<std::size_t>(b)];
  });
  std::vector<int> chosen;
  for (const int candidate : by_speed) {
    const BoardView& view = views[static_cast<std::size_t>(candidate)];
    const bool is_still = speeds[static_cast<std::size_t>(candidate)] <= options.still_px;
    if (static_cast<int>(chosen.size()) >= options.most || (!is_still && chosen.size() >= 10)) break;
    const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](int other) {
      const auto motion = view_motion_px(view, views[static_cast<std::size_t>(other)]);
      return motion && *motion < options.distinct_share * image.width;
    });
    if (is_new) chosen.push_back(candidate);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace alidade
