// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recording_verification.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "capture/recording/event_row.h"
#include "capture/recording/pixel_checksum.h"
#include "capture/recording/recorded_frames.h"
#include "capture/recording/recording_names.h"
#include "core/errors.h"
#include "io/checksum.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

// Reads a recording from its first row to its last, and notes what is wrong.
class Verification {
 public:
  Verification(const fs::path& folder, const ProgressSink& progress)
      : folder_(folder), progress_(progress), session_(read_session(folder)) {}

  RecordingVerification run() {
    result_.is_closed = session_.is_closed;
    if (!session_.is_closed) note(folder_ / kSessionName, 0, "the recording was not closed");
    guarded([this] { check_events(); });
    guarded([this] {
      if (fs::exists(find_recorded(folder_, kVideoName))) video_.emplace(folder_, session_);
    });
    guarded([this] { check_rows(); });
    if (session_.is_closed) check_totals();
    check_files();
    return std::move(result_);
  }

 private:
  void note(const fs::path& path, int line, std::string what) {
    result_.faults.push_back({path, line, std::move(what)});
  }

  template <class Work>
  void guarded(Work work) {
    try {
      work();
    } catch (const InputError& error) {
      const std::string_view text = error.what();
      const std::size_t place = error.path().size() + (error.line() > 0 ? std::to_string(error.line()).size() + 1 : 0);
      note(error.path(), error.line(), std::string(text.substr(std::min(place + 2, text.size()))));
    }
  }

  void check_events() {
    const EventRows events = read_event_rows(folder_);
    restarts_ = events.restarts;
    if (session_.is_closed && events.count != session_.events) {
      note(events.path, 0, fmt::format("has {} events, session.json says {}", events.count, session_.events));
    }
  }

  void check_rows() {
    FrameRows rows(folder_);
    std::optional<FrameRow> before;
    while (const auto row = rows.next()) {
      const auto fault = [&](std::string what) { note(rows.path(), rows.line(), std::move(what)); };
      if (row->index != result_.totals.frames)
        fault(fmt::format("is frame {}, not {}", row->index, result_.totals.frames));
      if (before) check_order(*before, *row, fault);
      if (row->position) check_image(*row, fault);
      result_.totals.add(*row);
      before = row;
      if (progress_) progress_({"verifying", result_.totals.frames, session_.totals.frames, ""});
    }
    if (rows.has_half_row()) note(rows.path(), rows.line() + 1, "ends in the middle of a row");
    check_end();
  }

  template <class Fault>
  void check_order(const FrameRow& before, const FrameRow& row, const Fault& fault) const {
    if (row.time <= before.time) fault("t_ns does not increase");
    const auto restart = restarts_.upper_bound(before.source_index);
    const bool began_anew = restart != restarts_.end() && *restart <= row.source_index;
    if (!row.stamp.sequence || !before.stamp.sequence || began_anew) return;
    const std::uint64_t lost = row.stamp.dropped_before + row.stamp.discarded_before;
    const std::uint64_t gap = *row.stamp.sequence - *before.stamp.sequence - 1;
    if (gap != lost) {
      fault(fmt::format("sequence goes from {} to {}, but {} frames are said to be lost", *before.stamp.sequence,
                        *row.stamp.sequence, lost));
    }
  }

  template <class Fault>
  void check_image(const FrameRow& row, const Fault& fault) {
    if (!video_) return fault("there is no video for its frame");
    const std::int64_t cluster = *row.position - kMatroskaClusterHead;
    if (next_cluster_ && cluster != *next_cluster_) fault("its frame does not follow the one before in the video");
    next_cluster_ = row.packet_end();
    const auto packet = video_->packet_at(cluster);
    if (!packet || packet->size != row.size) return fault("its frame is not in the video");
    const auto image = video_->read(*row.position, row.size);
    if (!image) return fault("its frame cannot be read");
    if (pixels_crc32(*image) != row.pixels_crc32) fault("the pixels of its frame are not those recorded");
  }

  void check_end() {
    if (!video_) return;
    const auto begin = static_cast<std::int64_t>(video_->header().bytes.size());
    int more = 0;
    for (auto packet = video_->packet_at(next_cluster_.value_or(begin)); packet;
         packet = video_->packet_at(packet->position + packet->size)) {
      ++more;
    }
    if (more > 0) note(video_->path(), 0, fmt::format("holds {} frames without a row", more));
  }

  void check_totals() {
    const RecordingTotals &found = result_.totals, &said = session_.totals;
    const auto compare = [this](const char* what, auto is, auto says) {
      if (is != says) note(folder_ / kSessionName, 0, fmt::format("says {} {}, the rows {}", says, what, is));
    };
    compare("frames", found.frames, said.frames);
    compare("frames without an image", found.without_image, said.without_image);
    compare("damaged frames", found.damaged, said.damaged);
    compare("recovered frames", found.recovered, said.recovered);
    compare("dropped frames", found.dropped, said.dropped);
    compare("discarded frames", found.discarded, said.discarded);
  }

  void check_files() {
    for (const char* name : {kFramesName, kEventsName, kVideoName}) {
      const fs::path path = find_recorded(folder_, name);
      std::error_code ignored;
      if (fs::exists(path)) result_.bytes += static_cast<std::int64_t>(fs::file_size(path, ignored));
    }
    for (const RecordedFile& file : session_.files) {
      guarded([&] {
        const fs::path path = folder_ / file.name;
        const Crc32 crc = crc32_of_file(path);
        if (crc.length() != file.bytes) {
          note(path, 0, fmt::format("is {} bytes long, not {}", crc.length(), file.bytes));
        } else if (crc.value() != file.crc32) {
          note(path, 0, fmt::format("has checksum {:08x}, not {:08x}", crc.value(), file.crc32));
        }
      });
    }
  }

  fs::path folder_;
  const ProgressSink& progress_;
  RecordingSession session_;
  std::optional<RecordedVideo> video_;
  std::set<std::int64_t> restarts_;  // EventRows::restarts
  std::optional<std::int64_t> next_cluster_;
  RecordingVerification result_;
};

}  // namespace

RecordingVerification verify_recording(const fs::path& folder, const ProgressSink& progress) {
  return Verification(folder, progress).run();
}

}  // namespace alidade
