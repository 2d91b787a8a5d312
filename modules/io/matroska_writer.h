// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "io/append_file.h"
#include "io/checksum.h"
#include "io/matroska_header.h"

namespace alidade {

/// Where a frame's packet lies in a Matroska file.
struct MatroskaPacket {
  std::int64_t position = 0;        ///< of its first byte in the file
  std::int64_t size = 0;            ///< bytes
  std::chrono::nanoseconds time{};  ///< since the first frame
};

/// Writes a video of whole frames so that it loses nothing: each frame is a cluster of its own, handed to the kernel in
/// one piece, so the file ends after a whole frame whenever the program dies, and needs no closing to be read; where a
/// frame does not fit the file stays as it was. Closing adds the duration and an index for players to seek by.
/// NAME.part until then. libav's muxer is not used: it keeps packets back, and writes errors of the disk late.
class MatroskaWriter {
 public:
  /// Throws DeviceError, as all below do; DiskFull where the disk is.
  MatroskaWriter(const std::filesystem::path& path, const MatroskaTrack& track);

  /// Goes on with NAME.part, which this class began and which holds `packets`; what comes after `end` is given up.
  MatroskaWriter(const std::filesystem::path& path, MatroskaHeader header, const std::vector<MatroskaPacket>& packets,
                 std::int64_t end);

  /// Appends a frame; times must increase, and one that does not is moved on as little as can be.
  MatroskaPacket write(std::chrono::nanoseconds time, std::string_view packet);

  /// Gives up the last frame written; once.
  void take_back();

  std::int64_t size() const { return file_.size(); }  ///< bytes
  void start_writeback() { file_.start_writeback(); }

  /// Writes what is left and gives the file its name; without an index where the disk is full. At most once, and last.
  void close();

  /// Of the whole file, once closed. Not after going on with a file.
  Crc32 checksum() const;

 private:
  void note(const MatroskaPacket& packet);

  AppendFile file_;
  MatroskaHeader header_;
  std::chrono::nanoseconds period_;
  std::optional<std::chrono::nanoseconds> last_time_;
  std::vector<MatroskaPacket> index_;  // one in a while
  Crc32 rest_;                         // of what comes after the header
  Crc32 rest_before_;                  // the same, without the last frame
};

/// The clusters that MatroskaWriter writes have a head of this many bytes before the packet.
inline constexpr std::int64_t kMatroskaClusterHead = 35;

/// The packet of the cluster that begins with these bytes, at `position` of the file; empty where it is none.
std::optional<MatroskaPacket> parse_matroska_cluster(std::string_view bytes, std::int64_t position);

}  // namespace alidade
