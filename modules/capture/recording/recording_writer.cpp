// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recording_writer.h"

#include <stdexcept>

#include <fmt/format.h>
#include <sys/statvfs.h>

#include "capture/recording/codec_choice.h"
#include "capture/recording/device_offset.h"
#include "capture/recording/event_row.h"
#include "capture/recording/pixel_checksum.h"
#include "capture/recording/recording_names.h"
#include "io/atomic_file.h"
#include "io/lossless_encoder.h"
#include "io/matroska_writer.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

void check_folder(const fs::path& folder) {
  for (const char* name : {kSessionName, kFramesName, kEventsName, kVideoName}) {
    for (const fs::path& path : {folder / name, part_name(folder / name)}) {
      if (fs::exists(path)) throw InputError(folder, 0, "holds a recording already", "choose another folder");
    }
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw DeviceError(folder, "cannot be created", error.message(), "choose a folder that you may write to");
}

void check_camera(const CameraFacts& camera) {
  try {
    validate(LosslessFormat{layout_of(camera.format), camera.size, LosslessCodec::Raw});
  } catch (const std::invalid_argument&) {
    throw DeviceError(camera.source, "recording",
                      fmt::format("{} images of {}x{} px cannot be kept", name_of(camera.format), camera.size.width,
                                  camera.size.height),
                      "ask the camera for another size");
  }
}

// Takes room on the disk that session.json can be written in at the end.
void take_reserve(const fs::path& folder) {
  constexpr std::size_t kReserve = 64 << 10;
  AppendFile(folder / kReserveName).append({std::string(kReserve, '\0')});
}

RecordedFile facts_of(const char* name, const Crc32& crc) {
  return {name, crc.length(), crc.value()};
}

// A file of lines, and its checksum.
class LineFile {
 public:
  LineFile(const fs::path& path, const std::string& header) : file_(path) { append(header); }

  void append(const std::string& line) {
    file_.append({line});
    crc_.add(line);
  }
  void close() { file_.commit(); }

  AppendFile& file() { return file_; }
  std::int64_t size() const { return file_.size(); }
  const Crc32& checksum() const { return crc_; }

 private:
  AppendFile file_;
  Crc32 crc_;
};

}  // namespace

struct RecordingWriter::State {
  fs::path folder;
  RecordingSession session;
  LineFile frames, events;
  LosslessEncoder encoder;
  std::optional<MatroskaWriter> video;  // from the first image on, at which its time is 0
  DeviceOffset offset;
  HostTime last_writeback = HostClock::now();
  bool is_open = true;

  State(fs::path where, RecordingSession what)
      : folder(std::move(where)),
        session(std::move(what)),
        frames(folder / kFramesName, frame_row_header()),
        events(folder / kEventsName, event_row_header()),
        encoder(session.format()) {}

  void write(const Frame& frame);
  void write_image(const Frame& frame, FrameRow& row);
  void check(const Frame& frame) const;
  void check_room(std::int64_t bytes) const;
  DiskFull disk_full(const std::string& limit) const;
  void write_back();
  std::int64_t bytes() const { return frames.size() + events.size() + (video ? video->size() : 0); }
  void close();
  [[noreturn]] void stop(const std::string& limit);

  // Does what writes, and closes the recording where there is no room for it.
  template <class Work>
  void guarded(Work work) {
    if (!is_open) throw std::invalid_argument("RecordingWriter: written to after its end");
    try {
      work();
    } catch (const DiskFull& full) {
      stop(full.limit());
    }
  }
};

void RecordingWriter::State::check(const Frame& frame) const {
  const CameraFacts& camera = session.camera;
  const bool fits =
      frame.image.empty() || camera.format.kind == PixelKind::Jpeg ||
      (frame.image.size() == mat_size(camera.format, camera.size) && frame.image.type() == mat_type(camera.format));
  if (fits && frame.format == camera.format) return;
  throw DeviceError(
      camera.source, "recording",
      fmt::format("frame {} is {} of {}x{}, not {} for {}x{} px", frame.index, name_of(frame.format), frame.image.cols,
                  frame.image.rows, name_of(camera.format), camera.size.width, camera.size.height),
      "start a new recording");
}

