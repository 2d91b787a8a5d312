// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "io/atomic_file.h"
#include "io/ebml.h"
#include "io/lossless_encoder.h"
#include "io/matroska_writer.h"
#include "io/text_lines.h"
#include "io/video_reader.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
const LosslessFormat kFormat{PixelLayout::Grey8, {64, 48}, LosslessCodec::Ffv1};

cv::Mat image_of(int index) {
  cv::Mat image(kFormat.size, CV_8UC1);
  cv::RNG(static_cast<std::uint64_t>(index) + 1).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

class MatroskaFile : public testing::Test {
 protected:
  MatroskaWriter start() { return {path_, encoder_.track(milliseconds(40))}; }
  void write(MatroskaWriter& writer, int count) {
    for (int i = 0; i < count; ++i) {
      packets_.push_back(writer.write(milliseconds(40) * i, encoder_.encode(image_of(i))));
    }
  }
  // Reads the file by libav; every frame must be right.
  int count_frames(const std::filesystem::path& path) {
    VideoReader reader(path);
    int count = 0;
    while (const auto frame = reader.next()) {
      EXPECT_EQ(cv::norm(frame->image, image_of(count), cv::NORM_INF), 0) << "frame " << count;
      EXPECT_EQ(frame->time, Timestamp(milliseconds(40) * count));
      ++count;
    }
    fault_ = reader.fault();
    return count;
  }
  test::TemporaryDirectory folder_;
  std::filesystem::path path_ = folder_ / "a.mkv";
  LosslessEncoder encoder_{kFormat};
  std::vector<MatroskaPacket> packets_;
  std::optional<std::string> fault_;
};

TEST_F(MatroskaFile, IsReadByLibavWithItsTimesAndItsEnd) {
  MatroskaWriter writer = start();
  write(writer, 60);
  writer.close();
  EXPECT_FALSE(std::filesystem::exists(part_name(path_)));
  EXPECT_EQ(count_frames(path_), 60);
  EXPECT_FALSE(fault_) << *fault_;
  EXPECT_EQ(VideoReader(path_).facts().fps_hz, 25.0);
}

TEST_F(MatroskaFile, IsWholeAfterEveryFrame) {
  MatroskaWriter writer = start();
  for (int i = 0; i < 5; ++i) {
    writer.write(milliseconds(40) * i, encoder_.encode(image_of(i)));
    EXPECT_EQ(count_frames(part_name(path_)), i + 1);
  }
}

TEST_F(MatroskaFile, ThatEndsInTheMiddleOfAFrameKeepsThoseBefore) {
  MatroskaWriter writer = start();
  write(writer, 5);
  for (const std::int64_t cut : {std::int64_t{1}, std::int64_t{20}, packets_[4].size + 20}) {
    std::filesystem::resize_file(part_name(path_), static_cast<std::uintmax_t>(writer.size() - cut));
    EXPECT_EQ(count_frames(part_name(path_)), 4) << cut;
  }
}

TEST_F(MatroskaFile, SaysWhereItsPacketsAre) {
  MatroskaWriter writer = start();
  write(writer, 5);
  const std::string bytes = read_bytes(part_name(path_));
  for (int i = 0; i < 5; ++i) {
    const auto& [position, size, time] = packets_[static_cast<std::size_t>(i)];
    const std::string packet = bytes.substr(static_cast<std::size_t>(position), static_cast<std::size_t>(size));
    EXPECT_EQ(packet, encoder_.encode(image_of(i)));
    const auto found = parse_matroska_cluster(
        std::string_view(bytes).substr(static_cast<std::size_t>(position - kMatroskaClusterHead)),
        position - kMatroskaClusterHead);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->position, position);
    EXPECT_EQ(found->size, size);
    EXPECT_EQ(found->time, time);
  }
}

TEST_F(MatroskaFile, ChecksumIsThatOfTheFile) {
  MatroskaWriter writer = start();
  write(writer, 5);
  writer.close();
  EXPECT_EQ(writer.checksum().value(), crc32_of_file(path_).value());
  EXPECT_EQ(writer.checksum().length(), static_cast<std::int64_t>(std::filesystem::file_size(path_)));
}

TEST_F(MatroskaFile, ThatIsGoneOnWithIsTheSameAsOneInOnePiece) {
  {
    MatroskaWriter writer = start();
    write(writer, 30);
    writer.close();
  }
  const std::string whole = read_bytes(path_);
  std::filesystem::rename(path_, part_name(path_));
  const auto header = parse_matroska_header(whole);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->codec_private, encoder_.track({}).codec_private);
  MatroskaWriter again(path_, *header, packets_, packets_.back().position + packets_.back().size);
  again.close();
  EXPECT_TRUE(read_bytes(path_) == whole);
}

TEST_F(MatroskaFile, TakesTimesThatStandStill) {
  MatroskaWriter writer = start();
  EXPECT_EQ(writer.write(milliseconds(5), "a").time, nanoseconds(milliseconds(5)));
  EXPECT_EQ(writer.write(milliseconds(5), "b").time, nanoseconds(5'000'001));
  EXPECT_EQ(writer.write(milliseconds(1), "c").time, nanoseconds(5'000'002));
}

TEST_F(MatroskaFile, StaysWholeWhereTheDiskIsFull) {
  MatroskaWriter writer = start();
  write(writer, 3);
  {
    const test::FileSizeLimit limit(static_cast<rlim_t>(writer.size() + 100));
    EXPECT_THROW(write(writer, 1), DiskFull);
  }
  EXPECT_EQ(count_frames(part_name(path_)), 3);
  EXPECT_EQ(static_cast<std::int64_t>(std::filesystem::file_size(part_name(path_))), writer.size());
}

TEST(Ebml, HeadsAreReadAsTheyAreWritten) {
  for (const std::size_t size : {0u, 5u, 126u, 127u, 300u}) {
    const std::string element = ebml_element(0x2EB524, std::string(size, 'x'));
    const auto head = parse_ebml_head(element);
    ASSERT_TRUE(head) << size;
    EXPECT_EQ(head->id, 0x2EB524u);
    EXPECT_EQ(head->size, size);
    EXPECT_EQ(head->length + size, element.size());
  }
  EXPECT_EQ(ebml_unsigned(0xD7, 1), std::string("\xD7\x81\x01"));
  EXPECT_EQ(ebml_void(26).size(), 26u);
  EXPECT_EQ(ebml_void(128).size(), 128u);
  EXPECT_FALSE(parse_ebml_head(""));
  EXPECT_FALSE(parse_ebml_head(std::string(12, '\0')));
  EXPECT_FALSE(parse_ebml_head("\xD7"));
}

}  // namespace
}  // namespace alidade
