// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/recorded_flight.h"

#include <algorithm>

#include <fmt/format.h>

#include "calib/receivers/resection.h"
#include "camera/static_triangulation.h"
#include "core/errors.h"
#include "core/find_by_id.h"
#include "evaluation/track_jumps.h"

namespace alidade {
namespace {

constexpr int kLeastReceivers = 3;

// The file's pose and clock, told about the moment at which resection tells its clock's covariance.
Receiver with_covariances(Receiver given, const Receiver& resected) {
  given.pose_covariance = resected.pose_covariance;
  given.clock.offset_s += given.clock.rate * to_seconds(resected.clock.reference - given.clock.reference);
  given.clock.reference = resected.clock.reference;
  given.clock.covariance = resected.clock.covariance;
  return given;
}

std::vector<ReceiverReading> readings_between(const FlightRecording& recording, Timestamp begin, Timestamp end) {
  std::vector<ReceiverReading> some;
  for (const ReceiverReading& reading : recording.readings) {
    const Receiver* receiver = find_by_id(std::span<const Receiver>(recording.receivers), reading.receiver);
    const Timestamp time = common_time(receiver->clock, reading.time);
    if (time > begin && time < end) some.push_back(reading);
  }
  return some;
}

}  // namespace

JudgedFlight judged_flight(const FlightRecording& recording, const std::string& folder) {
  JudgedFlight flight;
  const std::vector<std::size_t> jumps = track_jumps(recording.truth);
  for (std::size_t i = 0; i < recording.truth.size(); ++i) {
    const TimedPosition& p = recording.truth[i];
    if (p.time >= recording.flight_begin && p.time <= recording.used_until) flight.first_half.push_back(p);
    if (p.time <= recording.used_until || p.time >= recording.flight_end) continue;
    flight.epochs.push_back(p);
    flight.is_jump.push_back(std::binary_search(jumps.begin(), jumps.end(), i));
  }
  flight.readings = readings_between(recording, recording.used_until, recording.flight_end);
  const KnownTrack track(flight.first_half);
  for (const Receiver& receiver : recording.receivers) {
    auto readings = readings_between(recording, recording.flight_begin, recording.used_until);
    std::erase_if(readings, [&](const ReceiverReading& r) { return r.receiver != receiver.id; });
    const auto posed = resect_receiver(receiver, readings, track, {.keep_pose = true});
    const auto found = resect_receiver(receiver, readings, track, {.find_focal = true});
    if (!posed || !found) {
      throw InputError(folder, 0, fmt::format("the first half does not tell the pose of receiver {}", receiver.id), "");
    }
    flight.given.push_back(with_covariances(receiver, posed->receiver));
    flight.found.push_back(found->receiver);
    flight.focal_scales.push_back(found->focal_scale);
  }
  return flight;
}

FlightAnswers answers_of(const FlightPath& path, const JudgedFlight& flight) {
  FlightAnswers answers;
  for (const TimedPosition& epoch : flight.epochs) {
    answers.emplace_back();
    const FlightStep* step = step_at(path, epoch.time);
    if (!step || step->seen_by < kLeastReceivers) continue;
    const TargetState state = moved_to(step->state, epoch.time);
    answers.back() = PositionPair{state.p_world, epoch.p, state.covariance.topLeftCorner<3, 3>()};
  }
  return answers;
}

FlightAnswers static_answers(const std::vector<Bearing>& bearings, const JudgedFlight& flight) {
  FlightAnswers answers;
  for (const TimedPosition& epoch : flight.epochs) {
    answers.emplace_back();
    const auto met = triangulate_static(bearings, epoch.time, {.least_receivers = kLeastReceivers});
    if (met) answers.back() = PositionPair{met->p_world, epoch.p, met->covariance_world};
  }
  return answers;
}

FlightAnswers where_both(const FlightAnswers& answers, const FlightAnswers& others) {
  FlightAnswers both = answers;
  for (std::size_t i = 0; i < both.size(); ++i) {
    if (!others[i]) both[i].reset();
  }
  return both;
}

JudgedAnswers judge(const FlightAnswers& answers, const JudgedFlight& flight) {
  std::vector<PositionPair> all, without_jumps;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!answers[i]) continue;
    all.push_back(*answers[i]);
    if (!flight.is_jump[i]) without_jumps.push_back(*answers[i]);
  }
  return {static_cast<double>(all.size()) / static_cast<double>(answers.size()), score_flight(all),
          score_flight(without_jumps)};
}

std::vector<Receiver> with_sure_clocks(std::vector<Receiver> receivers) {
  for (Receiver& receiver : receivers) receiver.clock.covariance.setZero();
  return receivers;
}

}  // namespace alidade
