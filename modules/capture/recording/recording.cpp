// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recording.h"

#include <algorithm>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "capture/recording/pixel_checksum.h"
#include "capture/recording/recorded_frames.h"
#include "capture/recording/recording_names.h"
#include "core/errors.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

std::string name_of_folder(const fs::path& folder) {
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  return absolute.has_filename() ? absolute.filename() : absolute.parent_path().filename();
}

class Recording : public FrameSource {
 public:
  explicit Recording(const fs::path& folder)
      : folder_(folder), name_(name_of_folder(folder)), session_(read_session(folder)), rows_(folder) {
    count_ = count_rows();
  }

  std::optional<Frame> next(std::stop_token) override {
    if (totals_.frames == count_) return std::nullopt;
    const auto row = rows_.next();
    if (!row) throw InputError(rows_.path(), 0, "has become shorter while it was read", "");
    totals_.add(*row);
    Frame frame{static_cast<int>(row->index), row->time, fmt::format("{}#{}", name_, row->index), {},
                session_.camera.format,       row->stamp};
    if (row->position && !read_image(*row, frame)) {
      frame.stamp.is_damaged = true;
      ++unreadable_;
    }
    return frame;
  }

  std::optional<int> frame_count() const override { return static_cast<int>(count_); }
  bool has_times() const override { return true; }

  std::string describe() const override {
    const CameraFacts& camera = session_.camera;
    return fmt::format("recording {} ({}, {}x{} px, {})", folder_.string(), camera.source, camera.size.width,
                       camera.size.height, alidade::name_of(camera.format));
  }

  std::optional<std::string> fault() const override {
    std::vector<std::string> faults;
    if (!session_.is_closed) faults.push_back("was not closed (see 'alidade repair')");
    const auto add = [&faults](auto count, const char* what) {
      if (count > 0) faults.push_back(fmt::format("{} frame{} {}", count, count == 1 ? "" : "s", what));
    };
    add(totals_.dropped, "dropped by the camera");
    add(totals_.discarded, "discarded since recording was too slow");
    add(unreadable_, "no longer as recorded");
    if (faults.empty() || totals_.frames < count_) return std::nullopt;
    return fmt::format("{}: {}", folder_.string(), fmt::join(faults, ", "));
  }

 private:
  std::int64_t count_rows() const {
    std::ifstream file(rows_.path(), std::ios::binary);
    const auto lines = std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n');
    return std::max<std::int64_t>(0, lines - 1);
  }

  bool read_image(const FrameRow& row, Frame& frame) {
    if (!video_) video_.emplace(folder_, session_);
    const auto image = video_->read(*row.position, row.size);
    if (image) frame.image = *image;
    return image && pixels_crc32(*image) == row.pixels_crc32;
  }

  fs::path folder_;
  std::string name_;
  RecordingSession session_;
  FrameRows rows_;
  std::optional<RecordedVideo> video_;
  std::int64_t count_ = 0;  // rows, when it was opened
  RecordingTotals totals_;
  int unreadable_ = 0;
};

}  // namespace

bool is_recording(const fs::path& folder) {
  std::ifstream file(folder / kSessionName);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return text.find(fmt::format("\"{}\"", kRecordingFormat)) != std::string::npos;
}

std::unique_ptr<FrameSource> open_recording(const fs::path& folder) {
  return std::make_unique<Recording>(folder);
}

}  // namespace alidade
