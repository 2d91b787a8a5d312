// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/board_images.h"

namespace alidade {

/// How images of several cameras were told to belong together; Motion: of the board, by films without a common clock.
enum class MomentsBy { Time, Number, Order, Motion };

/// Which images belong to one moment.
struct Moments {
  MomentsBy by = MomentsBy::Order;
  int count = 0;
  std::vector<std::vector<int>> of_view;  ///< by camera, then view: the moment
};

/// Images of one moment have nearly the same time (within half the shortest frame interval), where all sources have
/// times; else the same last number in their names (left07.jpg, right07.jpg), where those are unique in every source;
/// else the same place in the order.
Moments match_moments(std::span<const BoardImages> cameras);

/// A camera's name after its source: the folder's name, or what precedes the wildcards or number of a glob or file.
std::string camera_name(const std::string& source, int index);

}  // namespace alidade
