// SPDX-License-Identifier: Apache-2.0
#include "io/reading_file.h"

#include <chrono>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "geometry/rotation.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

const Camera kCamera{640, 480, 500, 500, 320, 240, {}};
const std::vector<RigidBody> kBodies{{"deck", {{0, {}}, {1, {}}}}, {"hand", {{12, {}}}}};

std::vector<LineDetector> detectors() {
  std::vector<LineDetector> list{{3, "a", FocalLine{}}, {1, "a", Lighthouse2{1, {0.01, 0.05}}}};
  for (LineDetector& d : list) d.T_world_station.translation() = Eigen::Vector3d(1, 2, 3);
  list.push_back({8, "b", PixelAxis{kCamera, 0}});
  return list;
}

class ReadingFile : public testing::Test {
 protected:
  std::vector<LineReading> read(const std::string& text) {
    ReadingReader reader(folder_.write("r.csv", text), detectors(), kBodies);
    std::vector<LineReading> readings;
    while (const auto reading = reader.next()) readings.push_back(*reading);
    EXPECT_EQ(reader.count(), static_cast<std::int64_t>(readings.size()));
    EXPECT_EQ(reader.bytes(), static_cast<std::int64_t>(text.size()));
    return readings;
  }
  std::string message(const std::string& text) {
    return test::message_of(folder_.path(), [&] { read(text); });
  }
  test::TemporaryDirectory folder_;
};

