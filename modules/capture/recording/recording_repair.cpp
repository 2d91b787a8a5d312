// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recording_repair.h"

#include <algorithm>
#include <vector>

#include "capture/recording/device_offset.h"
#include "capture/recording/event_row.h"
#include "capture/recording/pixel_checksum.h"
#include "capture/recording/recorded_frames.h"
#include "capture/recording/recording_names.h"
#include "core/errors.h"
#include "io/append_file.h"
#include "io/atomic_file.h"
#include "io/checksum.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

// A row, where it ends in frames.csv, and the packet of its frame if it has one.
struct KeptRow {
  FrameRow row;
  std::int64_t end = 0;
  std::optional<MatroskaPacket> packet;
};

class Repair {
 public:
  Repair(const fs::path& folder, const ProgressSink& progress)
      : folder_(folder), progress_(progress), session_(read_session(folder)) {}

  RecordingRepair run() {
    if (session_.is_closed) {
      result_.was_closed = true;
      result_.totals = session_.totals;
      return result_;
    }
    for (const char* name : {kFramesName, kEventsName, kVideoName}) take_name_back(name);
    AppendFile rows(folder_ / kFramesName, AppendFile::Start::AtEnd);  // so that nobody else writes meanwhile
    if (fs::exists(part_name(folder_ / kVideoName))) open_video();
    read_rows();
    check_video();
    give_up_lost_rows();
    close_video();
    close_rows(rows);
    close_events();
    close_session();
    return result_;
  }

 private:
  // A file that was closed already before all were.
  void take_name_back(const char* name) const {
    const fs::path path = folder_ / name, part = part_name(path);
    if (fs::exists(path) && !fs::exists(part)) fs::rename(path, part);
  }

  // A power cut may leave a video that does not even begin as one.
  void open_video() {
    try {
      video_.emplace(folder_, session_);
    } catch (const InputError&) {  // nothing in it can be read; see check_video
    }
  }

  // Rows are not given up because their video was put elsewhere, or its first bytes were damaged: this throws.
  void check_video() {
    const auto has_frame = [](const KeptRow& kept) { return kept.row.position.has_value(); };
    if (!video_ && std::any_of(rows_.begin(), rows_.end(), has_frame)) video_.emplace(folder_, session_);
  }

  void read_rows() {
    FrameRows rows(folder_);
    rows_end_ = rows.end();
    try {
      while (const auto row = rows.next()) {
        if (row->index != static_cast<std::int64_t>(rows_.size())) break;
        KeptRow kept{*row, rows.end(), std::nullopt};
        if (row->position && video_) kept.packet = video_->packet_at(*row->position - kMatroskaClusterHead);
        rows_.push_back(std::move(kept));
      }
    } catch (const InputError&) {  // from here on the file was never written: a power cut leaves such
    }
  }

  bool is_there(const KeptRow& kept) {
    if (!kept.row.position) return true;  // without an image there is nothing to lose
    if (!video_) return false;
    if (kept.packet && kept.packet->size == kept.row.size) return true;
    const auto image = video_->read(*kept.row.position, kept.row.size);  // only its head may be damaged
    return image && pixels_crc32(*image) == kept.row.pixels_crc32;
  }

  // The last rows may speak of frames that the disk never got.
  void give_up_lost_rows() {
    std::size_t keep = rows_.size();
    while (keep > 0 && !is_there(rows_[keep - 1])) --keep;
    result_.lost = static_cast<int>(rows_.size() - keep);
    rows_.resize(keep);
  }

  void find_video_start() {
    session_.video_start = Timestamp(session_.start.host.time_since_epoch());  // near it, for want of a row
    for (const KeptRow& kept : rows_) {
      if (!kept.packet) continue;
      session_.video_start = kept.row.time - kept.packet->time;
      return;
    }
  }

