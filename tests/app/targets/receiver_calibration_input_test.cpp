// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_input.h"

#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "io/receiver_file.h"
#include "io/receiver_reading_file.h"
#include "tests/app/targets/disturbed_flight.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// Files of a simulated flight of three cameras and their path.
class ReceiverCalibrationFiles : public testing::Test {
 protected:
  void SetUp() override {
    const ReceiverCalibrationInput flight = test::disturbed_flight();
    write(flight.receivers, flight.readings);
    std::string path = "t_s,x_m,y_m,z_m\n";
    for (const TimedPosition& at : flight.truth) {
      path += fmt::format("{},{},{},{}\n", to_seconds(at.time.time_since_epoch()), at.p.x(), at.p.y(), at.p.z());
    }
    directory_.write("path.csv", path);
  }

  void write(const std::vector<Receiver>& receivers, const std::vector<ReceiverReading>& readings) {
    write_receivers(directory_ / "receivers.yaml", receivers);
    ReceiverReadingWriter writer(directory_ / "observations.csv", receivers);
    for (const ReceiverReading& reading : readings) writer.write(reading);
    writer.commit();
  }

  ReceiverCalibrationSources sources() const {
    return {directory_ / "receivers.yaml", directory_ / "observations.csv", directory_ / "path.csv", {}, {}};
  }

  std::string refusal(const ReceiverCalibrationSources& sources) const {
    return test::message_of(directory_.path(), [&] { read_calibration_input(sources); });
  }

  test::TemporaryDirectory directory_;
};

TEST_F(ReceiverCalibrationFiles, AreReadAsOne) {
  const auto input = read_calibration_input(sources());
  EXPECT_EQ(input.receivers.size(), 3u);
  EXPECT_EQ(input.readings.size(), test::disturbed_flight().readings.size());
  EXPECT_EQ(input.truth.size(), test::simulated_path().size());
}

TEST_F(ReceiverCalibrationFiles, MayLieInOneFolder) {
  ReceiverCalibrationSources folder = sources();
  std::filesystem::rename(folder.truth, directory_ / "truth.csv");
  folder.truth = directory_.path();
  folder.receivers = directory_.path();
  folder.observations.clear();
  EXPECT_EQ(read_calibration_input(folder).readings.size(), test::disturbed_flight().readings.size());
}

TEST_F(ReceiverCalibrationFiles, AreUsedInAnIntervalOfTheCommonClock) {
  ReceiverCalibrationSources part = sources();
  part.start_s = 10.0;
  part.end_s = 20.0;
  const auto input = read_calibration_input(part);
  EXPECT_NEAR(static_cast<double>(input.readings.size()), 3 * 10 * 20, 3.0);  // 20 readings a second of each
  for (const ReceiverReading& reading : input.readings) {
    const double t_s = to_seconds(
        common_time(input.receivers[static_cast<std::size_t>(reading.receiver)].clock, reading.time) - Timestamp{});
    EXPECT_GE(t_s, 10.0);
    EXPECT_LT(t_s, 20.0);
  }
  part.start_s = 100.0;
  part.end_s.reset();
  EXPECT_THAT(refusal(part), HasSubstr("observations.csv: no reading from 100 to inf s; the cameras' span 0.0"));
}

TEST_F(ReceiverCalibrationFiles, AreRefusedInOneLine) {
  ReceiverCalibrationSources none = sources();
  none.receivers = directory_ / "nowhere.yaml";
  EXPECT_THAT(refusal(none), StartsWith("nowhere.yaml: "));
  none = sources();
  none.observations = directory_ / "nowhere.csv";
  EXPECT_THAT(refusal(none), StartsWith("nowhere.csv: "));
  none = sources();
  none.truth = directory_ / "nowhere.csv";
  EXPECT_THAT(refusal(none), StartsWith("nowhere.csv: "));
  none = sources();
  none.observations.clear();
  EXPECT_THAT(refusal(none), StartsWith("receivers.yaml: no observations are given; name a CSV"));
}

TEST_F(ReceiverCalibrationFiles, RefuseAPathThatIsNoneOrElsewhen) {
  const auto refused = [&](const char* text) {
    ReceiverCalibrationSources other = sources();
    other.truth = directory_.write("other.csv", text);
    return refusal(other);
  };
  EXPECT_EQ(
      refused("t_s,x_m,y_m,z_m\n0,1,2,3\n1,1,2,3\n"),
      "other.csv: holds 2 positions, wanted are 4 or more; give the target's path while the receivers watched it");
  EXPECT_THAT(refused("t_s,x_m,y_m,z_m\n0,1,2,3\n1,1,2,3\n1,1,2,3\n2,1,2,3\n"),
              StartsWith("other.csv: two positions at 1.000 s; "));
  EXPECT_THAT(refused("t_s,x_m,y_m,z_m\n100,1,2,3\n101,1,2,3\n102,1,2,3\n103,1,2,3\n"),
              StartsWith("other.csv: spans 100.000 to 103.000 s, the observations 0."));
  EXPECT_THAT(refused("t_s,x_m,y_m,z_m\n0,1,2,3\n1,1,nan,3\n"), StartsWith("other.csv:3: column 'y_m'"));
}

TEST_F(ReceiverCalibrationFiles, AreRefusedWithoutCamerasAndOfOneCameraWithoutAPath) {
  auto flight = test::disturbed_flight();
  std::erase_if(flight.readings, [](const auto& reading) { return reading.receiver != 1; });
  write(flight.receivers, flight.readings);
  EXPECT_EQ(read_calibration_input(sources()).cameras().size(), 3u);
  ReceiverCalibrationSources alone = sources();
  alone.truth.clear();
  EXPECT_THAT(refusal(alone), StartsWith("observations.csv: holds readings of one camera; without --truth two"));
  for (Receiver& receiver : flight.receivers) receiver.camera.reset();
  write(flight.receivers, {});
  EXPECT_THAT(refusal(sources()), StartsWith("receivers.yaml: holds direction finders alone; only cameras can be "));
}

TEST_F(ReceiverCalibrationFiles, AreRefusedOfSeveralTargets) {
  auto flight = test::disturbed_flight();
  for (std::size_t i = 0; i < flight.readings.size(); ++i) flight.readings[i].target = i % 2 ? 3 : 4;
  write(flight.receivers, flight.readings);
  EXPECT_EQ(refusal(sources()), "observations.csv: holds 2 targets; a calibration goes by one; keep its rows alone");
}

}  // namespace
}  // namespace alidade