void RecordingWriter::State::check_room(std::int64_t wanted) const {
  if (session.options.max_bytes && bytes() + wanted > *session.options.max_bytes) {
    throw disk_full(fmt::format("max_bytes = {} reached", *session.options.max_bytes));
  }
  if (session.options.keep_free_bytes == 0) return;
  struct statvfs disk {};
  if (::statvfs(folder.c_str(), &disk) != 0) return;  // the writing will tell
  const auto left = static_cast<std::int64_t>(disk.f_bavail * disk.f_frsize);
  if (left - wanted < session.options.keep_free_bytes) {
    throw disk_full(fmt::format("disk full but for the {} bytes to keep free", session.options.keep_free_bytes));
  }
}

DiskFull RecordingWriter::State::disk_full(const std::string& limit) const {
  const std::string safe = fmt::format("{} frames are safe in {}", session.totals.frames, folder.string());
  return {folder, "recording", limit, safe, limit};
}

void RecordingWriter::State::write_image(const Frame& frame, FrameRow& row) {
  if (!video) {
    session.video_start = frame.time;
    video.emplace(folder / kVideoName, encoder.track(session.camera.period));
  }
  const std::string_view packet = encoder.encode(frame.image);
  check_room(static_cast<std::int64_t>(packet.size()));
  const MatroskaPacket written = video->write(frame.time - *session.video_start, packet);
  row.position = written.position;
  row.size = written.size;
  row.pixels_crc32 = pixels_crc32(frame.image);
}

void RecordingWriter::State::write(const Frame& frame) {
  check(frame);
  FrameRow row;
  row.index = session.totals.frames;
  row.source_index = frame.index;
  row.time = frame.time;
  row.stamp = frame.stamp;
  if (!frame.image.empty()) write_image(frame, row);
  try {
    frames.append(format_frame_row(row));
  } catch (const DiskFull&) {
    if (row.position) video->take_back();
    throw;
  }
  session.totals.add(row);
  offset.observe(frame.time, frame.stamp, session.camera);
  write_back();
}

void RecordingWriter::State::write_back() {
  const HostTime now = HostClock::now();
  if (now - last_writeback < from_seconds(session.options.writeback_s)) return;
  last_writeback = now;
  if (video) video->start_writeback();  // first, since the rows speak of it
  frames.file().start_writeback();
  events.file().start_writeback();
}

void RecordingWriter::State::close() {
  is_open = false;
  session.files.clear();
  if (video) {
    video->close();
    session.files.push_back(facts_of(kVideoName, video->checksum()));
  }
  frames.close();
  events.close();
  session.files.push_back(facts_of(kFramesName, frames.checksum()));
  session.files.push_back(facts_of(kEventsName, events.checksum()));
  session.offset_at_start = offset.at_start();
  session.offset_at_end = offset.at_end();
  session.end = read_clocks();
  session.is_closed = true;
  fs::remove(part_name(folder / kReserveName));
  write_session(folder, session);  // last: it says that all is done
}

void RecordingWriter::State::stop(const std::string& limit) {
  try {
    if (is_open) close();
  } catch (const DeviceError&) {  // of a disk so full that it cannot be closed: the .part files tell all the same
    session.is_closed = false;
  }
  throw disk_full(limit);
}

RecordingWriter::RecordingWriter(fs::path folder, RecordingSubject subject, const RecorderOptions& options) {
  validate(options);
  check_camera(subject.camera);
  check_folder(folder);
  RecordingSession session;
  session.program = std::move(subject.program);
  session.camera = std::move(subject.camera);
  session.request = std::move(subject.request);
  session.options = options;
  const auto period = session.camera.period.value_or(from_seconds(1 / options.assumed_fps_hz));
  session.codec = choose_codec(layout_of(session.camera.format), session.camera.size, period, options);
  session.start = read_clocks();
  take_reserve(folder);
  state_ = std::make_unique<State>(std::move(folder), std::move(session));
  write_session(state_->folder, state_->session);  // last: where it is, the others are
}
RecordingWriter::~RecordingWriter() = default;
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;

void RecordingWriter::write(const Frame& frame) {
  state_->guarded([&] { state_->write(frame); });
}

void RecordingWriter::note(const CaptureEvent& event) {
  state_->guarded([&] {
    state_->events.append(format_event_row(event));
    ++state_->session.events;
  });
}

void RecordingWriter::close(const std::vector<std::pair<std::string, std::uint64_t>>& statistics) {
  State& s = *state_;
  if (!s.is_open) return;
  s.session.statistics = statistics;
  s.guarded([&s] { s.close(); });
}

bool RecordingWriter::is_open() const {
  return state_->is_open;
}

const RecordingSession& RecordingWriter::session() const {
  return state_->session;
}

std::int64_t RecordingWriter::bytes() const {
  return state_->bytes();
}

}  // namespace alidade
