// SPDX-License-Identifier: Apache-2.0
#include "tracking/anchor_follower.h"

#include <algorithm>
#include <utility>

#include "tracking/localiser.h"

namespace alidade {
namespace {

// Few of many points will be followed: from where the pose that all of them gave says that each is, so that no noise of
// its own goes along.
TrackAnchor settled(const Camera& camera, TrackAnchor anchor) {
  const Eigen::Isometry3d T_camera_world = anchor.motion.state().T_world_body.inverse();
  for (std::size_t i = 0; i < anchor.tracks.size(); ++i) {
    const auto seen = project(camera, T_camera_world * anchor.points[i].p_world);
    if (seen) anchor.tracks[i].pixel = seen->pixel;
  }
  return anchor;
}

// Every n-th keeps the spread over the image.
TrackAnchor thinned(TrackAnchor anchor, int most) {
  const std::size_t count = anchor.tracks.size();
  if (count <= static_cast<std::size_t>(most)) return anchor;
  TrackAnchor thin = anchor;
  thin.points.clear();
  thin.tracks.clear();
  const double stride = static_cast<double>(count) / most;
  for (int i = 0; i < most; ++i) {
    const auto k = static_cast<std::size_t>(i * stride);
    thin.points.push_back(anchor.points[k]);
    thin.tracks.push_back(anchor.tracks[k]);
  }
  return thin;
}

}  // namespace

AnchorFollower::AnchorFollower(Camera camera, CameraTrackerOptions options)
    : camera_(camera), options_((validate(options), std::move(options))) {}

void AnchorFollower::put(TrackAnchor anchor) {
  newer_ = settled(camera_, thinned(std::move(anchor), options_.most_tracks));
}

FrameReport AnchorFollower::step(const ImageFrame& frame, const std::string& reason) {
  FrameReport report;
  report.index = frame.index;
  report.time = frame.time;
  report.name = frame.name;
  report.reason = reason;
  remember(frame);
  const bool is_lost = !last_ || missed_ > 0;
  if (newer_ && is_lost) {
    if (!chaser_ || newer_->time > chaser_->time) chaser_ = std::move(newer_);
    newer_.reset();
  }
  if (chaser_) chase();
  if (!last_) return report;
  const FlowImage flow = make_flow_image(frame.grey, options_.flow);
  for (std::optional<TrackAnchor>* from : {&newer_, &last_}) {
    const bool is_too_old = from == &last_ && missed_ > options_.most_predicted;
    if (!*from || is_too_old) continue;
    const MotionState predicted = (*from)->motion.predicted(frame.time);
    const auto attempt = follow(**from, predicted, flow);
    if (!attempt) continue;
    if (from == &newer_) last_ = std::move(*newer_);
    newer_.reset();
    return accept(std::move(report), predicted, *attempt, flow);
  }
  newer_.reset();
  return pass(std::move(report));
}

void AnchorFollower::remember(const ImageFrame& frame) {
  constexpr std::size_t kMostFrames = 150;  // 5 s: as long as finding a place in a large map takes on a busy machine
  constexpr std::size_t kMostBytes = 100'000'000;
  recent_.push_back(frame);
  const std::size_t most = std::min(kMostFrames, 1 + kMostBytes / std::max<std::size_t>(1, frame.grey.total()));
  while (recent_.size() > most) recent_.pop_front();
}

// Leads a late anchor through the frames since, in hops that flow can reach, a few at a time: no frame waits for it.
void AnchorFollower::chase() {
  constexpr int kHops = 3, kFramesPerHop = 3;
  for (int hop = 0; hop < kHops; ++hop) {
    const auto is_later = [this](const ImageFrame& frame) { return frame.time > chaser_->time; };
    const auto first = std::find_if(recent_.begin(), recent_.end(), is_later);
    if (recent_.end() - first <= kFramesPerHop) {
      last_ = std::exchange(chaser_, std::nullopt);
      missed_ = 1;
      return;
    }
    const ImageFrame& frame = first[kFramesPerHop - 1];
    const FlowImage flow = make_flow_image(frame.grey, options_.flow);
    MotionState expected = chaser_->motion.predicted(frame.time);
    auto attempt = follow(*chaser_, expected, flow);
    if (!attempt) {  // after a jump its speed says nothing
      expected.T_world_body = chaser_->motion.state().T_world_body;
      attempt = follow(*chaser_, expected, flow);
    }
    if (!attempt) return chaser_.reset();
    chaser_->motion.follow(frame.time, attempt->update);
    move_on(*chaser_, frame.time, *attempt, flow);
  }
}

// The localiser wants a map: that of the anchor's points alone.
std::optional<AnchorFollower::Attempt> AnchorFollower::follow(const TrackAnchor& from, const MotionState& predicted,
                                                              const FlowImage& flow) const {
  const PointMap map{from.points, {}};
  std::vector<FoundPoint> tracks = from.tracks;
  for (std::size_t i = 0; i < tracks.size(); ++i) tracks[i].point = static_cast<int>(i);
  const std::vector<int> nothing_to_search;
  const Localiser localiser(camera_, map, nothing_to_search, options_, from.sigma_px, false);
  Localisation found = localiser.follow({from.image, from.motion.state().T_world_body, tracks}, predicted, flow);
  if (!localiser.is_believable(found)) return std::nullopt;
  return Attempt{std::move(found.found), std::move(*found.update)};
}

FrameReport AnchorFollower::accept(FrameReport report, const MotionState& predicted, const Attempt& attempt,
                                   const FlowImage& flow) {
  TrackAnchor& now = *last_;
  const PoseUpdate& update = attempt.update;
  now.motion.follow(report.time, update);
  report.state = FrameState::Tracked;
  report.reason.clear();
  const MotionState& state = options_.pose == PoseMethod::Ekf ? now.motion.estimate() : now.motion.state();
  report.T_world_camera = state.T_world_body;
  report.covariance = state.covariance.topLeftCorner<6, 6>();
  report.likelihood = update.sightings;
  report.chi2_per_dof = update.chi2_per_dof;
  report.inlier_count = update.inlier_count;
  report.sigma_px = now.sigma_px;

  const PoseBelief belief{predicted.T_world_body, predicted.covariance.topLeftCorner<6, 6>()};
  for (std::size_t i = 0; i < attempt.found.size(); ++i) {
    const auto k = static_cast<std::size_t>(attempt.found[i].point);
    const FoundPoint track{now.tracks[k].point, -1, attempt.found[i].pixel};
    report.sightings.push_back({track.point, track.pixel, update.is_inlier[i]});
    const auto expected = expect(camera_, belief, now.points[k], now.sigma_px);
    report.expectations.push_back(expected ? FrameExpectation{expected->pixel, expected->S}
                                           : FrameExpectation{track.pixel, {}});
  }
  move_on(now, report.time, attempt, flow);
  missed_ = 0;
  chaser_.reset();
  return report;
}

// What was found there is what is followed from there.
void AnchorFollower::move_on(TrackAnchor& anchor, Timestamp time, const Attempt& attempt, const FlowImage& flow) {
  std::vector<MapPoint> points;
  std::vector<FoundPoint> tracks;
  for (std::size_t i = 0; i < attempt.found.size(); ++i) {
    if (!attempt.update.is_inlier[i]) continue;
    const auto k = static_cast<std::size_t>(attempt.found[i].point);
    points.push_back(anchor.points[k]);
    tracks.push_back({anchor.tracks[k].point, -1, attempt.found[i].pixel});
  }
  anchor.time = time;
  anchor.image = flow;
  anchor.points = std::move(points);
  anchor.tracks = std::move(tracks);
}

// The last image stays what flow starts from; soon an anchor takes its place.
FrameReport AnchorFollower::pass(FrameReport report) {
  ++missed_;
  report.reason = "too few map points followed (blur, darkness, or a part of the scene that the map lacks)";
  const MotionState predicted = last_->motion.predicted(report.time);
  report.state = missed_ <= options_.most_predicted ? FrameState::Predicted : FrameState::Lost;
  if (report.state == FrameState::Lost) return report;
  report.T_world_camera = predicted.T_world_body;
  report.covariance = predicted.covariance.topLeftCorner<6, 6>();
  return report;
}

}  // namespace alidade
