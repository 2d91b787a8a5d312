// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recording_repair.h"

#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "capture/recording/recording.h"
#include "capture/recording/recording_verification.h"
#include "io/text_lines.h"
#include "io/video_reader.h"
#include "tests/capture/recording/synthetic_camera.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

class InterruptedRecording : public testing::Test {
 protected:
  void SetUp() override { record(5); }

  void record(int count) {
    fs::remove_all(path_);
    RecordingWriter writer(path_, camera_);
    for (int i = 0; i < count; ++i) writer.write(test::synthetic_frame(camera_, i));
    writer.note({CaptureEventKind::Opened, HostTime{}, "synthetic:0", 0, "granted"});
  }
  void cut(const char* name, std::uintmax_t bytes) {
    const fs::path path = path_ / name;
    fs::resize_file(path, fs::file_size(path) - bytes);
  }
  void append(const char* name, const std::string& text) {
    std::ofstream(path_ / name, std::ios::app | std::ios::binary) << text;
  }
  // The frames of the repaired recording, which must be without fault and, but for stamps of recovered ones, as they
  // were given.
  int frames_after_repair() {
    repair_ = repair_recording(path_);
    for (const RecordingFault& fault : verify_recording(path_).faults) ADD_FAILURE() << fault.path << fault.what;
    const auto source = open_recording(path_);
    int count = 0;
    while (const auto frame = source->next()) {
      const Frame given = test::synthetic_frame(camera_, count);
      EXPECT_EQ(cv::norm(frame->image, given.image, cv::NORM_INF), 0) << count;
      EXPECT_EQ(frame->time, given.time) << count;
      ++count;
    }
    EXPECT_FALSE(source->fault()) << *source->fault();
    EXPECT_EQ(repair_.totals.frames, count);
    return count;
  }

  test::TemporaryDirectory folder_;
  fs::path path_ = folder_ / "camera";
  RecordingSubject camera_ = test::synthetic_camera({PixelKind::Grey, 12}, {64, 48});
  RecordingRepair repair_;
};

TEST_F(InterruptedRecording, IsClosedWithAllItsFrames) {
  EXPECT_EQ(frames_after_repair(), 5);
  EXPECT_EQ(repair_.recovered, 0);
  EXPECT_EQ(repair_.cut_bytes, 0);
  EXPECT_FALSE(repair_.was_closed);
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(path_)) names.insert(entry.path().filename());
  EXPECT_EQ(names, (std::set<std::string>{"events.csv", "frames.csv", "session.json", "video.mkv"}));
  VideoReader video(path_ / "video.mkv");
  while (video.next()) {
  }
  EXPECT_FALSE(video.fault()) << *video.fault();
}

TEST_F(InterruptedRecording, IsRepairedOnce) {
  frames_after_repair();
  const std::string before = read_bytes(path_ / "session.json");
  EXPECT_TRUE(repair_recording(path_).was_closed);
  EXPECT_EQ(read_bytes(path_ / "session.json"), before);
}

TEST_F(InterruptedRecording, KeepsAFrameWithoutARowAsRecovered) {
  const std::string rows = read_bytes(path_ / "frames.csv.part");
  cut("frames.csv.part", rows.size() - 1 - rows.rfind('\n', rows.size() - 2));
  EXPECT_EQ(frames_after_repair(), 5);
  EXPECT_EQ(repair_.recovered, 1);
  EXPECT_EQ(repair_.totals.recovered, 1);
  EXPECT_NE(read_bytes(path_ / "frames.csv").find(",recovered,4,"), std::string::npos);
}

TEST_F(InterruptedRecording, CutsAHalfRowAndAHalfFrame) {
  cut("frames.csv.part", 10);
  cut("video.mkv.part", 10);
  EXPECT_EQ(frames_after_repair(), 4);
  EXPECT_EQ(repair_.recovered, 0);
  EXPECT_GT(repair_.cut_bytes, 1000);
}

TEST_F(InterruptedRecording, GivesUpRowsWhoseFramesTheDiskNeverGot) {
  cut("video.mkv.part", 10);
  EXPECT_EQ(frames_after_repair(), 4);
  EXPECT_EQ(repair_.lost, 1);
}

