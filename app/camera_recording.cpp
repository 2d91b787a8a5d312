// SPDX-License-Identifier: Apache-2.0
#include "app/camera_recording.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "app/frame_sources.h"
#include "app/version.h"
#include "capture/frame_queue.h"
#include "capture/live_camera.h"
#include "core/errors.h"

namespace alidade {
namespace {

constexpr double kQueue_bytes = 512e6;  // what a disk that pauses may cost in memory, per camera

std::size_t queue_capacity(const CameraFacts& facts) {
  const double frame_bytes = 3.0 * facts.size.width * facts.size.height;
  return static_cast<std::size_t>(std::clamp(kQueue_bytes / frame_bytes, 8.0, 1024.0));
}

bool is_folder_name(const std::string& name) {
  constexpr auto is_fine = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; };
  return !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), is_fine);
}

NamedCamera parse_named_camera(const std::string& word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos || equals > word.find_first_of(":/")) return {"", word};
  NamedCamera camera{word.substr(0, equals), word.substr(equals + 1)};
  if (is_folder_name(camera.name)) return camera;
  throw InputError(word, 0, fmt::format("'{}' is no name for a folder", camera.name),
                   "use letters, digits, '-' and '_'");
}

}  // namespace

std::vector<NamedCamera> parse_named_cameras(const std::vector<std::string>& words) {
  std::vector<NamedCamera> cameras;
  std::set<std::string> names, sources;
  for (std::size_t i = 0; i < words.size(); ++i) {
    NamedCamera camera = parse_named_camera(words[i]);
    if (camera.name.empty() && words.size() > 1) camera.name = fmt::format("camera_{}", i);
    if (!names.insert(camera.name).second) throw InputError(words[i], 0, "another camera has that name", "");
    if (!sources.insert(camera.source).second) throw InputError(words[i], 0, "is named twice", "");
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

/// Adds up what the device counted over all times that it was open.
class CameraRecording::CountedDevice : public CameraDevice {
 public:
  CountedDevice(std::unique_ptr<CameraDevice> device, std::map<std::string, std::uint64_t>* totals)
      : device_(std::move(device)), totals_(totals) {}
  ~CountedDevice() override {
    for (const auto& [name, count] : device_->statistics()) (*totals_)[name] += count;
  }
  const CameraFacts& facts() const override { return device_->facts(); }
  std::optional<Frame> wait(std::chrono::nanoseconds timeout) override { return device_->wait(timeout); }

 private:
  std::unique_ptr<CameraDevice> device_;
  std::map<std::string, std::uint64_t>* totals_;
};

CameraRecording::CameraRecording(NamedCamera camera, const CameraOptions& options, CaptureEventSink news)
    : camera_(std::move(camera)), request_(request_of(options, camera_.name)), news_(std::move(news)) {
  const auto open = [this, opener = camera_opener(camera_.source, request_)] { return open_as_before(opener); };
  const auto events = [this](const CaptureEvent& event) { take(event); };
  auto live = open_live_camera(camera_.source, open, live_options_of(options), events);
  frames_ = queued(std::move(live), {queue_capacity(*facts_), WhenFull::DropOldest, events});
}

CameraRecording::~CameraRecording() = default;

std::unique_ptr<CameraDevice> CameraRecording::open_as_before(const CameraOpener& open) {
  auto device = open();
  const CameraFacts& facts = device->facts();
  if (!facts_) facts_ = facts;
  if (facts.size != facts_->size || !(facts.format == facts_->format)) {
    throw CameraError(CameraTrouble::Refused, camera_.source, "open again",
                      fmt::format("it now gives {}x{} px {}", facts.size.width, facts.size.height, facts.device_format),
                      "give --camera-size and --camera-pixel-format");
  }
  return std::make_unique<CountedDevice>(std::move(device), &statistics_);
}

// In the threads that capture.
void CameraRecording::take(const CaptureEvent& event) {
  if (news_) news_(event);
  const std::scoped_lock lock(mutex_);
  events_.push_back(event);
  wake_.request_stop();
}

void CameraRecording::start(const std::filesystem::path& folder, const RecorderOptions& options,
                            const RecordingLimits& limits, std::function<void()> on_failure) {
  writer_.emplace(folder, RecordingSubject{std::string("alidade ") + kVersion, *facts_, request_}, options);
  begin_ = HostClock::now();
  thread_ = std::jthread([this, limits, on_failure = std::move(on_failure)](std::stop_token stop) {
    try {
      write_frames(stop, limits);
    } catch (...) {
      error_ = std::current_exception();
      on_failure();
    }
    ended_ = true;
  });
}

// Until the limit, or until it is stopped: then also what the camera gave before.
void CameraRecording::write_frames(std::stop_token stop, RecordingLimits limits) {
  const std::stop_callback wake_up(stop, [this] {
    const std::scoped_lock lock(mutex_);
    wake_.request_stop();
  });
  std::optional<HostTime> stopped;
  for (;;) {
    std::stop_token woken;
    write_events(&woken);
    if (!stopped && stop.stop_requested()) stopped = HostClock::now();
    const auto frame = frames_->next(stopped ? stop : woken);
    if (!frame && !woken.stop_requested()) break;  // the source has ended
    if (!frame && stopped) break;
    if (!frame) continue;
    if (stopped && frame->stamp.host_time > *stopped) break;
    if (is_full(*frame, limits)) break;
    write(*frame);
  }
  write_events(nullptr);
}

void CameraRecording::write_events(std::stop_token* rearmed) {
  std::vector<CaptureEvent> events;
  {
    const std::scoped_lock lock(mutex_);
    events.swap(events_);
    if (rearmed) {
      wake_ = std::stop_source();
      *rearmed = wake_.get_token();
    }
  }
  for (const CaptureEvent& event : events) writer_->note(event);
}

bool CameraRecording::is_full(const Frame& frame, const RecordingLimits& limits) const {
  if (limits.frames && progress_.frames >= *limits.frames) return true;
  return limits.duration_s && frame.stamp.host_time &&
         to_seconds(*frame.stamp.host_time - begin_) >= *limits.duration_s;
}

void CameraRecording::write(const Frame& frame) {
  writer_->write(frame);
  const std::scoped_lock lock(mutex_);
  ++progress_.frames;
  progress_.bytes = writer_->bytes();
  progress_.dropped += frame.stamp.dropped_before;
  progress_.discarded += frame.stamp.discarded_before;
  progress_.damaged += frame.stamp.is_damaged;
}

RecordingProgress CameraRecording::progress() const {
  const std::scoped_lock lock(mutex_);
  return progress_;
}

void CameraRecording::finish() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  frames_.reset();  // ends the capture; its last events and counts come now
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  write_events(nullptr);
  writer_->close({statistics_.begin(), statistics_.end()});
}

}  // namespace alidade
