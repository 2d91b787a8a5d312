// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recorded_frames.h"

#include <algorithm>

#include "capture/recording/recording_names.h"
#include "core/errors.h"

namespace alidade {
namespace {

constexpr std::int64_t kLongestHeader = 1 << 16;  // bytes

}  // namespace

FrameRows::FrameRows(const std::filesystem::path& folder)
    : path_(find_recorded(folder, kFramesName)), file_(path_, std::ios::binary) {
  if (!file_) throw InputError(path_, 0, "cannot be read", "it belongs to every recording");
  const auto header = next_line();
  if (header && *header + "\n" != frame_row_header()) {
    throw InputError(path_, 1, "is not the header of a recording's frames", "take it from a copy of the recording");
  }
}

std::optional<std::string> FrameRows::next_line() {
  std::string text;
  if (!std::getline(file_, text)) return std::nullopt;
  if (file_.eof()) {  // no line break came
    half_row_ = !text.empty();
    return std::nullopt;
  }
  ++line_;
  end_ += static_cast<std::int64_t>(text.size()) + 1;
  return text;
}

std::optional<FrameRow> FrameRows::next() {
  const auto text = next_line();
  if (!text) return std::nullopt;
  return parse_frame_row(*text, path_, line_);
}

RecordedVideo::RecordedVideo(const std::filesystem::path& folder, const RecordingSession& session)
    : path_(find_recorded(folder, kVideoName)), file_(path_, std::ios::binary) {
  if (!file_) throw InputError(path_, 0, "cannot be read", "it belongs to every recording that holds an image");
  size_ = static_cast<std::int64_t>(std::filesystem::file_size(path_));
  auto header = parse_matroska_header(bytes(0, std::min(size_, kLongestHeader)));
  if (!header) {
    throw InputError(path_, 0, "does not begin as a recording's video", "take it from a copy of the recording");
  }
  header_ = std::move(*header);
  decoder_.emplace(session.format(), header_.codec_private);
}

std::string RecordedVideo::bytes(std::int64_t position, std::int64_t size) {
  if (position < 0 || size < 0 || position > size_ - size) return {};
  std::string result(static_cast<std::size_t>(size), '\0');
  file_.clear();
  file_.seekg(position);
  return file_.read(result.data(), size) ? result : std::string();
}

std::optional<MatroskaPacket> RecordedVideo::packet_at(std::int64_t position) {
  const auto packet = parse_matroska_cluster(bytes(position, kMatroskaClusterHead), position);
  if (!packet || packet->size > size_ - packet->position) return std::nullopt;
  return packet;
}

std::optional<cv::Mat> RecordedVideo::read(std::int64_t position, std::int64_t size) {
  const std::string packet = bytes(position, size);
  if (packet.empty()) return std::nullopt;
  return decoder_->decode(packet);
}

}  // namespace alidade
