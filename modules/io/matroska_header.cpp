// SPDX-License-Identifier: Apache-2.0
#include "io/matroska_header.h"

#include <fmt/format.h>

#include "io/ebml.h"

namespace alidade {
namespace {

// Source: RFC 9559, 5.
constexpr std::uint32_t kEbml = 0x1A45DFA3, kSegment = 0x18538067, kSeekHead = 0x114D9B74, kSeek = 0x4DBB,
                        kSeekId = 0x53AB, kSeekPosition = 0x53AC, kInfo = 0x1549A966, kTracks = 0x1654AE6B,
                        kTrackEntry = 0xAE, kVideo = 0xE0, kCodecPrivate = 0x63A2, kDuration = 0x4489,
                        kCues = 0x1C53BB6B, kCluster = 0x1F43B675;
constexpr std::size_t kSeekHeadSize = 26, kDurationSize = 11;  // bytes, heads included

std::string seek_head(std::uint64_t position) {
  const std::string seek = ebml_element(kSeekId, big_endian(kCues, 4)) +  //
                           ebml_element(kSeekPosition, big_endian(position, 8));
  return ebml_element(kSeekHead, ebml_element(kSeek, seek));
}

std::string track_entry(const MatroskaTrack& track) {
  std::string video = ebml_unsigned(0xB0, static_cast<std::uint64_t>(track.size.width)) +
                      ebml_unsigned(0xBA, static_cast<std::uint64_t>(track.size.height));
  if (track.fourcc != 0) {
    std::string fourcc = big_endian(track.fourcc, 4);
    fourcc.assign(fourcc.rbegin(), fourcc.rend());  // as the characters stand in memory
    video += ebml_element(0x2EB524, fourcc);
  }
  std::string entry = ebml_unsigned(0xD7, 1) + ebml_unsigned(0x73C5, 1) + ebml_unsigned(0x83, 1) +
                      ebml_unsigned(0x9C, 0) + ebml_element(0x86, track.codec_id);
  if (!track.codec_private.empty()) entry += ebml_element(kCodecPrivate, track.codec_private);
  if (track.period) entry += ebml_unsigned(0x23E383, static_cast<std::uint64_t>(track.period->count()));
  return ebml_element(kTrackEntry, entry + ebml_element(kVideo, video));
}

// The place of the payload of the first element `id` among those from `begin` on; empty where there is none.
struct Found {
  std::size_t begin = 0, payload = 0, size = 0;
};
std::optional<Found> find(std::string_view bytes, std::size_t begin, std::size_t end, std::uint32_t id) {
  while (begin < end) {
    const auto head = parse_ebml_head(bytes.substr(begin, end - begin));
    if (!head) return std::nullopt;
    const std::size_t payload = begin + head->length;
    if (head->id == id) return Found{begin, payload, static_cast<std::size_t>(head->size)};
    if (head->id == kCluster || head->size > end - payload) return std::nullopt;
    begin = payload + static_cast<std::size_t>(head->size);
  }
  return std::nullopt;
}

}  // namespace

MatroskaHeader make_matroska_header(const MatroskaTrack& track) {
  MatroskaHeader header;
  header.codec_private = track.codec_private;
  std::string& bytes = header.bytes;
  bytes = ebml_element(kEbml, ebml_unsigned(0x4286, 1) + ebml_unsigned(0x42F7, 1) + ebml_unsigned(0x42F2, 4) +
                                  ebml_unsigned(0x42F3, 8) + ebml_element(0x4282, "matroska") +
                                  ebml_unsigned(0x4287, 4) + ebml_unsigned(0x4285, 2));
  bytes += big_endian(kSegment, 4) + ebml_long_size(kUnknownSize);
  header.segment_begin = header.index_note = bytes.size();
  bytes += ebml_void(kSeekHeadSize);
  // The duration comes first in its element, so that its place is known. Times are in nanoseconds.
  const std::string info = ebml_void(kDurationSize) + ebml_unsigned(0x2AD7B1, 1) +  //
                           ebml_element(0x4D80, "Alidade") + ebml_element(0x5741, "Alidade");
  bytes += ebml_element(kInfo, info);
  header.duration = bytes.size() - info.size();
  bytes += ebml_element(kTracks, track_entry(track));
  return header;
}

std::optional<MatroskaHeader> parse_matroska_header(std::string_view bytes) {
  const auto ebml = parse_ebml_head(bytes);
  if (!ebml || ebml->id != kEbml || ebml->size > bytes.size()) return std::nullopt;
  const std::size_t segment = ebml->length + static_cast<std::size_t>(ebml->size);
  const auto segment_head = parse_ebml_head(bytes.substr(std::min(segment, bytes.size())));
  if (!segment_head || segment_head->id != kSegment) return std::nullopt;
  MatroskaHeader header;
  header.segment_begin = header.index_note = segment + segment_head->length;
  const auto info = find(bytes, header.segment_begin, bytes.size(), kInfo);
  const auto tracks = find(bytes, header.segment_begin, bytes.size(), kTracks);
  if (!info || !tracks || info->begin != header.index_note + kSeekHeadSize) return std::nullopt;
  header.duration = info->payload;
  const std::size_t end = tracks->payload + tracks->size;
  if (end > bytes.size()) return std::nullopt;
  header.bytes = bytes.substr(0, end);
  const auto entry = find(bytes, tracks->payload, end, kTrackEntry);
  if (!entry) return std::nullopt;
  if (const auto codec_private = find(bytes, entry->payload, entry->payload + entry->size, kCodecPrivate)) {
    header.codec_private = bytes.substr(codec_private->payload, codec_private->size);
  }
  return header;
}

void close_matroska_header(MatroskaHeader& header, std::chrono::nanoseconds duration,
                           std::optional<std::int64_t> index_position, std::int64_t file_size) {
  constexpr std::size_t kSizeLength = 8;
  const auto segment_size = static_cast<std::uint64_t>(file_size) - header.segment_begin;
  header.bytes.replace(header.segment_begin - kSizeLength, kSizeLength, ebml_long_size(segment_size));
  const std::string note = index_position
                               ? seek_head(static_cast<std::uint64_t>(*index_position) - header.segment_begin)
                               : ebml_void(kSeekHeadSize);
  header.bytes.replace(header.index_note, kSeekHeadSize, note);
  header.bytes.replace(header.duration, kDurationSize, ebml_float(kDuration, static_cast<double>(duration.count())));
}

}  // namespace alidade
