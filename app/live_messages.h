// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/body_files.h"
#include "app/targets/cue_file.h"
#include "capture/frame_source.h"
#include "io/target_file.h"
#include "marker1d/body_tracker.h"
#include "tracking/frame.h"

namespace alidade {

/// The messages of --stream, version 1: one JSON object per line, told apart by "type". A reader passes over types and
/// entries that it does not know; what is known keeps its meaning while "version" is 1.
///
/// "hello", the first line of every connection (over UDP: once a second): "schema" ("alidade.live"), "version",
///   "program", "verb", "source", "clock" (of t_ns), "sent_clock" (of sent_ns), "pose" (the name of the poses' entry:
///   "T_world_camera", which maps points of the camera into the world, "T_world_body", or "p_world_m"),
///   "unit_of_length" ("m", or "free": one camera alone does not know it), "covariance" (of what, in words), and
///   "bodies", where there are any.
/// "pose", one per frame, or per batch of readings and body: "source"; "frame", counted from 0, or "body"; "t_ns", the
///   moment of the estimate (of a live camera mid-exposure); "state" ("tracked"; "predicted": not measured, but within
///   reach of the motion model; "waiting": there is no map yet; "ambiguous": one of several poses; "lost") and "reason"
///   where there is one; unless waiting or lost the pose, {"p_m": [x, y, z], "q_wxyz": [w, x, y, z]}; "covariance",
///   where it is known, six rows of six, of xi = (translation, rotation) in m and rad, T * exp(xi): in the axes of the
///   camera or body; "v_world_m_s" and "omega_body_rad_s" of a body; of a camera's frame also "sequence" (the device's
///   count), "dropped_before" (frames lost by the device) and "discarded_before" (frames that came too fast for us);
///   "sent_ns", the host's monotonic clock when it was sent.
/// "target", of flying objects: one per target and time of output: "source", "target" (its identity), "t_ns", "state"
///   ("tentative", "confirmed", "coasting"), "p_world_m", "v_world_m_s", "covariance" of both (six rows of six, world
///   axes), "sightings", "temperature_k" and "temperature_sigma_k" where receivers read it, "sent_ns".
/// "cue", with --cue: where "receiver" can see "target": "told_ns" (when that was known), "t_ns" and "own_t_ns" (when
/// it
///   will look there, by the common clock and its own), "azimuth_rad", "elevation_rad" (in its axes), "covariance" (two
///   rows of two, rad²), "range_m", "sent_ns".
/// "lost": "count" messages before the next one were not read in time.
/// "end", the last line: "frames" (or batches), "tracked", "interrupted", "sent_ns".
///
/// Numbers that are not finite are null.
inline constexpr int kLiveVersion = 1;

/// What a reader has to know beforehand.
struct LiveHello {
  std::string verb;
  std::string source;
  std::string clock;                  ///< what t_ns counts from, in words
  std::string pose;                   ///< "T_world_camera", "T_world_body", "p_world_m"
  bool is_metric = true;              ///< the unit of length is the metre
  std::vector<std::string> bodies{};  ///< their names
};

nlohmann::ordered_json hello_message(const LiveHello& hello);

/// A frame of a camera.
nlohmann::ordered_json pose_message(const std::string& source, const FrameReport& report, const CaptureStamp& stamp);

/// A batch of a body's readings.
nlohmann::ordered_json pose_message(const std::string& source, const std::string& body, const BodyEstimate& estimate,
                                    PoseDetail detail);

/// A target at one time.
nlohmann::ordered_json target_message(const std::string& source, const TargetRow& target);

nlohmann::ordered_json cue_message(const AddressedCue& cue);

/// How a run ended.
struct LiveEnd {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;
  bool interrupted = false;
};

nlohmann::ordered_json end_message(const LiveEnd& end);

}  // namespace alidade
