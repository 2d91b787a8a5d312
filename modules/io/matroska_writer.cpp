// SPDX-License-Identifier: Apache-2.0
#include "io/matroska_writer.h"

#include <utility>

#include "io/ebml.h"

namespace alidade {
namespace {

// Source: RFC 9559, 5.1.3 and 5.1.5.
constexpr std::uint32_t kCluster = 0x1F43B675, kTimestamp = 0xE7, kSimpleBlock = 0xA3, kCues = 0x1C53BB6B;
constexpr std::chrono::seconds kIndexStep{1};
constexpr std::size_t kBlockHead = 4;  // bytes: track, time relative to the cluster, flags

std::string cluster_head(std::chrono::nanoseconds time, std::size_t packet_size) {
  const std::string timestamp = ebml_element(kTimestamp, big_endian(static_cast<std::uint64_t>(time.count()), 8));
  const std::string block = big_endian(kSimpleBlock, 1) + ebml_long_size(kBlockHead + packet_size) +
                            std::string("\x81\x00\x00\x80", kBlockHead);  // track 1, +0, a key frame
  return big_endian(kCluster, 4) + ebml_long_size(timestamp.size() + block.size() + packet_size) + timestamp + block;
}

std::string index_of(const std::vector<MatroskaPacket>& packets, std::size_t segment_begin) {
  std::string points;
  for (const MatroskaPacket& packet : packets) {
    const auto cluster = static_cast<std::uint64_t>(packet.position - kMatroskaClusterHead) - segment_begin;
    points += ebml_element(0xBB, ebml_unsigned(0xB3, static_cast<std::uint64_t>(packet.time.count())) +
                                     ebml_element(0xB7, ebml_unsigned(0xF7, 1) + ebml_unsigned(0xF1, cluster)));
  }
  return ebml_element(kCues, points);
}

}  // namespace

std::optional<MatroskaPacket> parse_matroska_cluster(std::string_view bytes, std::int64_t position) {
  if (static_cast<std::int64_t>(bytes.size()) < kMatroskaClusterHead) return std::nullopt;
  const auto cluster = parse_ebml_head(bytes);
  if (!cluster || cluster->id != kCluster || cluster->length != 12) return std::nullopt;
  const auto timestamp = parse_ebml_head(bytes.substr(12));
  if (!timestamp || timestamp->id != kTimestamp || timestamp->length != 2 || timestamp->size != 8) return std::nullopt;
  const auto block = parse_ebml_head(bytes.substr(22));
  if (!block || block->id != kSimpleBlock || block->length != 9 || block->size < kBlockHead) return std::nullopt;
  if (cluster->size != block->size + 19) return std::nullopt;
  return MatroskaPacket{position + kMatroskaClusterHead, static_cast<std::int64_t>(block->size - kBlockHead),
                        std::chrono::nanoseconds(static_cast<std::int64_t>(parse_big_endian(bytes.substr(14, 8))))};
}

MatroskaWriter::MatroskaWriter(const std::filesystem::path& path, const MatroskaTrack& track)
    : file_(path), header_(make_matroska_header(track)), period_(track.period.value_or(std::chrono::nanoseconds(0))) {
  file_.append({header_.bytes});
}

MatroskaWriter::MatroskaWriter(const std::filesystem::path& path, MatroskaHeader header,
                               const std::vector<MatroskaPacket>& packets, std::int64_t end)
    : file_(path, AppendFile::Start::AtEnd), header_(std::move(header)), period_(0) {
  for (const MatroskaPacket& packet : packets) note(packet);
  file_.cut(end);
}

void MatroskaWriter::note(const MatroskaPacket& packet) {
  if (period_.count() == 0 && last_time_) period_ = packet.time - *last_time_;
  last_time_ = packet.time;
  if (index_.empty() || packet.time - index_.back().time >= kIndexStep) index_.push_back(packet);
}

MatroskaPacket MatroskaWriter::write(std::chrono::nanoseconds time, std::string_view packet) {
  if (last_time_ && time <= *last_time_) time = *last_time_ + std::chrono::nanoseconds(1);
  const std::string head = cluster_head(std::max(time, std::chrono::nanoseconds(0)), packet.size());
  const std::int64_t begin = file_.size();
  file_.append({head, packet});
  rest_before_ = rest_;
  rest_.add(head);
  rest_.add(packet);
  const MatroskaPacket written{begin + kMatroskaClusterHead, static_cast<std::int64_t>(packet.size()), time};
  note(written);
  return written;
}

void MatroskaWriter::take_back() {
  const std::int64_t end = static_cast<std::int64_t>(header_.bytes.size()) + rest_before_.length();
  file_.cut(end);
  rest_ = rest_before_;
  if (!index_.empty() && index_.back().position > end) index_.pop_back();
}

void MatroskaWriter::close() {
  std::optional<std::int64_t> index_position = file_.size();
  const std::string index = index_of(index_, header_.segment_begin);
  try {
    file_.append({index});
    rest_.add(index);
  } catch (const DiskFull&) {
    index_position.reset();
  }
  close_matroska_header(header_, last_time_.value_or(std::chrono::nanoseconds(0)) + period_, index_position,
                        file_.size());
  file_.overwrite(0, header_.bytes);
  file_.commit();
}

Crc32 MatroskaWriter::checksum() const {
  Crc32 crc(header_.bytes);
  crc.add(rest_);
  return crc;
}

}  // namespace alidade
