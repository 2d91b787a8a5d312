// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/boards/board_view.h"
#include "camera/camera.h"

namespace alidade {

/// How an interpolated corner changes with time.
struct CornerMotion {
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();
  /// Of the variance of its noise: least midway between two frames, so that noise alone seems to prefer that.
  double variance_rate_px2_s = 0;
};

/// What a film shows of the board at a moment between its frames.
struct FilmMoment {
  BoardView view;  ///< name and frame of the nearest one; the corners' sigma_px includes the interpolation's error
  std::vector<CornerMotion> motion;  ///< of every corner
  int first = 0;                     ///< of the four views that it is made of
};

/// A film of a moving board in one camera's clock: views in order of their times, some frames may lack.
class BoardFilm {
 public:
  /// Throws std::invalid_argument where times do not increase.
  explicit BoardFilm(std::vector<BoardView> views);

  const std::vector<BoardView>& views() const { return views_; }
  double interval_s() const { return interval_s_; }  ///< median from view to view; 0 for fewer than two

  /// The corners at a time of this camera's clock that all of the two views before and the two after it show, on the
  /// cubic through these four. How far the board leaves the cubic is told by how well its neighbours foretell the
  /// nearest views. Empty outside the film and where frames lack.
  std::optional<FilmMoment> at(double time_s) const;

 private:
  bool is_gapless(std::size_t first, std::size_t last) const;
  double fourth_derivative_px_s4(std::size_t middle) const;

  std::vector<BoardView> views_;
  double interval_s_ = 0;
};

/// A film and the lens that it was taken through.
struct CameraFilm {
  Camera camera;
  BoardFilm film;
};

}  // namespace alidade
