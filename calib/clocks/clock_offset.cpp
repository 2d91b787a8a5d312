// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

using Outcome = ClockOffsetOutcome;

constexpr std::size_t kFewestPoses = 20;

// An offset with the pose that it lets most moments agree on.
struct Candidate {
  CameraTie tie;
  double agreeing = 0;  // moments
  double share = 0;
};

std::vector<Candidate> candidates_of(const PlacedFilm& first, const PlacedFilm& second,
                                     const ClockOffsetOptions& options) {
  const auto rates_first = turn_rates(first, options.pose_gap_s);
  const auto rates_second = turn_rates(second, options.pose_gap_s);
  std::vector<Candidate> candidates;
  for (const TurnMatch& match : match_turns(rates_first, rates_second, options.matches)) {
    const auto pose = agree_on_pose(first, second, match.offset_s, options.pose_gap_s);
    if (!pose || pose->share < options.least_share) continue;
    candidates.push_back({{match.offset_s, pose->T_first_second}, pose->share * pose->moments, pose->share});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.agreeing > b.agreeing; });
  return candidates;
}

bool is_ambiguous(const std::vector<Candidate>& candidates, const ClockOffsetOptions& options) {
  if (candidates.size() < 2) return false;
  const Candidate &best = candidates[0], &other = candidates[1];
  return other.agreeing > options.other_share * best.agreeing && other.share > options.other_share * best.share;
}

ClockOffset failed(Outcome outcome) {
  ClockOffset result;
  result.outcome = outcome;
  return result;
}

void require(bool holds, const char* field, double value, const char* bound) {
  if (!holds) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

}  // namespace

void validate(const ClockOffsetOptions& o) {
  require(o.pose_step_s > 0, "pose_step_s", o.pose_step_s, "> 0");
  require(o.pose_gap_s > o.pose_step_s, "pose_gap_s", o.pose_gap_s, "> pose_step_s");
  require(o.least_turn_rad > 0, "least_turn_rad", o.least_turn_rad, "> 0");
  require(o.least_share > 0 && o.least_share <= 1, "least_share", o.least_share, "in (0, 1]");
  require(o.other_share > 0 && o.other_share <= 1, "other_share", o.other_share, "in (0, 1]");
  require(o.worst_scale > 0, "worst_scale", o.worst_scale, "> 0");
  require(o.worst_sigma_s > 0, "worst_sigma_s", o.worst_sigma_s, "> 0");
  require(o.matches.step_s > 0, "matches.step_s", o.matches.step_s, "> 0");
  require(o.matches.most > 0, "matches.most", o.matches.most, "> 0");
  require(o.refinement.most_moments > 3, "refinement.most_moments", o.refinement.most_moments, "> 3");
}

ClockOffset find_clock_offset(const FilmedBoard& board, const CameraFilm& first, const CameraFilm& second,
                              const ClockOffsetOptions& options) {
  validate(options);
  const PlacedFilm placed_first = place_film(first, board.shape, board.warp, options.pose_step_s);
  const PlacedFilm placed_second = place_film(second, board.shape, board.warp, options.pose_step_s);
  for (const PlacedFilm* film : {&placed_first, &placed_second}) {
    if (film->time_s.size() < kFewestPoses) return failed(Outcome::TooFewViews);
  }
  for (const PlacedFilm* film : {&placed_first, &placed_second}) {
    if (turn_range_rad(*film) < options.least_turn_rad) return failed(Outcome::HardlyMoves);
  }
  const auto candidates = candidates_of(placed_first, placed_second, options);
  if (candidates.empty()) return failed(Outcome::NoCommonMotion);
  if (is_ambiguous(candidates, options)) return failed(Outcome::Ambiguous);
  const auto refined = refine_tie(board, first, second, candidates.front().tie, options.refinement);
  if (!refined || refined->scale > options.worst_scale) return failed(Outcome::NoCommonMotion);
  ClockOffset result;
  result.offset_s = refined->tie.offset_s;
  result.sigma_s = std::sqrt(refined->covariance(0, 0));
  result.T_first_second = refined->tie.T_first_second;
  result.pose_covariance = refined->covariance.bottomRightCorner<6, 6>();
  result.moments = refined->moments;
  result.rms_px = refined->rms_px;
  if (!refined->converged || result.sigma_s > options.worst_sigma_s) result.outcome = Outcome::Undetermined;
  return result;
}

std::string explain(Outcome outcome) {
  switch (outcome) {
    case Outcome::Found:
      return "";
    case Outcome::TooFewViews:
      return "the board is seen in too few frames; film it for ten seconds and more, wholly in view of both cameras";
    case Outcome::HardlyMoves:
      return "the board hardly turns, so that no moment can be told from another; turn it to and fro about all axes";
    case Outcome::NoCommonMotion:
      return "the films show no common motion of the board; let both run while the board turns in view of both";
    case Outcome::Ambiguous:
      return "the board's motion repeats itself, so that several offsets fit; move it irregularly";
    case Outcome::Undetermined:
      return "the films determine the offset too loosely; move the board faster and longer in view of both";
  }
  return "";
}

}  // namespace alidade
