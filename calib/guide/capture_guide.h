// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "calib/guide/capture_estimate.h"
#include "calib/guide/capture_wish.h"

namespace alidade {

struct CaptureGuideOptions {
  LensModel lens = LensModel::Brown;  ///< of the quick calibrations on the way; Fisheye for such a lens
  CoverageOptions coverage;
  double enough_px = 0.2;        ///< uncertainty of a pixel's place, anywhere in the image, that is good enough
  double still_share = 0.0015;   ///< of the image's width: by no more the corners of a still board move...
  double still_s = 0.3;          ///< ... for so long: then nothing is blurred; 0: photographs, each is still
  double distinct_share = 0.05;  ///< of the image's width: by so much the corners of a view differ from all others'
  int least_views = 4;           ///< before the first calibration: three determine most lenses, one more tells errors
};

/// Throws std::invalid_argument naming the field, its value and the bound.
void validate(const CaptureGuideOptions& options);

enum class CaptureState {
  NoBoard,
  Moving,
  Still,     ///< it rests, but not for long enough
  Accepted,  ///< this view is taken
  Repeated,  ///< still, but an accepted view shows nearly the same
};

/// What a front end shows after every frame.
struct GuideStep {
  CaptureState state = CaptureState::NoBoard;
  std::optional<BoardStance> stance;  ///< of the board in this frame; empty without one, or without a pose
  std::optional<CaptureWish> wish;    ///< empty where it is enough, or nothing is left to wish for
  CoverageShares coverage;
  std::optional<CaptureEstimate> estimate;  ///< from the accepted views; empty before they tell
  int accepted = 0;                         ///< views
  bool is_enough = false;                   ///< the coverage is complete and the estimate certain everywhere
};

/// Leads a person through the views of a board that a calibration needs: says of every frame whether the board is
/// still and new, keeps such views, recalibrates, and says which view to take next. Deterministic; copies go on by
/// themselves. Source of the idea to measure while capturing: Peng and Sturm 2019, "Calibration wizard"; here the next
/// view is found from coverage and projection uncertainty instead of a search over poses.
class CaptureGuide {
 public:
  /// Throws std::invalid_argument for impossible boards, extents and options.
  CaptureGuide(const Board& board, const ImageExtent& image, const CaptureGuideOptions& options = {});

  /// For every frame in order, `time_s` by any clock; empty without a board. A clock that goes back starts the wait for
  /// stillness again. Throws std::invalid_argument for corners that the board has not.
  GuideStep see(const std::optional<BoardView>& view, double time_s);

  const std::vector<BoardView>& accepted() const { return accepted_; }

  /// Of the accepted views, by the present estimate; empty for a view without a pose.
  const std::vector<std::optional<BoardStance>>& stances() const { return stances_; }

 private:
  CaptureState judge(const BoardView& view, double time_s);
  bool rests(const BoardView& view, double time_s);
  bool is_new(const BoardView& view) const;
  void accept(const BoardView& view);
  void update_wish();
  bool is_enough() const;
  std::optional<BoardStance> stance_of_view(const BoardView& view) const;
  double least_tilt_rad() const;

  struct Rest {
    BoardView view;
    double since_s = 0, last_s = 0;
  };

  BoardShape shape_;
  ImageExtent image_;
  CaptureGuideOptions options_;
  Camera camera_;  // a guess until there is an estimate
  std::optional<Rest> rest_;
  std::vector<BoardView> accepted_;
  std::vector<std::optional<BoardStance>> stances_;
  CaptureCoverage coverage_;
  std::optional<CaptureEstimate> estimate_;
  std::optional<CaptureWish> wish_;
};

}  // namespace alidade
