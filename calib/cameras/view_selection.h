// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/boards/board_view.h"
#include "calib/cameras/camera_start.h"

namespace alidade {

struct ViewSelectionOptions {
  int most = 60;                 ///< views; more add little and cost time
  double still_px = 1.0;         ///< a board that moved further between two successive frames is blurred or skewed
  double distinct_share = 0.03;  ///< of the image's width: by so much a view has to differ from all chosen ones
};

/// Which views of a film to calibrate from: where the board rests, each different from the others, in order. Views come
/// in order of frames; `frame` tells which follow each other. Where the board never rests, the slowest views serve.
std::vector<int> select_views(std::span<const BoardView> views, const ImageExtent& image,
                              const ViewSelectionOptions& options = {});

/// How far a board moved from one view to another: RMS distance (px) of the corners that both show, empty for none.
std::optional<double> view_motion_px(const BoardView& from, const BoardView& to);

}  // namespace alidade
