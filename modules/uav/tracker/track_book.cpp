// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/track_book.h"

#include <algorithm>

#include "uav/tracker/scan_association.h"
#include "uav/tracker/track_start.h"

namespace alidade {
namespace {

void give_up_the_unseen(std::vector<TargetTrack>& tracks, Timestamp time, const TargetTrackerOptions& options) {
  for (TargetTrack& track : tracks) note_misses(track, time, options);
  std::erase_if(tracks, [&](const TargetTrack& track) { return is_gone(track, time, options); });
}

void keep(std::vector<Bearing>& unclaimed, const BearingScan& scan, const std::vector<bool>& is_claimed,
          const TargetTrackerOptions& options) {
  const Timestamp oldest = scan.end() - from_seconds(options.window_periods * options.period_s);
  std::erase_if(unclaimed, [&](const Bearing& bearing) { return bearing.time <= oldest; });
  for (std::size_t j = 0; j < is_claimed.size(); ++j) {
    if (!is_claimed[j]) unclaimed.push_back(scan.bearings[j]);
  }
  std::sort(unclaimed.begin(), unclaimed.end(), comes_before);
}

}  // namespace

TrackBook after_scan(TrackBook book, const BearingScan& scan, const TargetTrackerOptions& options) {
  give_up_the_unseen(book.tracks, scan.begin(), options);
  ScanOutcome outcome = take_scan(std::move(book.tracks), scan, options);
  book.tracks = std::move(outcome.tracks);
  keep(book.unclaimed, scan, outcome.is_claimed, options);
  const bool is_all_claimed =
      std::all_of(outcome.is_claimed.begin(), outcome.is_claimed.end(), [](bool b) { return b; });
  if (is_all_claimed) return book;
  TrackStarts starts = start_tracks(std::move(book.unclaimed), options);
  for (TargetTrack& track : starts.tracks) {
    track.id = book.next_id++;
    book.tracks.push_back(std::move(track));
  }
  book.unclaimed = std::move(starts.unclaimed);
  return book;
}

TargetTrack without_scans(TargetTrack track, Timestamp time, const TargetTrackerOptions& options) {
  note_misses(track, time, options);
  track.state = predict(track.state, time, options.filter.motion);
  return track;
}

}  // namespace alidade
