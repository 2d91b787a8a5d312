// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/clock_refinement.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "calib/bundle/board_placement.h"

namespace alidade {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Matrix67d = Eigen::Matrix<double, 6, 7>;
using Motions = std::vector<CornerMotion>;

constexpr int kOffset = 6;  // its place behind the second camera's pose
constexpr std::size_t kFewestMoments = 4;

BundleFreedom tie_freedom() {
  BundleFreedom freedom;
  freedom.warp = false;
  return freedom;
}

// A moment of the first film, seen by both cameras.
struct SharedMoment {
  BundleView first, second;
  Motions motion;  // of the second one's corners
};

BundleView weighted_view(int camera, int frame, std::vector<BoardCorner> corners) {
  const std::size_t count = corners.size();
  return {camera, frame, std::move(corners), std::vector<double>(count, 1.0)};
}

// The board's places are found once: each keeps its number though the offset changes.
struct Joint {
  const FilmedBoard& board;
  const CameraFilm& first;
  const CameraFilm& second;
  std::vector<std::size_t> chosen;  // views of the first film
  BoardBundle bundle;               // a frame for each of them
  double offset_s = 0;
  std::vector<BundleView> weights{};  // as a fit left them; empty: all 1

  std::vector<SharedMoment> moments() const;
};

// Weights go with a corner of a camera and frame.
void take_weights(const std::vector<BundleView>& from, BundleView& view) {
  const auto same = std::find_if(from.begin(), from.end(), [&](const BundleView& other) {
    return other.camera == view.camera && other.frame == view.frame;
  });
  if (same == from.end()) return;
  for (std::size_t i = 0; i < view.corners.size(); ++i) {
    const auto corner = std::find_if(same->corners.begin(), same->corners.end(),
                                     [&](const BoardCorner& c) { return c.id == view.corners[i].id; });
    if (corner == same->corners.end()) continue;
    view.weights[i] = same->weights[static_cast<std::size_t>(corner - same->corners.begin())];
  }
}

std::vector<SharedMoment> Joint::moments() const {
  std::vector<SharedMoment> moments;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const BoardView& view = first.film.views()[chosen[i]];
    auto other = second.film.at(view.time_s - offset_s);
    if (!other) continue;
    const int frame = static_cast<int>(i);
    SharedMoment moment{weighted_view(0, frame, view.corners), weighted_view(1, frame, std::move(other->view.corners)),
                        std::move(other->motion)};
    take_weights(weights, moment.first);
    take_weights(weights, moment.second);
    moments.push_back(std::move(moment));
  }
  return moments;
}

std::vector<BundleView> views_of(const std::vector<SharedMoment>& moments) {
  std::vector<BundleView> views;
  for (const SharedMoment& moment : moments) {
    views.push_back(moment.first);
    views.push_back(moment.second);
  }
  return views;
}

// Moments whose views of the second film are not shared, at most so many.
std::vector<std::size_t> choose_moments(const CameraFilm& first, const CameraFilm& second, double offset_s, int most) {
  std::vector<std::size_t> chosen;
  int free = 0;
  for (std::size_t i = 0; i < first.film.views().size(); ++i) {
    const auto moment = second.film.at(first.film.views()[i].time_s - offset_s);
    if (!moment || moment->first < free) continue;
    chosen.push_back(i);
    free = moment->first + 4;
  }
  if (chosen.size() <= static_cast<std::size_t>(most)) return chosen;
  std::vector<std::size_t> thinned;
  for (int i = 0; i < most; ++i) {
    thinned.push_back(chosen[static_cast<std::size_t>(i) * chosen.size() / static_cast<std::size_t>(most)]);
  }
  return thinned;
}

