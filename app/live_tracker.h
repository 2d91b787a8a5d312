// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "tracking/anchor_follower.h"
#include "tracking/camera_tracker.h"

namespace alidade {

/// How the two halves of a live tracker share the machine.
struct LiveTrackerOptions {
  /// At most this share of its time the map's half works: the rest is for the frames and for the camera.
  double map_share = 0.7;
  double least_pause_s = 0.02;  ///< between two frames of the map's half
};

/// Answers for every frame at once: flow carries the last anchor on, while in a thread of its own the tracker takes
/// what frames it can, the newest first and from where flow has led, finds features, lets the map grow and adjusts it,
/// and hands back anchors that enter at the next frame. What is offline one after the other happens side by side, at
/// the price of results that depend on time.
class LiveTracker {
 public:
  /// `tracker` is the thread's alone until finish().
  explicit LiveTracker(CameraTracker& tracker, LiveTrackerOptions options = {});
  ~LiveTracker();
  LiveTracker(const LiveTracker&) = delete;
  LiveTracker& operator=(const LiveTracker&) = delete;

  /// The next frame. An exception of the thread comes out here.
  FrameReport step(const ImageFrame& frame);

  /// Waits for the frame that the thread is at; the tracker is the caller's again.
  void finish();

 private:
  void work(std::stop_token stop);

  CameraTracker& tracker_;
  LiveTrackerOptions options_;
  AnchorFollower follower_;

  std::mutex mutex_;  // for what follows
  std::condition_variable_any changed_;
  std::optional<ImageFrame> newest_;
  std::optional<TrackAnchor> before_;  // the frame before the newest, where flow has followed the map to it
  std::optional<TrackAnchor> anchor_;
  std::string reason_ = "the map is being made";
  bool is_followed_ = false;
  std::exception_ptr error_;
  std::jthread thread_;
};

}  // namespace alidade
