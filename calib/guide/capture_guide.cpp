// SPDX-License-Identifier: Apache-2.0
#include "calib/guide/capture_guide.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "calib/bundle/board_placement.h"
#include "calib/cameras/view_selection.h"

namespace alidade {
namespace {

// Of lenses that are neither wide nor long; a fisheye's image is about three focal lengths wide.
Camera guess_camera(LensModel lens, const ImageExtent& image) {
  return start_camera(lens, image.width, image.height, (lens == LensModel::Fisheye ? 0.35 : 0.9) * image.width);
}

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

Board checked(const Board& board) {
  if (const auto fault = find_fault(board)) throw std::invalid_argument(*fault);
  return board;
}

}  // namespace

void validate(const CaptureGuideOptions& o) {
  validate(o.coverage);
  require(o.enough_px > 0, fmt::format("enough_px must be > 0 px, got {}", o.enough_px));
  require(o.still_share > 0, fmt::format("still_share must be > 0, got {}", o.still_share));
  require(o.still_s >= 0, fmt::format("still_s must be >= 0 s, got {}", o.still_s));
  require(o.distinct_share > o.still_share,
          fmt::format("distinct_share must be > still_share, got {}", o.distinct_share));
  require(o.least_views >= 3, fmt::format("least_views must be >= 3, got {}", o.least_views));
}

CaptureGuide::CaptureGuide(const Board& board, const ImageExtent& image, const CaptureGuideOptions& options)
    : shape_(shape_of(checked(board))), image_(image), options_(options) {
  validate(options);
  require(image.width > 0 && image.height > 0, fmt::format("an image of {}x{} px", image.width, image.height));
  camera_ = guess_camera(options.lens, image);
  coverage_ = coverage_of(image_, accepted_, stances_, options_.coverage);
  update_wish();
}

GuideStep CaptureGuide::see(const std::optional<BoardView>& view, double time_s) {
  GuideStep step;
  if (view) {
    step.state = judge(*view, time_s);
    step.stance = step.state == CaptureState::Accepted ? stances_.back() : stance_of_view(*view);
  } else {
    rest_.reset();
  }
  step.is_enough = is_enough();
  if (!step.is_enough) step.wish = wish_;
  step.coverage = shares_of(coverage_, options_.coverage);
  step.estimate = estimate_;
  step.accepted = static_cast<int>(accepted_.size());
  return step;
}

CaptureState CaptureGuide::judge(const BoardView& view, double time_s) {
  for (const BoardCorner& corner : view.corners) {
    require(corner.id >= 0 && corner.id < static_cast<int>(shape_.corners_m.size()),
            fmt::format("the board has no corner {}", corner.id));
  }
  if (!rests(view, time_s)) return CaptureState::Moving;
  if (time_s - rest_->since_s < options_.still_s) return CaptureState::Still;
  if (!is_new(view)) return CaptureState::Repeated;
  accept(view);
  return CaptureState::Accepted;
}

// Measured from where the board came to rest, so that it cannot creep away.
bool CaptureGuide::rests(const BoardView& view, double time_s) {
  const auto motion = rest_ ? view_motion_px(rest_->view, view) : std::nullopt;
  if (motion && *motion <= options_.still_share * image_.width && time_s >= rest_->last_s) {
    rest_->last_s = time_s;
    return true;
  }
  rest_ = Rest{view, time_s, time_s};
  return options_.still_s == 0;
}

bool CaptureGuide::is_new(const BoardView& view) const {
  return std::none_of(accepted_.begin(), accepted_.end(), [&](const BoardView& other) {
    const auto motion = view_motion_px(view, other);
    return motion && *motion < options_.distinct_share * image_.width;
  });
}

void CaptureGuide::accept(const BoardView& view) {
  accepted_.push_back(view);
  if (static_cast<int>(accepted_.size()) >= options_.least_views) {
    estimate_ = estimate_camera(options_.lens, image_, shape_, accepted_, options_.coverage);
  }
  if (estimate_) camera_ = estimate_->camera;
  stances_.clear();
  for (std::size_t i = 0; i < accepted_.size(); ++i) {
    stances_.push_back(estimate_ ? stance_of(camera_, shape_, estimate_->T_camera_board[i], least_tilt_rad())
                                 : stance_of_view(accepted_[i]));
  }
  coverage_ = coverage_of(image_, accepted_, stances_, options_.coverage);
  update_wish();
}

void CaptureGuide::update_wish() {
  const std::span<const double> sigmas =
      estimate_ ? std::span<const double>(estimate_->cell_sigma_px) : std::span<const double>();
  // A person meets a wish roughly; what is wished for must be new even then.
  constexpr double kRoughly = 1.5;
  wish_ = next_wish({camera_, shape_, accepted_, coverage_, sigmas, kRoughly * options_.distinct_share * image_.width},
                    options_.coverage);
}

bool CaptureGuide::is_enough() const {
  return estimate_ && estimate_->worst_px < options_.enough_px &&
         is_complete(shares_of(coverage_, options_.coverage), options_.coverage);
}

std::optional<BoardStance> CaptureGuide::stance_of_view(const BoardView& view) const {
  const auto T_camera_board = place_board(camera_, shape_, {}, view.corners);
  return T_camera_board ? stance_of(camera_, shape_, *T_camera_board, least_tilt_rad()) : std::nullopt;
}

double CaptureGuide::least_tilt_rad() const {
  return options_.coverage.least_tilt_deg * std::numbers::pi / 180;
}

}  // namespace alidade