// Moments at which the board cannot be placed in the first camera's view are dropped.
Joint join(const FilmedBoard& board, const CameraFilm& first, const CameraFilm& second, const CameraTie& start,
           int most_moments) {
  Joint joint{board,
              first,
              second,
              {},
              {{{first.camera, Eigen::Isometry3d::Identity()}, {second.camera, start.T_first_second}}, {}, board.warp},
              start.offset_s};
  for (const std::size_t i : choose_moments(first, second, start.offset_s, most_moments)) {
    const auto T_rig_board = place_board(first.camera, board.shape, board.warp, first.film.views()[i].corners);
    if (!T_rig_board) continue;
    joint.chosen.push_back(i);
    joint.bundle.T_rig_board.push_back(*T_rig_board);
  }
  return joint;
}

// The normal equations for the second camera's pose and the offset, the boards eliminated.
struct TieEquations {
  Matrix7d H = Matrix7d::Zero();
  Vector7d g = Vector7d::Zero();
  double cost = 0;
  int coordinates = 0, frames = 0;
  std::vector<Vector7d> scores;  // each moment's part of g
};

// Views that would leave the velocities as residuals: their gradient is the offset's column of the normal equations,
// as a residual (found minus seen) grows by the velocity per second of offset.
BundleView velocity_view(const BoardBundle& bundle, const BoardShape& shape, BundleView view, const Motions& motion) {
  const auto residuals = residuals_px(bundle, shape, view);
  for (std::size_t i = 0; i < residuals.size(); ++i) view.corners[i].pixel += residuals[i] - motion[i].velocity_px_s;
  return view;
}

// Half the derivative of the weighted squares by the offset, in which the weights 1/sigma² change too: velocities come
// from the same corners as positions, and their common noise would otherwise pull the offset away from frames.
double slope_by_offset(const BoardBundle& bundle, const BoardShape& shape, const BundleView& view,
                       const Motions& motion) {
  const auto residuals = residuals_px(bundle, shape, view);
  double sum = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double variance = view.corners[i].sigma_px * view.corners[i].sigma_px;
    const double by_noise = 0.5 * motion[i].variance_rate_px2_s * residuals[i].squaredNorm() / variance;
    sum += view.weights[i] * (residuals[i].dot(motion[i].velocity_px_s) + by_noise) / variance;
  }
  return sum;
}

void add_moment(const Joint& joint, SharedMoment moment, TieEquations& equations) {
  BoardBundle alone = joint.bundle;
  alone.T_rig_board = {joint.bundle.T_rig_board[static_cast<std::size_t>(moment.first.frame)]};
  moment.first.frame = moment.second.frame = 0;
  const BoardShape& shape = joint.board.shape;
  const std::vector<BundleView> views{moment.first, moment.second};
  const std::vector<BundleView> moving{velocity_view(alone, shape, moment.second, moment.motion)};
  const BundleEquations e = bundle_equations(alone, shape, views, tie_freedom());
  const BundleEquations by_offset = bundle_equations(alone, shape, moving, tie_freedom());
  const Eigen::LLT<Matrix6d> factor(e.H_frame[0]);
  if (factor.info() != Eigen::Success || !(e.H_frame[0].diagonal().minCoeff() > 0)) return;
  Matrix7d H;
  H << e.H, by_offset.g, by_offset.g.transpose(), by_offset.cost;
  Vector7d g;
  g << e.g, slope_by_offset(alone, shape, moment.second, moment.motion);
  Matrix67d B;
  B << e.H_frame_shared[0], by_offset.g_frame[0];
  const Matrix67d X = factor.solve(B);
  equations.H += H - B.transpose() * X;
  equations.scores.emplace_back(g - X.transpose() * e.g_frame[0]);
  equations.g += equations.scores.back();
  equations.cost += e.cost;
  ++equations.frames;
  for (const BundleView& view : views) {
    equations.coordinates += 2 * static_cast<int>(std::count_if(view.weights.begin(), view.weights.end(),
                                                                [](double weight) { return weight > 0; }));
  }
}

TieEquations tie_equations(const Joint& joint, const std::vector<SharedMoment>& moments) {
  TieEquations equations;
  for (const SharedMoment& moment : moments) add_moment(joint, moment, equations);
  return equations;
}

