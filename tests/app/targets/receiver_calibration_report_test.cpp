// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_report.h"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "app/targets/receiver_calibration_summary.h"
#include "io/receiver_file.h"
#include "io/trajectory_file.h"
#include "tests/app/targets/disturbed_flight.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

ReceiverCalibrationRun written(ReceiverCalibrationRun run, const fs::path& out) {
  ResultDirectory directory(out, "calibrate receivers");
  write_calibration(run, directory, {"alidade", "calibrate", "receivers"}, "time_receiver: \"\"\n");
  directory.commit(summary_of(run));
  return run;
}

TEST(ReceiverCalibrationReport, LeavesReceiversWithCovariancesAndAPage) {
  const test::TemporaryDirectory directory;
  const auto run = written(calibrate_receivers(test::disturbed_flight(), {}, {}), directory / "out");
  const auto receivers = read_receivers(directory / "out/receivers.yaml");
  ASSERT_EQ(receivers.size(), 3u);
  EXPECT_TRUE(receivers[1].T_world_receiver.isApprox(run.receivers[1].found.T_world_receiver, 1e-9));
  ASSERT_TRUE(receivers[1].pose_covariance);
  EXPECT_GT(receivers[1].clock.covariance(0, 0), 0.0);
  const std::string page = text_of(directory / "out/report.html");
  EXPECT_THAT(page, testing::HasSubstr("Residuals about the path"));
  EXPECT_THAT(page, testing::HasSubstr("<h2>cam2</h2>"));
  EXPECT_TRUE(fs::exists(directory / "out/options.yaml"));
  EXPECT_FALSE(fs::exists(directory / "out/trajectory.tum"));
}

TEST(ReceiverCalibrationReport, LeavesThePathThatWasFound) {
  ReceiverCalibrationRun run;
  run.receivers.resize(1);
  run.receivers[0].given.camera = run.receivers[0].found.camera = Camera{640, 480, 500, 500, 319.5, 239.5, {}, 0.0};
  run.path = {{Timestamp(from_seconds(1.0)), {1, 2, 3}}, {Timestamp(from_seconds(1.1)), {2, 2, 3}}};
  const test::TemporaryDirectory directory;
  written(run, directory / "out");
  const auto path = read_trajectory(directory / "out/trajectory.tum").poses;
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[1].T_world_camera.translation(), Eigen::Vector3d(2, 2, 3));
}

}  // namespace
}  // namespace alidade