  // The frames that follow the last one with a row, as long as they can be read.
  std::vector<KeptRow> find_frames_without_row(std::int64_t begin) {
    std::vector<KeptRow> found;
    for (auto packet = video_->packet_at(begin); packet; packet = video_->packet_at(packet->position + packet->size)) {
      const auto image = video_->read(packet->position, packet->size);
      if (!image) break;
      FrameRow row;
      const KeptRow* const last = !found.empty() ? &found.back() : rows_.empty() ? nullptr : &rows_.back();
      row.index = last ? last->row.index + 1 : 0;
      row.source_index = last ? last->row.source_index + 1 : 0;
      row.time = *session_.video_start + packet->time;
      row.is_recovered = true;
      row.position = packet->position;
      row.size = packet->size;
      row.pixels_crc32 = pixels_crc32(*image);
      found.push_back({row, 0, packet});
    }
    return found;
  }

  void close_video() {
    if (!video_) {
      std::error_code ignored;
      fs::remove(part_name(folder_ / kVideoName), ignored);
      return;
    }
    find_video_start();
    auto begin = static_cast<std::int64_t>(video_->header().bytes.size());
    for (const KeptRow& kept : rows_) begin = std::max(begin, kept.row.packet_end());
    const std::vector<KeptRow> found = find_frames_without_row(begin);
    recovered_begin_ = rows_.size();
    result_.recovered = static_cast<int>(found.size());
    rows_.insert(rows_.end(), found.begin(), found.end());
    std::vector<MatroskaPacket> packets;
    for (const KeptRow& kept : rows_) {
      if (kept.packet) packets.push_back(*kept.packet);
    }
    const std::int64_t end = found.empty() ? begin : found.back().row.packet_end();
    result_.cut_bytes += video_->size() - end;
    MatroskaWriter writer(folder_ / kVideoName, video_->header(), packets, end);
    video_.reset();
    writer.close();
  }

  void close_rows(AppendFile& file) {
    const std::size_t confirmed = recovered_begin_.value_or(rows_.size());
    const std::int64_t end = confirmed > 0 ? rows_[confirmed - 1].end : rows_end_;
    result_.cut_bytes += file.size() - end;
    file.cut(end);
    if (end == 0) file.append({frame_row_header()});
    for (std::size_t i = confirmed; i < rows_.size(); ++i) file.append({format_frame_row(rows_[i].row)});
    file.commit();
  }

  void close_events() {
    const EventRows events = read_event_rows(folder_);
    AppendFile file(folder_ / kEventsName, AppendFile::Start::AtEnd);
    result_.cut_bytes += file.size() - events.end;
    file.cut(events.end);
    if (events.end == 0) file.append({event_row_header()});
    file.commit();
    session_.events = events.count;
  }

  void close_session() {
    DeviceOffset offset;
    session_.totals = {};
    for (const KeptRow& kept : rows_) {
      session_.totals.add(kept.row);
      offset.observe(kept.row.time, kept.row.stamp, session_.camera);
    }
    session_.offset_at_start = offset.at_start();
    session_.offset_at_end = offset.at_end();
    session_.files.clear();
    for (const char* name : {kVideoName, kFramesName, kEventsName}) {
      if (!fs::exists(folder_ / name)) continue;
      if (progress_) progress_({"checksums", 0, 0, ""});
      const Crc32 crc = crc32_of_file(folder_ / name);
      session_.files.push_back({name, crc.length(), crc.value()});
    }
    session_.is_closed = session_.is_repaired = true;
    std::error_code ignored;
    fs::remove(part_name(folder_ / kReserveName), ignored);
    write_session(folder_, session_);
    result_.totals = session_.totals;
  }

  fs::path folder_;
  const ProgressSink& progress_;
  RecordingSession session_;
  std::optional<RecordedVideo> video_;
  std::vector<KeptRow> rows_;
  std::int64_t rows_end_ = 0;  // of the header of frames.csv
  std::optional<std::size_t> recovered_begin_;
  RecordingRepair result_;
};

}  // namespace

RecordingRepair repair_recording(const fs::path& folder, const ProgressSink& progress) {
  return Repair(folder, progress).run();
}

}  // namespace alidade
