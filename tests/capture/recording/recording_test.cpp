// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recording.h"

#include <gtest/gtest.h>

#include "capture/recording/recording_writer.h"
#include "io/checksum.h"
#include "io/text_lines.h"
#include "io/video_reader.h"
#include "tests/capture/recording/synthetic_camera.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;
const cv::Size kSize{64, 48};
const PixelFormat kGrey{PixelKind::Grey, 8};

RecorderOptions with_codec(LosslessCodec codec) {
  RecorderOptions options;
  options.codec = codec;
  options.keep_free_bytes = 0;
  return options;
}

class RecordingFolder : public testing::Test {
 protected:
  void record(RecordingWriter& writer, const RecordingSubject& camera, int count) {
    for (int i = 0; i < count; ++i) writer.write(test::synthetic_frame(camera, i));
  }
  std::vector<Frame> replay() {
    const auto source = open_recording(path_);
    std::vector<Frame> frames;
    while (auto frame = source->next()) frames.push_back(*frame);
    fault_ = source->fault().value_or("");
    return frames;
  }
  std::string text(const char* name) { return read_bytes(path_ / name); }

  test::TemporaryDirectory folder_;
  fs::path path_ = folder_ / "camera";
  RecordingSubject camera_ = test::synthetic_camera(kGrey, kSize);
  std::string fault_;
};

TEST_F(RecordingFolder, GivesEveryFormatBackBitByBitFromEveryCodec) {
  for (const PixelFormat& format : test::all_pixel_formats()) {
    for (const auto codec : {LosslessCodec::Raw, LosslessCodec::FfvHuff, LosslessCodec::Ffv1}) {
      for (const bool closed : {false, codec == LosslessCodec::Ffv1}) {  // closing waits for the disk
        path_ = folder_ / fmt::format("{}_{}_{}", name_of(format), name_of(codec), closed);
        if (is_recording(path_)) continue;
        const RecordingSubject camera = test::synthetic_camera(format, kSize);
        RecordingWriter writer(path_, camera, with_codec(codec));
        record(writer, camera, 4);
        if (closed) writer.close();
        const std::vector<Frame> frames = replay();
        ASSERT_EQ(frames.size(), 4u) << path_;
        for (int i = 0; i < 4; ++i) {
          const Frame& frame = frames[static_cast<std::size_t>(i)];
          EXPECT_TRUE(test::are_same(frame, test::synthetic_frame(camera, i))) << path_ << " frame " << i;
          EXPECT_EQ(frame.name, fmt::format("{}#{}", path_.filename().string(), i));
          EXPECT_EQ(frame.index, i);
        }
        EXPECT_EQ(fault_.empty(), closed) << fault_;
      }
    }
  }
}

TEST_F(RecordingFolder, IsNamedPartUntilItIsClosed) {
  RecordingWriter writer(path_, camera_, with_codec(LosslessCodec::Ffv1));
  record(writer, camera_, 2);
  for (const char* name : {"frames.csv", "events.csv", "video.mkv"}) {
    EXPECT_TRUE(fs::exists(path_ / (std::string(name) + ".part"))) << name;
    EXPECT_FALSE(fs::exists(path_ / name)) << name;
  }
  EXPECT_TRUE(is_recording(path_));
  writer.close();
  for (const char* name : {"frames.csv", "events.csv", "video.mkv"}) {
    EXPECT_FALSE(fs::exists(path_ / (std::string(name) + ".part"))) << name;
    EXPECT_TRUE(fs::exists(path_ / name)) << name;
  }
  EXPECT_TRUE(is_recording(path_));
}

