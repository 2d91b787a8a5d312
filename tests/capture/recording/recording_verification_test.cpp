// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recording_verification.h"

#include <gtest/gtest.h>

#include "capture/recording/recording_group.h"
#include "io/text_lines.h"
#include "tests/capture/recording/synthetic_camera.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

class VerifiedRecording : public testing::Test {
 protected:
  void SetUp() override {
    RecorderOptions options;
    options.codec = LosslessCodec::Raw;
    RecordingWriter writer(path_, camera_, options);
    writer.note({CaptureEventKind::Opened, HostTime{}, "synthetic:0", 0, ""});
    for (int i = 0; i < 5; ++i) writer.write(frame(i));
    writer.note({CaptureEventKind::Restarted, HostTime{}, "synthetic:0", 5, ""});
    for (int i = 5; i < 8; ++i) writer.write(frame(i));
    writer.close();
  }
  // Two frames are lost before 3, and the camera counts anew from 5 on.
  Frame frame(int index) const {
    Frame result = test::synthetic_frame(camera_, index);
    if (index >= 3) *result.stamp.sequence += 2;
    if (index == 3) result.stamp.dropped_before = 2;
    if (index >= 5) result.stamp.sequence = static_cast<std::uint64_t>(index - 5);
    return result;
  }
  std::string text(const char* name) const { return read_bytes(path_ / name); }
  void replace(const char* name, const std::string& from, const std::string& to) {
    std::string bytes = text(name);
    const std::size_t at = bytes.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    folder_.write(std::string("camera/") + name, bytes.replace(at, from.size(), to));
  }
  std::vector<std::string> faults() const {
    std::vector<std::string> lines;
    for (const RecordingFault& fault : verify_recording(path_).faults) {
      lines.push_back(fmt::format("{}:{}: {}", fault.path.filename().string(), fault.line, fault.what));
    }
    return lines;
  }
  bool has(const std::string& line) const {
    const std::vector<std::string> all = faults();
    for (const std::string& fault : all) {
      if (fault.find(line) != std::string::npos) return true;
    }
    ADD_FAILURE() << fmt::format("{}", fmt::join(all, "\n"));
    return false;
  }

  test::TemporaryDirectory folder_;
  fs::path path_ = folder_ / "camera";
  RecordingSubject camera_ = test::synthetic_camera({PixelKind::Bgr}, {32, 24});
};

TEST_F(VerifiedRecording, IsWithoutFaultAsItWasRecorded) {
  const RecordingVerification verification = verify_recording(path_);
  EXPECT_EQ(faults(), std::vector<std::string>{});
  EXPECT_TRUE(verification.is_closed);
  EXPECT_EQ(verification.totals.frames, 8);
  EXPECT_EQ(verification.totals.dropped, 2u);
  EXPECT_GT(verification.bytes, 8 * 32 * 24 * 3);
}

TEST_F(VerifiedRecording, ShowsOneWrongBitOfAnImage) {
  std::string video = text("video.mkv");
  video[video.size() / 2] ^= 4;
  folder_.write("camera/video.mkv", video);
  EXPECT_EQ(faults().size(), 2u);
  EXPECT_TRUE(has("frames.csv:5: the pixels of its frame are not those recorded"));
  EXPECT_TRUE(has("video.mkv:0: has checksum "));
}

TEST_F(VerifiedRecording, ShowsAWrongBitAnywhereInTheVideo) {
  const std::string video = text("video.mkv");
  for (const std::size_t at : {std::size_t{3}, std::size_t{60}, video.size() - 3}) {
    std::string damaged = video;
    damaged[at] ^= 1;
    folder_.write("camera/video.mkv", damaged);
    EXPECT_FALSE(faults().empty()) << at;
  }
}

TEST_F(VerifiedRecording, ShowsAVideoThatIsCutOff) {
  fs::resize_file(path_ / "video.mkv", fs::file_size(path_ / "video.mkv") * 3 / 4);
  EXPECT_TRUE(has("frames.csv:9: its frame is not in the video"));
  EXPECT_TRUE(has("video.mkv:0: is "));
  fs::remove(path_ / "video.mkv");
  EXPECT_TRUE(has("video.mkv:0: cannot be read"));
}

TEST_F(VerifiedRecording, ShowsARowThatIsMissing) {
  const std::string rows = text("frames.csv");
  const std::size_t begin = rows.find("\n4,") + 1;
  replace("frames.csv", rows.substr(begin, rows.find('\n', begin) + 1 - begin), "");
  EXPECT_TRUE(has("frames.csv:6: is frame 5, not 4"));
  EXPECT_TRUE(has("frames.csv:6: its frame does not follow the one before in the video"));
  EXPECT_TRUE(has("session.json:0: says 8 frames, the rows 7"));
}

TEST_F(VerifiedRecording, ShowsAGapInTheCountThatNobodySpeaksOf) {
  replace("frames.csv", ",5,2,0,", ",6,2,0,");
  EXPECT_TRUE(has("frames.csv:5: sequence goes from 2 to 6, but 2 frames are said to be lost"));
}

TEST_F(VerifiedRecording, ShowsATimeThatStandsStill) {
  replace("frames.csv", "2,1000080000000,", "2,1000040000000,");
  EXPECT_TRUE(has("frames.csv:4: t_ns does not increase"));
}

TEST_F(VerifiedRecording, ShowsWhereARowCannotBeRead) {
  replace("frames.csv", "\n3,", "\nx,");
  EXPECT_TRUE(has("frames.csv:5: column 'index': 'x' cannot be"));
  replace("events.csv", "restarted", "stopped");
  EXPECT_TRUE(has("events.csv:3: there is no event 'stopped'"));
}

TEST_F(VerifiedRecording, ShowsThatItWasNotClosed) {
  path_ = folder_ / "open";
  { RecordingWriter(path_, camera_).write(frame(0)); }
  EXPECT_EQ(faults(), std::vector<std::string>{"session.json:0: the recording was not closed"});
}

TEST_F(VerifiedRecording, MayBeOneOfSeveral) {
  { RecordingWriter(folder_ / "second", camera_).write(frame(0)); }
  const std::vector<std::string> members{"camera", "second"};
  write_recording_group(folder_.path(), "alidade test", members);
  EXPECT_EQ(recordings_of(folder_.path()), (std::vector<fs::path>{folder_ / "camera", folder_ / "second"}));
  EXPECT_EQ(recordings_of(path_), std::vector<fs::path>{path_});
  EXPECT_TRUE(recordings_of(folder_ / "absent").empty());
  const std::string group = read_bytes(folder_ / "session.json");
  EXPECT_NE(group.find("\"device_to_host_at_end_ns\": 1000000000000"), std::string::npos) << group;
  folder_.write("session.json", "{\"format\": \"alidade recordings\"}");
  EXPECT_NE(test::message_of(folder_.path(), [&] { recordings_of(folder_.path()); }).find("session.json: is damaged"),
            std::string::npos);
}

}  // namespace
}  // namespace alidade
