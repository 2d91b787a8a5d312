// SPDX-License-Identifier: Apache-2.0
#include "io/trc_file.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "core/errors.h"
#include "io/text_lines.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;
using Position = std::optional<Eigen::Vector3d>;

TEST(TrcWriter, WritesWhatOpenSimReads) {
  const test::TemporaryDirectory folder;
  TrcWriter writer(folder / "markers.trc", {"probe_1", "left wing"});
  writer.write(Timestamp(1s), std::vector<Position>{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-0.5, 0, 1e-6)});
  writer.write(Timestamp(1004ms), std::vector<Position>{std::nullopt, Eigen::Vector3d(0.25, -4, -1e-9)});
  writer.write(Timestamp(1008ms), std::vector<Position>{std::nullopt, std::nullopt});
  writer.commit();
  EXPECT_EQ(read_bytes(folder / "markers.trc"),
            "PathFileType\t4\t(X/Y/Z)\tmarkers.trc\n"
            "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
            "250\t250\t3\t2\tm\t250\t1\t3\n"
            "Frame#\tTime\tprobe_1\t\t\tleft_wing\t\t\n"
            "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
            "\n"
            "1\t1.000000000\t1.000000\t3.000000\t-2.000000\t-0.500000\t0.000001\t0.000000\n"
            "2\t1.004000000\t\t\t\t0.250000\t0.000000\t4.000000\n"
            "3\t1.008000000\t\t\t\t\t\t\n");
}

TEST(TrcWriter, LeavesOneFileAfterCommitAndNoneWithout) {
  const test::TemporaryDirectory folder;
  {
    TrcWriter writer(folder / "markers.trc", {"a"});
    writer.write(Timestamp(1s), std::vector<Position>(1));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  {
    TrcWriter writer(folder / "markers.trc", {"a"});
    writer.commit();
  }
  const auto files = std::filesystem::directory_iterator(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(TrcWriter, KeepsEveryRowOfALongRecording) {
  const test::TemporaryDirectory folder;
  TrcWriter writer(folder / "markers.trc", {"a"});
  const int frames = 20'000;  // several blocks of the copy
  for (int i = 0; i < frames; ++i) writer.write(Timestamp(i * 4ms), std::vector<Position>{Eigen::Vector3d(i, 0, 0)});
  writer.commit();
  const auto lines = read_lines(folder / "markers.trc");
  ASSERT_EQ(lines.size(), 5u + frames);
  EXPECT_EQ(lines[2].text, "250\t250\t20000\t1\tm\t250\t1\t20000");
  EXPECT_EQ(lines.back().text, "20000\t79.996000000\t19999.000000\t0.000000\t0.000000");
}

TEST(TrcWriter, RefusesAnotherNumberOfMarkers) {
  const test::TemporaryDirectory folder;
  EXPECT_THROW(TrcWriter(folder / "a.trc", {}), std::invalid_argument);
  TrcWriter writer(folder / "markers.trc", {"a", "b"});
  EXPECT_THROW(writer.write(Timestamp(), std::vector<Position>(1)), std::invalid_argument);
  EXPECT_THROW(TrcWriter(folder / "missing/a.trc", {"a"}), DeviceError);
}

}  // namespace
}  // namespace alidade
