// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/frame_row.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"

namespace alidade {
namespace {

FrameRow full_row() {
  FrameRow row;
  row.index = 3;
  row.source_index = 5;
  row.time = Timestamp(std::chrono::nanoseconds(1'234'567'890'123));
  row.stamp.device_time = Timestamp(std::chrono::nanoseconds(-7));
  row.stamp.host_time = HostTime(std::chrono::nanoseconds(9));
  row.stamp.sequence = 18'446'744'073'709'551'615u;
  row.stamp.dropped_before = 2;
  row.stamp.discarded_before = 1;
  row.stamp.is_damaged = true;
  row.position = 4'000'000'000;
  row.size = 77;
  row.pixels_crc32 = 0x0badcafe;
  return row;
}

FrameRow read(const std::string& line) {
  return parse_frame_row(std::string_view(line).substr(0, line.size() - 1), "frames.csv", 9);
}

TEST(FrameRow, IsReadAsItIsWritten) {
  const FrameRow row = full_row();
  const std::string line = format_frame_row(row);
  EXPECT_EQ(line, "3,1234567890123,-7,9,18446744073709551615,2,1,damaged,5,4000000000,77,0badcafe\n");
  EXPECT_EQ(format_frame_row(read(line)), line);
  FrameRow bare;
  bare.is_recovered = true;
  EXPECT_EQ(format_frame_row(bare), "0,0,,,,0,0,recovered,0,,0,\n");
  EXPECT_EQ(format_frame_row(read(format_frame_row(bare))), format_frame_row(bare));
  EXPECT_TRUE(read(format_frame_row(bare)).is_recovered);
}

TEST(FrameRow, ThatCannotBeIsNamedByLineAndColumn) {
  const auto message = [](const std::string& line) { return test::message_of("x", [&] { read(line + "\n"); }); };
  EXPECT_EQ(message("3,4"), "frames.csv:9: has 2 cells, the header names 12");
  EXPECT_EQ(message("x,0,,,,0,0,,0,,0,"), "frames.csv:9: column 'index': 'x' cannot be");
  EXPECT_EQ(message("0,,,,,0,0,,0,,0,"), "frames.csv:9: column 't_ns': '' cannot be");
  EXPECT_EQ(message("0,0,,,,0,0,odd,0,,0,"), "frames.csv:9: column 'flags': 'odd' cannot be");
  EXPECT_EQ(message("0,0,,,,0,0,,0,,5,"), "frames.csv:9: column 'size_bytes': '5' cannot be");
  EXPECT_EQ(message("0,0,,,,0,0,,0,-4,5,00"), "frames.csv:9: column 'position_bytes': '-4' cannot be");
  EXPECT_EQ(message("0,0,,,,-1,0,,0,,0,"), "frames.csv:9: column 'dropped_before': '-1' cannot be");
}

TEST(RecordingTotals, CountWhatRowsSay) {
  RecordingTotals totals;
  totals.add(full_row());
  totals.add({});
  EXPECT_EQ(totals, (RecordingTotals{2, 1, 1, 0, 2, 1}));
}

}  // namespace
}  // namespace alidade