TEST_F(ReadingFile, TakesColumnsByNameAndPassesOthersOver) {
  const auto readings = read(
      "cycle,marker,detector,angle_raw_rad,t_s,nx\r\n# a word\r\n7,12,3,-0.25,0.000005,x\r\n\r\n7,0,1,1e-3,12.5,\r\n");
  ASSERT_EQ(readings.size(), 2u);
  EXPECT_EQ(readings[0].time.time_since_epoch().count(), 5000);
  EXPECT_EQ(readings[0].marker, 12);
  EXPECT_EQ(readings[0].detector, 3);
  EXPECT_EQ(readings[0].value, -0.25);
  EXPECT_EQ(readings[0].sigma, 0.0);
  EXPECT_EQ(readings[1].time.time_since_epoch().count(), 12'500'000'000);
}

TEST_F(ReadingFile, ReadsPixelsAndAnglesByTheDetectorsUnit) {
  const auto readings = read(
      "t_ns,detector,marker,value_rad,value_px,sigma_rad,sigma_px\n1,3,0,0.5,,0.001,\n1,8,0,,33.5,,0.25\n2,8,0,1,2,3,"
      "\n");
  ASSERT_EQ(readings.size(), 3u);
  EXPECT_EQ(readings[0].value, 0.5);
  EXPECT_EQ(readings[0].sigma, 0.001);
  EXPECT_EQ(readings[1].value, 33.5);
  EXPECT_EQ(readings[1].sigma, 0.25);
  EXPECT_EQ(readings[2].value, 2);
  EXPECT_EQ(readings[2].sigma, 0.0);
}

TEST_F(ReadingFile, ReadsPlanesOfTheWorldAsTheDetectorsReadings) {
  const LineDetector detector = detectors()[0];
  std::string text = "t_s,detector,marker,nx,ny,nz,d_m\n";
  for (double value : {-0.7, 0.0, 0.3}) {
    const Plane plane = *plane_of(detector, value);
    text += fmt::format("{},3,0,{:.7f},{:.7f},{:.7f},{:.6f}\n", value + 1, plane.normal.x(), plane.normal.y(),
                        plane.normal.z(), plane.offset);
  }
  const auto readings = read(text);
  ASSERT_EQ(readings.size(), 3u);
  EXPECT_NEAR(readings[0].value, -0.7, 1e-7);
  EXPECT_NEAR(readings[1].value, 0.0, 1e-7);
  EXPECT_NEAR(readings[2].value, 0.3, 1e-7);
}

TEST_F(ReadingFile, NamesTheRowThatIsWrong) {
  const std::string header = "t_s,detector,marker,angle_raw_rad\n0.1,3,0,0.1\n";
  EXPECT_EQ(message(header + "0.1,3,5,0\n"), "r.csv:3: marker 5 belongs to no body; known are: 0, 1, 12");
  EXPECT_EQ(message(header + "0.1,2,0,0\n"), "r.csv:3: unknown detector 2; known are: 1, 3, 8");
  EXPECT_EQ(message(header + "0.1,3,0,nan\n"),
            "r.csv:3: column 'angle_raw_rad': 'nan' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(message(header + "0.1,3,0,inf\n"),
            "r.csv:3: column 'angle_raw_rad': 'inf' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(message(header + "0.1,3,0,0.1x\n"),
            "r.csv:3: column 'angle_raw_rad': '0.1x' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(message(header + "nan,3,0,0.1\n"),
            "r.csv:3: column 't_s': 'nan' is not a time; correct it or leave the row out");
  EXPECT_EQ(message(header + "0.1,3,red,0.1\n"),
            "r.csv:3: column 'marker': 'red' is not a whole number; correct it or leave the row out");
  EXPECT_EQ(message(header + "0.0999,3,0,0\n"),
            "r.csv:3: time goes back from 0.100000000 s to 0.099900000 s; sort the readings by time");
  EXPECT_EQ(message(header + "0.1,3,0,\n"),
            "r.csv:3: has no reading of detector 3; it reads angles: 'angle_raw_rad' is wanted");
  EXPECT_EQ(message(header + "0.1,8,0,0.1\n"),
            "r.csv:3: has no reading of detector 8; it reads pixels: 'value_px' is wanted");
  EXPECT_EQ(message(header + "0.1,3,0\n"), "r.csv:3: has 3 cells, the header names 4; correct the row or leave it out");
  EXPECT_EQ(message(header + "0.1,3,0,1,2\n"),
            "r.csv:3: has 5 cells, the header names 4; correct the row or leave it out");
  EXPECT_EQ(message("t_s,detector,marker,value_rad,sigma_rad\n0,3,0,0,0\n"),
            "r.csv:2: column 'sigma_rad': '0' is not > 0; correct it or leave the row out");
}

TEST_F(ReadingFile, TellsALastLineThatIsCutOff) {
  const std::string header = "t_s,detector,marker,angle_raw_rad\n0.1,3,0,0.1\n";
  EXPECT_EQ(message(header + "0.1,3"),
            "r.csv:3: the last line is cut off; was the recording broken off? remove the line");
  EXPECT_EQ(read(header + "0.1,3,0,0.2").size(), 2u);
}

TEST_F(ReadingFile, RefusesWhatIsNoPlaneOfTheDetector) {
  const std::string header = "t_s,detector,marker,nx,ny,nz,d_m\n";
  EXPECT_EQ(read(header + "0,3,0,0.9995,0,0,0.9995\n").size(), 1u);
  EXPECT_EQ(message(header + "0,3,0,1.01,0,0,1\n"),
            "r.csv:2: the plane's normal must be of length 1, got 1.01; divide nx, ny, nz, d_m by it");
  EXPECT_EQ(message(header + "0,3,0,0,0,0,1\n"),
            "r.csv:2: the plane's normal must be of length 1, got 0; divide nx, ny, nz, d_m by it");
  EXPECT_EQ(message(header + "0,3,0,1,0,nan,1\n"),
            "r.csv:2: column 'nz': 'nan' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(message(header + "0,3,0,1,0,0,1.02\n"),
            "r.csv:2: the plane misses the centre of detector 3 by 20.0 mm; give planes of the same detector poses, or "
            "'angle_raw_rad'");
  EXPECT_EQ(message(header + "0,3,0,0,1,0,2\n"), "r.csv:2: detector 3 sees no point of the plane's axis");
}

TEST_F(ReadingFile, NamesTheColumnThatIsMissing) {
  EXPECT_EQ(message(""), "r.csv: is empty; its first line must name the columns");
  EXPECT_EQ(message("t,detector,marker,angle_raw_rad\n"),
            "r.csv:1: has no column 't_s'; known are: t, detector, marker, angle_raw_rad");
  EXPECT_EQ(message("t_s,detectors,marker,angle_raw_rad\n"),
            "r.csv:1: has no column 'detector'; did you mean 'detectors'?");
  EXPECT_EQ(message("t_s,detector,marker\n"),
            "r.csv:1: has no column with readings; 'angle_raw_rad', 'value_px' or a plane 'nx,ny,nz,d_m' is wanted");
  EXPECT_EQ(message("t_s,detector,marker,nx,ny,nz\n"),
            "r.csv:1: has no column 'd_m'; known are: t_s, detector, marker, nx, ny, nz");
  EXPECT_EQ(message("t_s,t_s,detector,marker,nx,ny,nz\n"), "r.csv:1: two columns are named 't_s'");
  EXPECT_EQ(test::message_of(folder_.path(), [&] { ReadingReader(folder_ / "none.csv", detectors(), kBodies); }),
            "none.csv: cannot be opened: No such file or directory; check the name");
}

TEST_F(ReadingFile, GivesBackExactlyWhatWasWritten) {
  std::vector<LineReading> readings{{Timestamp(std::chrono::nanoseconds(-5)), 3, 12, 1.0 / 3, 0.0},
                                    {Timestamp(std::chrono::nanoseconds(7)), 8, 0, 1e-17, 0.25},
                                    {Timestamp(std::chrono::nanoseconds(7)), 1, 1, -0.1, 1e-4 / 3}};
  ReadingWriter writer(folder_ / "w.csv", detectors(), true);
  for (const LineReading& reading : readings) writer.write(reading);
  EXPECT_THROW(writer.write({{}, 99, 0, 0, 0}), std::invalid_argument);
  writer.commit();
  ReadingReader reader(folder_ / "w.csv", detectors(), kBodies);
  for (const LineReading& expected : readings) {
    const auto found = reader.next();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->time, expected.time);
    EXPECT_EQ(found->detector, expected.detector);
    EXPECT_EQ(found->marker, expected.marker);
    EXPECT_EQ(found->value, expected.value);
    EXPECT_EQ(found->sigma, expected.sigma);
  }
  EXPECT_FALSE(reader.next());
}

