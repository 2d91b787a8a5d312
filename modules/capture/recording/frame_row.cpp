// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/frame_row.h"

#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/errors.h"

namespace alidade {
namespace {

constexpr std::array<std::string_view, 12> kColumns{
    "index", "t_ns",         "device_time_ns", "host_time_ns", "sequence",    "dropped_before", "discarded_before",
    "flags", "source_index", "position_bytes", "size_bytes",   "pixels_crc32"};
enum Column {
  Index,
  Time,
  DeviceTime,
  HostTimeColumn,
  Sequence,
  Dropped,
  Discarded,
  Flags,
  SourceIndex,
  Position,
  Size,
  Crc
};

using Cells = std::array<std::string_view, kColumns.size()>;

template <class Number>
std::string cell(const std::optional<Number>& number) {
  return number ? std::to_string(*number) : "";
}

std::optional<std::int64_t> count_of(const std::optional<Timestamp>& time) {
  if (!time) return std::nullopt;
  return time->time_since_epoch().count();
}

std::string flags_of(const FrameRow& row) {
  if (row.stamp.is_damaged && row.is_recovered) return "damaged|recovered";
  return row.stamp.is_damaged ? "damaged" : row.is_recovered ? "recovered" : "";
}

// Takes the cells of a line apart and says which one is wrong.
class RowReader {
 public:
  RowReader(std::string_view text, const std::filesystem::path& path, int line) : path_(path), line_(line) {
    std::size_t count = 0;
    for (bool more = true; more; ++count) {
      const std::size_t comma = text.find(',');
      more = comma != std::string_view::npos;
      if (count < cells_.size()) cells_[count] = text.substr(0, comma);
      if (more) text.remove_prefix(comma + 1);
    }
    if (count != cells_.size()) {
      throw InputError(path_, line_, fmt::format("has {} cells, the header names {}", count, cells_.size()), "");
    }
  }

  std::string_view text(Column column) const { return cells_[column]; }

  template <class Number>
  std::optional<Number> optional(Column column, int base = 10) const {
    const std::string_view word = cells_[column];
    if (word.empty()) return std::nullopt;
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number, base);
    if (error != std::errc{} || end != word.data() + word.size()) fail(column);
    return number;
  }

  template <class Number>
  Number number(Column column, int base = 10) const {
    const auto value = optional<Number>(column, base);
    if (!value) fail(column);
    return *value;
  }

  [[noreturn]] void fail(Column column) const {
    throw InputError(path_, line_, fmt::format("column '{}': '{}' cannot be", kColumns[column], cells_[column]), "");
  }

 private:
  const std::filesystem::path& path_;
  int line_;
  Cells cells_{};
};

}  // namespace

std::string frame_row_header() {
  return fmt::format("{}\n", fmt::join(kColumns, ","));
}

std::string format_frame_row(const FrameRow& row) {
  std::optional<std::int64_t> host;
  if (row.stamp.host_time) host = row.stamp.host_time->time_since_epoch().count();
  const std::string crc = row.position ? fmt::format("{:08x}", row.pixels_crc32) : "";
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", row.index, row.time.time_since_epoch().count(),
                     cell(count_of(row.stamp.device_time)), cell(host), cell(row.stamp.sequence),
                     row.stamp.dropped_before, row.stamp.discarded_before, flags_of(row), row.source_index,
                     cell(row.position), row.size, crc);
}

FrameRow parse_frame_row(std::string_view text, const std::filesystem::path& path, int line) {
  const RowReader cells(text, path, line);
  FrameRow row;
  row.index = cells.number<std::int64_t>(Index);
  row.source_index = cells.number<std::int64_t>(SourceIndex);
  row.time = Timestamp(std::chrono::nanoseconds(cells.number<std::int64_t>(Time)));
  if (const auto t = cells.optional<std::int64_t>(DeviceTime))
    row.stamp.device_time = Timestamp(std::chrono::nanoseconds(*t));
  if (const auto t = cells.optional<std::int64_t>(HostTimeColumn))
    row.stamp.host_time = HostTime(std::chrono::nanoseconds(*t));
  row.stamp.sequence = cells.optional<std::uint64_t>(Sequence);
  row.stamp.dropped_before = cells.number<std::uint64_t>(Dropped);
  row.stamp.discarded_before = cells.number<std::uint64_t>(Discarded);
  const std::string_view flags = cells.text(Flags);
  row.stamp.is_damaged = flags.starts_with("damaged");
  row.is_recovered = flags.ends_with("recovered");
  if (flags != flags_of(row)) cells.fail(Flags);
  row.position = cells.optional<std::int64_t>(Position);
  row.size = cells.number<std::int64_t>(Size);
  if (row.position && *row.position < 0) cells.fail(Position);
  if (row.size < 0 || (row.size > 0) != row.position.has_value()) cells.fail(Size);
  if (row.position) row.pixels_crc32 = cells.number<std::uint32_t>(Crc, 16);
  if (row.index < 0) cells.fail(Index);
  return row;
}

void RecordingTotals::add(const FrameRow& row) {
  ++frames;
  without_image += row.position ? 0 : 1;
  damaged += row.stamp.is_damaged ? 1 : 0;
  recovered += row.is_recovered ? 1 : 0;
  dropped += row.stamp.dropped_before;
  discarded += row.stamp.discarded_before;
}

}  // namespace alidade