// Scaled to a unit diagonal before it is inverted: seconds and metres differ in size.
std::optional<Matrix7d> inverse(const Matrix7d& H) {
  if (!(H.diagonal().minCoeff() > 0)) return std::nullopt;
  const Vector7d scale = H.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Matrix7d> factor(scale.asDiagonal() * H * scale.asDiagonal());
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Matrix7d solved = factor.solve(Matrix7d::Identity());
  return Matrix7d(scale.asDiagonal() * solved * scale.asDiagonal());
}

// Gauss and Newton's steps of the offset, at each of which the poses are at their best. Whether they came to rest.
// Where a moment passes a frame, other views make it up and the cost has a kink: steps that turn back get shorter.
bool descend(Joint& joint, double most_step_s) {
  constexpr int kMostSteps = 30;
  double last_s = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto moments = joint.moments();
    if (moments.size() < kFewestMoments) return false;
    joint.bundle =
        solve_bundle(std::move(joint.bundle), joint.board.shape, views_of(moments), tie_freedom(), {30}).bundle;
    const TieEquations equations = tie_equations(joint, moments);
    const auto C = inverse(equations.H);
    if (!C) return false;
    const double wanted_s = -(*C * equations.g)[kOffset];
    if (wanted_s * last_s < 0) most_step_s = std::min(most_step_s, 0.5 * std::abs(last_s));
    last_s = std::clamp(wanted_s, -most_step_s, most_step_s);
    joint.offset_s += last_s;
    if (std::abs(last_s) < 0.01 * std::sqrt((*C)(kOffset, kOffset))) return true;
  }
  return false;
}

// From the residuals; where moments scatter more than independent corners would let them (lens, blur, shutter), from
// the jackknife over moments, as bundle_covariance has it.
Matrix7d covariance_of(const TieEquations& equations, const Matrix7d& C) {
  const int parameters = 6 * equations.frames + 7;
  const double variance = equations.cost / std::max(1, equations.coordinates - parameters);
  const Matrix7d independent = variance * C;
  double spread = 0;
  for (const Vector7d& score : equations.scores) spread += std::pow((C * score)[kOffset], 2);
  const double ratio = spread / independent(kOffset, kOffset);
  return ratio > 2.0 ? Matrix7d(ratio * independent) : independent;
}

Matrix7d offset_first(const Matrix7d& C) {
  Eigen::Vector<int, 7> order;
  order << kOffset, 0, 1, 2, 3, 4, 5;
  return C(order, order);
}

}  // namespace

std::optional<RefinedTie> refine_tie(const FilmedBoard& board, const CameraFilm& first, const CameraFilm& second,
                                     const CameraTie& start, const ClockRefinementOptions& options) {
  Joint joint = join(board, first, second, start, options.most_moments);
  if (joint.chosen.size() < kFewestMoments) return std::nullopt;
  // Corners are judged only once the offset is about right: before, the fast ones are those that seem to err.
  RefinedTie refined;
  descend(joint, options.most_step_s);
  BundleFit fit;
  for (int round = 0; round < 2; ++round) {
    fit = fit_bundle(joint.bundle, board.shape, views_of(joint.moments()), tie_freedom(), options.fit);
    joint.bundle = fit.bundle;
    joint.weights = fit.views;
    refined.converged = descend(joint, options.most_step_s);
  }
  const auto moments = joint.moments();
  const TieEquations equations = tie_equations(joint, moments);
  const auto C = inverse(equations.H);
  if (!C || moments.size() < kFewestMoments) return std::nullopt;
  refined.tie = {joint.offset_s, joint.bundle.cameras[1].T_rig_camera};
  refined.covariance = offset_first(covariance_of(equations, *C));
  refined.moments = static_cast<int>(moments.size());
  refined.rms_px = rms_px(joint.bundle, board.shape, views_of(moments));
  refined.scale = fit.scale;
  return refined;
}

}  // namespace alidade
