// SPDX-License-Identifier: Apache-2.0
#include "io/receiver_reading_file.h"

#include <chrono>

#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;
using test::message_of;

std::vector<Receiver> receivers() {
  Receiver finder, camera;
  finder.id = 1;
  finder.sigma = 0.01;
  camera.id = 5;
  camera.camera = Camera{640, 480, 500, 500, 320, 240, {}};
  return {finder, camera};
}

class ReceiverReadings : public ::testing::Test {
 protected:
  test::TemporaryDirectory folder_;

  std::string refusal(const std::string& text) const {
    const auto path = folder_.write("sky.csv", text);
    return message_of(folder_.path(), [&] { read_receiver_readings(path, receivers()); });
  }
};

TEST_F(ReceiverReadings, AreGivenBackAsTheyWereWritten) {
  ReceiverReading angles{Timestamp(1500ms), 1, {-2.5, 0.7}, Eigen::Matrix2d::Zero(), 291.5, 3};
  ReceiverReading pixel{Timestamp(1600ms), 5, {100.25, 33.5}, 0.25 * Eigen::Matrix2d::Identity(), std::nullopt, -1};
  ReceiverReadingWriter writer(folder_ / "sky.csv", receivers());
  writer.write(angles);
  writer.write(pixel);
  writer.commit();
  const auto read = read_receiver_readings(folder_ / "sky.csv", receivers());
  ASSERT_EQ(read.size(), 2u);
  for (const auto& [wanted, got] : {std::pair(angles, read[0]), std::pair(pixel, read[1])}) {
    EXPECT_EQ(got.time, wanted.time);
    EXPECT_EQ(got.receiver, wanted.receiver);
    EXPECT_EQ(got.value, wanted.value);
    EXPECT_EQ(got.covariance, wanted.covariance);
    EXPECT_EQ(got.temperature_k, wanted.temperature_k);
    EXPECT_EQ(got.target, wanted.target);
  }
}

TEST_F(ReceiverReadings, AreReadInDegreesToo) {
  const auto path = folder_.write("sky.csv", "t_s,receiver,azimuth_deg,elevation_deg,u_px,v_px\n2.5,1,-90,30,,\n");
  const auto read = read_receiver_readings(path, receivers());
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].time, Timestamp(2500ms));
  EXPECT_NEAR(read[0].value[0], -1.5707963267948966, 1e-15);
  EXPECT_NEAR(read[0].value[1], 0.5235987755982988, 1e-15);
}

TEST_F(ReceiverReadings, ErrAcrossTheLineOfSightByTheSigmaTold) {
  const auto path =
      folder_.write("sky.csv", "t_s,receiver,azimuth_rad,elevation_rad,u_px,v_px,sigma_rad\n1,1,0.5,1.2,,,0.01\n");
  const auto bearing = bearing_of(receivers()[0], read_receiver_readings(path, receivers())[0]);
  EXPECT_TRUE(bearing->covariance.isApprox(1e-4 * Eigen::Matrix2d::Identity(), 1e-9));
}

TEST_F(ReceiverReadings, NameTheRowThatIsWrong) {
  const std::string head = "t_s,receiver,azimuth_rad,elevation_rad,u_px,v_px\n1,1,0,0,,\n";
  EXPECT_EQ(refusal(head + "2,3,0,0,,\n"), "sky.csv:3: unknown receiver 3; known are: 1, 5");
  EXPECT_EQ(refusal(head + "2,1,nan,0,,\n"),
            "sky.csv:3: column 'azimuth_rad': 'nan' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(refusal(head + "2,1,45,12,,\n"),
            "sky.csv:3: azimuth 45 rad, elevation 12 rad is no direction; are these degrees? name the columns "
            "azimuth_deg, elevation_deg");
  EXPECT_EQ(refusal(head + "2,5,,,1800,200\n"),
            "sky.csv:3: pixel (1800, 200) lies outside the image of 640x480 px; are the receivers those of this "
            "recording, at its resolution?");
  EXPECT_EQ(refusal(head + "7,1,0,0,,\n5,1,0,0,,\n"),
            "sky.csv:4: time of receiver 1 goes back from 7.000000000 s to 5.000000000 s; sort the readings by time");
  EXPECT_EQ(refusal(head + "2,1,0.1"),
            "sky.csv:3: the last line is cut off; was the recording broken off? remove the line");
  EXPECT_EQ(refusal("t_s,receiver,azimuth_rad,elevation_rad,u_px\n"),
            "sky.csv:1: has no column 'v_px'; did you mean 'u_px'?");
  EXPECT_EQ(refusal(""), "sky.csv: is empty; its first line must name the columns");
}

TEST_F(ReceiverReadings, MayComeALittleOutOfOrder) {
  const auto path = folder_.write("sky.csv",
                                  "t_s,receiver,azimuth_rad,elevation_rad,u_px,v_px\n"
                                  "7,1,0,0,,\n6.5,1,0,0,,\n5,5,,,100,100\n");
  EXPECT_EQ(read_receiver_readings(path, receivers()).size(), 3u);
}

}  // namespace
}  // namespace alidade