// A named pipe stands for a feed: the first reading is there while the second line is still being written.
TEST_F(ReadingFile, GivesALineOfAFeedAsSoonAsItIsComplete) {
  const auto pipe = folder_ / "feed";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int feed = ::open(pipe.c_str(), O_RDWR);
  const auto send = [&](std::string_view text) {
    ASSERT_EQ(::write(feed, text.data(), text.size()), ssize_t(text.size()));
  };
  send("t_s,detector,marker,value_rad\n1,3,0,0.5\n2,3,0,0.");
  ReadingReader reader(pipe, detectors(), kBodies);
  EXPECT_EQ(reader.next()->value, 0.5);
  send("25\n");
  EXPECT_EQ(reader.next()->value, 0.25);
  ::close(feed);
  EXPECT_FALSE(reader.next());
}

TEST_F(ReadingFile, EndsWhenAStopIsRequestedDuringSilence) {
  const auto pipe = folder_ / "feed";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int feed = ::open(pipe.c_str(), O_RDWR);
  const std::string text = "t_s,detector,marker,value_rad\n1,3,0,0.5\n2,3";
  ASSERT_EQ(::write(feed, text.data(), text.size()), ssize_t(text.size()));
  std::stop_source stop;
  ReadingReader reader(pipe, detectors(), kBodies, stop.get_token());
  EXPECT_TRUE(reader.next());
  std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop.request_stop();
  });
  EXPECT_FALSE(reader.next());
  ::close(feed);
}

TEST_F(ReadingFile, ReadsRowsThatStraddleItsBlocks) {
  std::string text = "t_ns,detector,marker,value_rad\n";
  for (int i = 0; i < 20'000; ++i) text += fmt::format("{},3,0,{}\n", i, 1e-5 * i);
  const auto readings = read(text);
  ASSERT_EQ(readings.size(), 20'000u);
  for (int i = 0; i < 20'000; ++i) {
    const LineReading& reading = readings[static_cast<std::size_t>(i)];
    ASSERT_EQ(reading.time.time_since_epoch().count(), i);
    ASSERT_EQ(reading.value, 1e-5 * i);
  }
  EXPECT_EQ(message(std::string(2'000'000, 'x')), "r.csv:1: a line is longer than 1 MB; is it a text?");
}

}  // namespace
}  // namespace alidade