TEST_F(InterruptedRecording, CutsWhatWasNeverWritten) {
  append("frames.csv.part", std::string(300, '\0'));
  append("frames.csv.part", "\n");
  append("video.mkv.part", std::string(5000, '\0'));
  append("events.csv.part", "12,stal");
  EXPECT_EQ(frames_after_repair(), 5);
  EXPECT_EQ(repair_.cut_bytes, 5308);
  EXPECT_EQ(read_bytes(path_ / "events.csv"),
            "host_time_ns,kind,frame,source,detail\n0,opened,0,\"synthetic:0\",\"granted\"\n");
}

TEST_F(InterruptedRecording, KeepsFramesBehindADamagedOne) {
  std::string video = read_bytes(path_ / "video.mkv.part");
  const std::size_t cluster = video.find("\x1F\x43\xB6\x75", video.size() / 2);
  ASSERT_NE(cluster, std::string::npos);
  video[cluster + 20] ^= 1;  // its time
  video[cluster] ^= 1;       // what makes it a cluster
  std::ofstream(path_ / "video.mkv.part", std::ios::binary) << video;
  EXPECT_EQ(repair_recording(path_).totals.frames, 5);
  const auto source = open_recording(path_);
  int count = 0;
  while (const auto frame = source->next()) {
    EXPECT_TRUE(test::are_same(*frame, test::synthetic_frame(camera_, count))) << count;
    ++count;
  }
  EXPECT_EQ(count, 5);
}

TEST_F(InterruptedRecording, MayBeInterruptedAgainWhileItIsRepaired) {
  frames_after_repair();
  // As if the repair had died before it wrote session.json.
  std::string session = read_bytes(path_ / "session.json");
  session.replace(session.find("\"closed\""), 8, "\"recording\"");
  folder_.write("camera/session.json", session);
  fs::rename(path_ / "events.csv", path_ / "events.csv.part");
  EXPECT_EQ(frames_after_repair(), 5);
}

TEST_F(InterruptedRecording, WithoutAFrameIsClosedToo) {
  record(0);
  EXPECT_EQ(frames_after_repair(), 0);
  EXPECT_FALSE(fs::exists(path_ / "video.mkv"));
  record(0);
  cut("frames.csv.part", 5);  // in the header
  EXPECT_EQ(frames_after_repair(), 0);
  record(0);
  append("video.mkv.part", "not its header");
  EXPECT_EQ(frames_after_repair(), 0);
  EXPECT_FALSE(fs::exists(path_ / "video.mkv.part"));
}

TEST_F(InterruptedRecording, KeepsAFrameThoughNoRowWasWritten) {
  record(1);
  const std::string rows = read_bytes(path_ / "frames.csv.part");
  cut("frames.csv.part", rows.size() - 1 - rows.find('\n'));
  EXPECT_EQ(repair_recording(path_).recovered, 1);
  const auto frame = open_recording(path_)->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(cv::norm(frame->image, test::synthetic_frame(camera_, 0).image, cv::NORM_INF), 0);
}

TEST_F(InterruptedRecording, IsLeftAloneWhileItIsRecorded) {
  path_ = folder_ / "live";
  RecordingWriter writer(path_, camera_);
  writer.write(test::synthetic_frame(camera_, 0));
  EXPECT_EQ(test::message_of(folder_.path(), [&] { repair_recording(path_); }),
            "live/frames.csv: cannot be written: another program is writing it; wait until that has ended");
  writer.write(test::synthetic_frame(camera_, 1));
  writer.close();
  EXPECT_TRUE(verify_recording(path_).faults.empty());
}

TEST_F(InterruptedRecording, ThatIsNoneIsNamed) {
  fs::create_directory(folder_ / "foreign");
  EXPECT_NE(test::message_of(folder_.path(), [&] { repair_recording(folder_ / "foreign"); }).find("session.json"),
            std::string::npos);
  fs::remove(path_ / "video.mkv.part");
  EXPECT_EQ(test::message_of(folder_.path(), [&] { repair_recording(path_); }),
            "camera/video.mkv: cannot be read; it belongs to every recording that holds an image");
}

}  // namespace
}  // namespace alidade