TEST_F(RecordingFolder, KeepsStampsDropsDamageAndFramesWithoutAnImage) {
  RecordingWriter writer(path_, camera_, with_codec(LosslessCodec::Ffv1));
  std::vector<Frame> written;
  for (int i = 0; i < 6; ++i) written.push_back(test::synthetic_frame(camera_, i));
  written[0].image = cv::Mat();
  written[0].stamp.is_damaged = true;
  written[1].stamp = {};
  written[2].stamp.dropped_before = 3;
  written[3].stamp.is_damaged = true;
  written[4].image = cv::Mat();
  written[5].stamp.discarded_before = 2;
  written[5].index = 7;
  for (const Frame& frame : written) writer.write(frame);
  writer.close();
  const std::vector<Frame> frames = replay();
  ASSERT_EQ(frames.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(test::are_same(frames[i], written[i])) << i;
  EXPECT_EQ(fault_,
            path_.string() + ": 3 frames dropped by the camera, 2 frames discarded since recording was too slow");
  const RecordingSession session = read_session(path_);
  EXPECT_EQ(session.totals, (RecordingTotals{6, 2, 2, 0, 3, 2}));
}

TEST_F(RecordingFolder, IsReadByLibavWhetherClosedOrNot) {
  RecordingWriter writer(path_, camera_, with_codec(LosslessCodec::Raw));
  record(writer, camera_, 5);
  const auto count = [this](const char* name) {
    VideoReader reader(path_ / name);
    int frames = 0;
    while (const auto frame = reader.next()) {
      EXPECT_EQ(frame->time, Timestamp(std::chrono::milliseconds(40) * frames));
      EXPECT_EQ(cv::norm(frame->image, test::synthetic_frame(camera_, frames).image, cv::NORM_INF), 0);
      ++frames;
    }
    return frames;
  };
  EXPECT_EQ(count("video.mkv.part"), 5);
  writer.close();
  EXPECT_EQ(count("video.mkv"), 5);
}

TEST_F(RecordingFolder, SaysWhatItHoldsAndItsChecksums) {
  RecordingSubject camera = camera_;
  camera.camera.exposure = std::chrono::microseconds(500);
  camera.camera.stamped = StampedMoment::ReadoutEnd;
  camera.request.settings = {{"gain", "auto"}};
  camera.request.fps_hz = 25;
  RecordingWriter writer(path_, camera);
  record(writer, camera, 3);
  writer.note({CaptureEventKind::Stalled, HostTime(std::chrono::nanoseconds(5)), "a, \"b\"", 2, "no\nframe"});
  writer.close({{"resent packets", 12}});
  const RecordingSession session = read_session(path_);
  EXPECT_TRUE(session.is_closed);
  EXPECT_EQ(session.camera.source, "synthetic:0");
  EXPECT_EQ(session.camera.exposure, camera.camera.exposure);
  EXPECT_EQ(session.camera.period, camera.camera.period);
  EXPECT_EQ(session.camera.stamped, StampedMoment::ReadoutEnd);
  EXPECT_EQ(session.request.settings, camera.request.settings);
  EXPECT_EQ(session.request.fps_hz, 25.0);
  EXPECT_EQ(session.codec, LosslessCodec::Ffv1);
  EXPECT_EQ(session.totals.frames, 3);
  EXPECT_EQ(session.events, 1);
  const auto offset = std::chrono::seconds(1000) + std::chrono::microseconds(250);  // to the stamp, not the middle
  EXPECT_EQ(session.offset_at_start, offset);
  EXPECT_EQ(session.offset_at_end, offset);
  EXPECT_EQ(session.statistics.at(0).second, 12u);
  ASSERT_EQ(session.files.size(), 3u);
  for (const RecordedFile& file : session.files) {
    const Crc32 crc = crc32_of_file(path_ / file.name);
    EXPECT_EQ(file.crc32, crc.value()) << file.name;
    EXPECT_EQ(file.bytes, crc.length()) << file.name;
  }
  EXPECT_EQ(text("events.csv"), "host_time_ns,kind,frame,source,detail\n5,stalled,2,\"a, \"\"b\"\"\",\"no frame\"\n");
}

TEST_F(RecordingFolder, WithoutAFrameIsARecordingAllTheSame) {
  RecordingWriter writer(path_, camera_);
  EXPECT_TRUE(replay().empty());
  writer.close();
  EXPECT_TRUE(replay().empty());
  EXPECT_EQ(fault_, "");
}

TEST_F(RecordingFolder, IsNotWrittenTwice) {
  { RecordingWriter writer(path_, camera_); }
  EXPECT_EQ(test::message_of(folder_.path(), [&] { RecordingWriter(path_, camera_); }),
            "camera: holds a recording already; choose another folder");
}

TEST_F(RecordingFolder, TakesNoFrameOfAnotherSize) {
  RecordingWriter writer(path_, camera_);
  record(writer, camera_, 1);
  Frame other = test::synthetic_frame(test::synthetic_camera(kGrey, {32, 48}), 1);
  EXPECT_EQ(test::message_of(folder_.path(), [&] { writer.write(other); }),
            "synthetic:0: recording: frame 1 is Mono8 of 32x48, not Mono8 for 64x48 px; start a new recording");
  EXPECT_TRUE(writer.is_open());
  const RecordingSubject odd = test::synthetic_camera({PixelKind::Yuyv}, {63, 48});
  EXPECT_EQ(test::message_of(folder_.path(), [&] { RecordingWriter(folder_ / "odd", odd); }),
            "synthetic:0: recording: YUYV images of 63x48 px cannot be kept; ask the camera for another size");
}

TEST_F(RecordingFolder, OnAFullDiskIsClosedWithAllThatWasClaimed) {
  RecordingWriter writer(path_, camera_, with_codec(LosslessCodec::Raw));
  std::string message;
  int claimed = 0;
  {
    const test::FileSizeLimit limit(20'000);
    try {
      for (; claimed < 100; ++claimed) writer.write(test::synthetic_frame(camera_, claimed));
    } catch (const DiskFull& full) {
      message = full.what();
    }
  }
  EXPECT_EQ(claimed, 6);
  EXPECT_EQ(message,
            fmt::format("{0}: recording: largest size of a file reached; 6 frames are safe in {0}", path_.string()));
  EXPECT_FALSE(writer.is_open());
  EXPECT_EQ(replay().size(), 6u);
  EXPECT_EQ(fault_, "");
  EXPECT_EQ(crc32_of_file(path_ / "video.mkv").value(), read_session(path_).files.at(0).crc32);
}

TEST_F(RecordingFolder, WhoseRowDoesNotFitTakesItsFrameBack) {
  // The rows reach the limit first: frames without an image between.
  RecordingWriter writer(path_, camera_, with_codec(LosslessCodec::Raw));
  int claimed = 0;
  Frame empty = test::synthetic_frame(camera_, 0);
  empty.image = cv::Mat();
  {
    const test::FileSizeLimit limit(10'000);
    writer.write(test::synthetic_frame(camera_, 0));
    try {
      for (claimed = 1; claimed < 1000; ++claimed) {
        const bool last = text("frames.csv.part").size() > 9'850;
        writer.write(last ? test::synthetic_frame(camera_, claimed) : empty);
      }
    } catch (const DiskFull&) {
    }
  }
  EXPECT_LT(claimed, 1000);
  EXPECT_EQ(replay().size(), static_cast<std::size_t>(claimed));
  VideoReader video(path_ / "video.mkv");
  int packets = 0;
  while (video.next()) ++packets;
  int images = 0;
  for (const Frame& frame : replay()) images += frame.image.empty() ? 0 : 1;
  EXPECT_EQ(packets, images);
  EXPECT_EQ(crc32_of_file(path_ / "video.mkv").value(), read_session(path_).files.at(0).crc32);
}

TEST_F(RecordingFolder, KeepsToItsBudget) {
  RecorderOptions options = with_codec(LosslessCodec::Raw);
  options.max_bytes = 20'000;
  RecordingWriter writer(path_, camera_, options);
  EXPECT_EQ(test::message_of(folder_.path(), [&] { record(writer, camera_, 100); }),
            "camera: recording: max_bytes = 20000 reached; 6 frames are safe in camera");
  EXPECT_EQ(replay().size(), 6u);
  options = with_codec(LosslessCodec::Raw);
  options.keep_free_bytes = std::int64_t{1} << 60;
  path_ = folder_ / "none";
  RecordingWriter none(path_, camera_, options);
  EXPECT_EQ(test::message_of(folder_.path(), [&] { record(none, camera_, 1); }),
            "none: recording: disk full but for the 1152921504606846976 bytes to keep free; 0 frames are safe in none");
}

TEST_F(RecordingFolder, WithAHalfRowGivesTheRowsBefore) {
  {
    RecordingWriter writer(path_, camera_, with_codec(LosslessCodec::Ffv1));
    record(writer, camera_, 3);
  }
  const fs::path rows = path_ / "frames.csv.part";
  fs::resize_file(rows, fs::file_size(rows) - 3);
  EXPECT_EQ(replay().size(), 2u);
  EXPECT_NE(fault_.find("was not closed"), std::string::npos) << fault_;
}

TEST_F(RecordingFolder, WhosePixelsHaveChangedSaysSo) {
  {
    RecordingWriter writer(path_, camera_, with_codec(LosslessCodec::Raw));
    record(writer, camera_, 3);
    writer.close();
  }
  std::string video = text("video.mkv");
  video[video.size() / 2] ^= 1;
  folder_.write("camera/video.mkv", video);
  const std::vector<Frame> frames = replay();
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_TRUE(frames[1].stamp.is_damaged);
  EXPECT_NE(fault_.find("1 frame no longer as recorded"), std::string::npos) << fault_;
}

TEST_F(RecordingFolder, ThatIsNoneIsNamed) {
  const auto message = [this](const char* name) {
    return test::message_of(folder_.path(), [&] { open_recording(folder_ / name); });
  };
  EXPECT_FALSE(is_recording(folder_ / "absent"));
  EXPECT_NE(message("absent").find("absent/session.json"), std::string::npos) << message("absent");
  fs::create_directory(folder_ / "foreign");
  folder_.write("foreign/session.json", "{\"format\": \"tape\"}");
  EXPECT_FALSE(is_recording(folder_ / "foreign"));
  EXPECT_EQ(message("foreign"),
            "foreign/session.json: is not the session of one camera's recording; name the folder of a recording");
  folder_.write("foreign/session.json", "{\"format\": \"alidade recording\", ");
  EXPECT_NE(message("foreign").find("foreign/session.json: is damaged: "), std::string::npos) << message("foreign");
  folder_.write("foreign/session.json", "{\"format\": \"alidade recording\", \"version\": 99}");
  EXPECT_NE(message("foreign").find("is of version 99 of the format, known is 1"), std::string::npos);
}

TEST_F(RecordingFolder, TakesTheSmallestCodecThatKeepsUp) {
  const auto codec_at = [this](std::chrono::nanoseconds period, const char* name) {
    RecordingSubject camera = camera_;
    camera.camera.period = period;
    return RecordingWriter(folder_ / name, camera).session().codec;
  };
  EXPECT_EQ(codec_at(std::chrono::seconds(10), "slow"), LosslessCodec::Ffv1);
  EXPECT_EQ(codec_at(std::chrono::nanoseconds(10), "fast"), LosslessCodec::Raw);
}

TEST_F(RecordingFolder, WhoseVideoIsMissingIsNamed) {
  {
    RecordingWriter writer(path_, camera_);
    record(writer, camera_, 1);
  }
  fs::remove(path_ / "video.mkv.part");
  EXPECT_EQ(test::message_of(folder_.path(), [&] { replay(); }),
            "camera/video.mkv: cannot be read; it belongs to every recording that holds an image");
}

TEST(RecorderOptions, AreNamedWhereTheyCannotBe) {
  const auto message = [](const RecorderOptions& options) {
    try {
      validate(options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  RecorderOptions options;
  EXPECT_EQ(message(options), "");
  options.busy_share = 1.5;
  EXPECT_EQ(message(options), "busy_share must be > 0 and <= 1, got 1.5");
  options = {};
  options.max_bytes = 0;
  EXPECT_EQ(message(options), "max_bytes must be > 0, got 0");
  options = {};
  options.keep_free_bytes = -1;
  EXPECT_EQ(message(options), "keep_free_bytes must be >= 0, got -1");
  options = {};
  options.assumed_fps_hz = 0;
  EXPECT_EQ(message(options), "assumed_fps_hz must be > 0 and < 1e6 Hz, got 0");
  options = {};
  options.writeback_s = 0;
  EXPECT_EQ(message(options), "writeback_s must be > 0 and < 1e6 s, got 0");
}

}  // namespace
}  // namespace alidade
