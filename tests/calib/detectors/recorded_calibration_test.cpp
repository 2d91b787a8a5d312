// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "calib/detectors/detector_calibration.h"
#include "datasets/detectors.h"
#include "geometry/alignment.h"
#include "io/body_file.h"
#include "io/reading_file.h"
#include "io/table.h"
#include "tests/support/data_directory.h"

namespace alidade {
namespace {

struct Recording {
  DetectorRig rig;
  RigidBody body;
  std::vector<LineReading> readings;
};

Recording read_recording(const std::filesystem::path& folder) {
  Recording r{read_detectors(folder), read_bodies(folder / "body.csv").front(), {}};
  const std::vector<RigidBody> bodies{r.body};
  ReadingReader reader(folder / "observations.csv", r.rig.detectors, bodies);
  while (const auto reading = reader.next()) r.readings.push_back(*reading);
  return r;
}

std::vector<LineReading> between(const std::vector<LineReading>& readings, double from_s, double to_s) {
  std::vector<LineReading> part;
  for (const LineReading& reading : readings) {
    const double t = to_seconds(reading.time.time_since_epoch());
    if (t >= from_s && t < to_s) part.push_back(reading);
  }
  return part;
}

Trajectory read_positions(const std::filesystem::path& path) {
  const Table table = read_table(path);
  Trajectory positions;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    StampedPose pose;
    pose.time = Timestamp(from_seconds(table.number(row, table.column("t_s"))));
    for (int i = 0; i < 3; ++i) {
      constexpr const char* kColumns[] = {"x_m", "y_m", "z_m"};
      pose.T_world_camera.translation()[i] = table.number(row, table.column(kColumns[i]));
    }
    positions.push_back(pose);
  }
  return positions;
}

// Mean distance after the rigid alignment, m.
double mean_error(const std::vector<Eigen::Vector3d>& found, const std::vector<Eigen::Vector3d>& truth) {
  const auto fit = align_points(found, truth, AlignmentKind::Rigid);
  double sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) sum += (*fit * found[i] - truth[i]).norm();
  return sum / static_cast<double>(found.size());
}

// The stations as logged give 0.81 of the error of the drone's own estimate; refined on the first half of the flight,
// without motion capture, they give 0.28 on the second.
TEST(RecordedCalibration, HalvesTheErrorOnTheOtherHalfOfAFlight) {
  const auto folder = test::data_directory("marker1d") / "lh1_flight02";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const Recording flight = read_recording(folder);
  DetectorCalibrationOptions options;
  options.marker_sigma_m = 3e-4;
  const auto calibrated =
      calibrate_detectors(flight.rig.detectors, flight.body, between(flight.readings, 0, 37.3), options);
  ASSERT_EQ(calibrated.outcome, CalibrationOutcome::Refined);
  options.hold_detectors = true;
  const auto other =
      calibrate_detectors(calibrated.rig.detectors, calibrated.body, between(flight.readings, 37.3, 100), options);
  std::vector<Eigen::Vector3d> found, onboard, truth;
  const Trajectory reference = read_positions(folder / "truth.csv");
  for (const StampedPose& own : read_positions(folder / "onboard.csv")) {
    const auto true_position = pose_at(reference, own.time, std::chrono::milliseconds(100));
    const auto pose = pose_at(other.motion, own.time, std::chrono::milliseconds(100));
    if (!true_position || !pose) continue;
    truth.push_back(true_position->translation());
    found.push_back(pose->translation());
    onboard.push_back(own.T_world_camera.translation());
  }
  ASSERT_GT(found.size(), 1000u);
  EXPECT_LT(mean_error(found, truth), 0.4 * mean_error(onboard, truth));
}

// Calm, violent shaking and rest, one knot (12 parameters) per 20 ms: within four sigmas (1.2 mrad) of the motion lie
// 98 % of each detector's readings.
TEST(RecordedCalibration, ExplainsADeviceThatIsShaken) {
  const auto folder = test::data_directory("marker1d") / "sv_index32";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const Recording device = read_recording(folder);
  DetectorCalibrationOptions options;
  options.density = {1000.0, 30000.0};
  options.loss_sigmas = 4.0;
  const auto calibrated = calibrate_detectors(device.rig.detectors, device.body, device.readings, options);
  ASSERT_EQ(calibrated.outcome, CalibrationOutcome::Refined);
  for (const auto& [id, s] : calibrated.by_detector) {
    EXPECT_GT(s.inlier_count, 0.98 * s.count) << id;
    EXPECT_LT(s.median_sigmas * 3e-4, 1.2e-4) << id;
  }
}

}  // namespace
}  // namespace alidade
