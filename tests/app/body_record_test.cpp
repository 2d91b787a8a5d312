// SPDX-License-Identifier: Apache-2.0
#include "app/body_record.h"

#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/body_picture.h"
#include "app/body_report.h"
#include "geometry/rotation.h"
#include "io/text_lines.h"
#include "io/trajectory_file.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

const RigidBody kProbe{"probe", {{1, {0.1, 0, 0}}, {2, {0, 0.1, 0}}}};
const RigidBody kWing{"left wing", {{3, {0, 0, 0}}}};

std::vector<LineDetector> two_detectors() {
  LineDetector side{1, "north", FocalLine{}};
  side.T_world_station.translation().x() = 0.5;
  return {{0, "north", FocalLine{}}, side};
}

// At 2 m, moving along x; batch i is at 4 i ms.
BodyEstimate tracked_at(int i) {
  BodyEstimate estimate;
  estimate.time = Timestamp(i * 4ms);
  estimate.status = BodyStatus::Tracked;
  estimate.state.time = estimate.time;
  estimate.state.T_world_body.translation() = Eigen::Vector3d(0.001 * i, 0.25, 2);
  estimate.state.T_world_body.linear() = exp_so3({0, 0, 0.01 * i});
  estimate.state.covariance = 4e-6 * Matrix18d::Identity();
  estimate.determined = 6;
  return estimate;
}

BodyEstimate lost_at(int i) {
  BodyEstimate estimate;
  estimate.time = Timestamp(i * 4ms);
  return estimate;
}

BodyEstimate ambiguous_at(int i) {
  BodyEstimate estimate = tracked_at(i);
  estimate.status = BodyStatus::Ambiguous;
  estimate.candidates = {estimate.state, tracked_at(i + 100).state};
  return estimate;
}

// All readings of the body by both detectors, exact; the estimate explains all but the last.
std::vector<LineReading> read(const RigidBody& body, BodyEstimate& estimate) {
  std::vector<LineReading> readings;
  for (const LineDetector& d : two_detectors()) {
    for (const BodyMarker& m : body.markers) {
      const double value = project(d, estimate.state.T_world_body * m.p_body)->value;
      readings.push_back({estimate.time, d.id, m.id, value, 0.0});
    }
  }
  estimate.is_inlier.assign(readings.size(), true);
  estimate.is_inlier.back() = false;
  estimate.inlier_count = static_cast<int>(readings.size()) - 1;
  return readings;
}

void put(BodyRecord& record, std::size_t body, BodyEstimate estimate) {
  std::vector<LineReading> readings;
  if (estimate.status == BodyStatus::Tracked) readings = read(body == 0 ? kProbe : kWing, estimate);
  estimate.is_inlier.resize(readings.size());
  record.observe(body, estimate, readings);
  record.add(body, estimate);
}

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

TEST(BodyRecord, WritesTrackedAmbiguousAndLostBatches) {
  const test::TemporaryDirectory folder;
  ResultDirectory directory(folder / "out", "track body");
  BodyRecord record(directory, two_detectors(), {kProbe});
  put(record, 0, lost_at(0));
  put(record, 0, ambiguous_at(1));
  put(record, 0, tracked_at(2));
  record.commit();
  directory.commit(nlohmann::json::object());

  const auto poses = lines_of(folder / "out/poses.csv");
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_EQ(poses[0],
            "t_ns,body,status,x_m,y_m,z_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,sigma_x_m,"
            "sigma_y_m,sigma_z_m,sigma_rx_rad,sigma_ry_rad,sigma_rz_rad,determined,readings,inliers,chi2");
  EXPECT_EQ(poses[1], "0,probe,lost,,,,,,,,,,,,,,,,,,,,0,0,0,0");
  EXPECT_TRUE(poses[2].starts_with("4000000,probe,ambiguous,0.001,0.25,2,"));
  EXPECT_TRUE(poses[3].starts_with("8000000,probe,tracked,0.002,0.25,2,"));
  EXPECT_TRUE(poses[3].ends_with(",0.002,0.002,0.002,0.002,0.002,0.002,6,4,3,0"));
  const auto candidates = lines_of(folder / "out/candidates.csv");
  ASSERT_EQ(candidates.size(), 3u);
  EXPECT_TRUE(candidates[1].starts_with("4000000,probe,0,0.001,0.25,2,"));
  EXPECT_TRUE(candidates[2].starts_with("4000000,probe,1,0.101,0.25,2,"));
  const Trajectory trajectory = read_trajectory(folder / "out/trajectory.tum").poses;
  ASSERT_EQ(trajectory.size(), 1u);
  EXPECT_EQ(*read_covariances(folder / "out/covariance.csv", trajectory)[0].covariance, 4e-6 * Matrix6d::Identity());
  const auto markers = lines_of(folder / "out/markers.trc");
  ASSERT_EQ(markers.size(), 9u);
  EXPECT_EQ(markers[6], "1\t0.000000000\t\t\t\t\t\t");
  EXPECT_TRUE(markers[8].starts_with("3\t0.008000000\t0.10"));
}

TEST(BodyRecord, CountsResidualsOfTrackedBatchesOnly) {
  const test::TemporaryDirectory folder;
  const ResultDirectory directory(folder / "out", "track body");
  BodyRecord record(directory, two_detectors(), {kProbe});
  for (int i = 0; i < 10; ++i) put(record, 0, i < 3 ? lost_at(i) : tracked_at(i));
  const BodyRun run = record.commit();
  EXPECT_EQ(run.batches, 10);
  EXPECT_EQ(run.tallies[0].lost, 3);
  EXPECT_EQ(run.tallies[0].tracked, 7);
  EXPECT_EQ(run.tallies[0].readings, 28);
  EXPECT_EQ(run.tallies[0].explained, 21);
  ASSERT_EQ(run.residuals.size(), 4u);
  EXPECT_EQ(run.residuals[0].inliers, 14);
  EXPECT_EQ(run.residuals[1].inliers, 7);
  EXPECT_NEAR(run.residuals[0].rms, 0.0, 1e-12);
  EXPECT_EQ(run.tallies[0].fullest->readings.size(), 3u);
  const nlohmann::json summary = summary_of(run);
  EXPECT_EQ(summary["batches"], 10);
  EXPECT_DOUBLE_EQ(summary["batch_rate_hz"], 250.0);
  EXPECT_EQ(summary["bodies"][0]["tracked"], 7);
  EXPECT_DOUBLE_EQ(summary["bodies"][0]["readings_explained"], 0.75);
  EXPECT_NEAR(summary["bodies"][0]["mean_sigma_position_m"].get<double>(), 2e-3 * std::sqrt(3.0), 1e-12);
}

TEST(BodyRecord, GivesEachOfSeveralBodiesItsFilesAndAllMarkersOneClock) {
  const test::TemporaryDirectory folder;
  ResultDirectory directory(folder / "out", "track body");
  BodyRecord record(directory, two_detectors(), {kProbe, kWing});
  for (int i = 0; i < 3; ++i) put(record, 0, tracked_at(i));  // the wing's estimates settle later
  for (int i = 0; i < 3; ++i) put(record, 1, i == 1 ? lost_at(i) : tracked_at(i));
  const BodyRun run = record.commit();
  directory.commit(nlohmann::json::object());
  EXPECT_EQ(read_trajectory(folder / "out/probe.tum").poses.size(), 3u);
  EXPECT_EQ(read_trajectory(folder / "out/left_wing.tum").poses.size(), 2u);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/left_wing.covariance.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/candidates.csv"));
  const auto markers = lines_of(folder / "out/markers.trc");
  ASSERT_EQ(markers.size(), 9u);
  EXPECT_EQ(markers[3], "Frame#\tTime\tprobe_1\t\t\tprobe_2\t\t\tleft_wing_3\t\t");
  EXPECT_TRUE(markers[7].ends_with("\t\t\t"));
  EXPECT_TRUE(markers[8].ends_with("\t0.002000\t2.000000\t-0.250000"));
}

TEST(BodyRecord, LeavesBlankWhatTheMethodDoesNotTell) {
  const test::TemporaryDirectory folder;
  ResultDirectory directory(folder / "out", "track body");
  BodyRecord record(directory, two_detectors(), {kProbe}, PoseDetail::Pose);
  put(record, 0, tracked_at(0));
  const BodyRun run = record.commit();
  directory.commit(nlohmann::json::object());
  EXPECT_EQ(lines_of(folder / "out/poses.csv").at(1), "0,probe,tracked,0,0.25,2,1,0,0,0,,,,,,,,,,,,,6,4,3,0");
  EXPECT_EQ(lines_of(folder / "out/covariance.csv").size(), 2u);  // head alone
  EXPECT_FALSE(summary_of(run)["bodies"][0].contains("mean_sigma_position_m"));
  EXPECT_EQ(plots_of(run, 0).size(), 3u);
}

TEST(BodyRecord, RefusesABatchThatWasNotObserved) {
  const test::TemporaryDirectory folder;
  const ResultDirectory directory(folder / "out", "track body");
  BodyRecord record(directory, two_detectors(), {kProbe});
  EXPECT_THROW(record.add(0, tracked_at(0)), std::invalid_argument);
  record.observe(0, lost_at(0), {});
  EXPECT_THROW(record.add(0, lost_at(1)), std::invalid_argument);
  EXPECT_THROW(BodyRecord(directory, two_detectors(), {}), std::invalid_argument);
}

TEST(BodyRecord, KeepsFewSamplesOfALongRecording) {
  const test::TemporaryDirectory folder;
  const ResultDirectory directory(folder / "out", "track body");
  BodyRecord record(directory, two_detectors(), {kProbe});
  for (int i = 0; i < 9000; ++i) put(record, 0, lost_at(i));
  EXPECT_LE(record.run().tallies[0].samples.values().size(), BodyTally::kMostSamples);
}

BodyRun run_with_a_gap() {
  const test::TemporaryDirectory folder;
  const ResultDirectory directory(folder / "out", "track body");
  BodyRecord record(directory, two_detectors(), {kProbe});
  for (int i = 0; i < 700; ++i) put(record, 0, i / 10 == 5 ? lost_at(i) : tracked_at(i));
  return record.commit();
}

TEST(BodyPlots, HaveGapsWhereTheBodyIsLostAndNoJumpsAtHalfATurn) {
  const auto plots = plots_of(run_with_a_gap(), 0);
  ASSERT_EQ(plots.size(), 5u);
  const Series& x = plots[0].series[0];
  EXPECT_TRUE(std::isnan(x.y[55]));
  EXPECT_NEAR(x.y[60], 0.06, 1e-12);
  EXPECT_NEAR(x.x[60], 0.24, 1e-12);
  const Series& turn = plots[1].series[2];  // 0.01 rad per batch, beyond half a turn
  EXPECT_NEAR(turn.y[699], 6.99 * 180.0 / 3.14159265358979, 1e-6);
  EXPECT_NEAR(plots[4].series[0].y[60], 0.75, 1e-12);
}

TEST(BodyScene, ShowsDetectorsMarkersPathAndCovarianceWithUpUp) {
  const Scene scene = scene_of(run_with_a_gap());
  EXPECT_EQ(scene.cameras.size(), 2u);
  ASSERT_EQ(scene.labels.size(), 1u);
  EXPECT_EQ(scene.labels[0].text, "north");
  EXPECT_EQ(scene.points.size(), 2u);
  EXPECT_EQ(scene.paths.size(), 1u + 3u);         // path, lines of sight
  EXPECT_EQ(scene.translucent.size(), 28u + 2u);  // ellipsoids, planes of the first marker
  EXPECT_TRUE(scene.up_world.isApprox(Eigen::Vector3d::UnitZ()));
  for (const auto& surface : scene.translucent) {
    for (const auto& vertex : surface.vertices_world) EXPECT_TRUE(vertex.allFinite());
  }
}

TEST(BodyScene, CopesWithABodyThatWasNeverTracked) {
  const test::TemporaryDirectory folder;
  const ResultDirectory directory(folder / "out", "track body");
  BodyRecord record(directory, two_detectors(), {kProbe});
  put(record, 0, lost_at(0));
  const BodyRun run = record.commit();
  EXPECT_TRUE(scene_of(run).points.empty());
  EXPECT_TRUE(run.warnings.empty());
}

TEST(BodyReport, IsWrittenWithPictures) {
  const test::TemporaryDirectory folder;
  ResultDirectory directory(folder / "out", "track body");
  BodyRun run = run_with_a_gap();
  run.source = "readings.csv";
  run.fault = "readings.csv:7: is cut off; complete it";
  write_body_report(run, directory, {"alidade", "track", "body"}, "lag_s: 0.5\n");
  directory.commit(summary_of(run));
  const std::string html = read_bytes(folder / "out/report.html");
  for (const char* text : {"Body track of readings.csv", "ended early: readings.csv:7", "Residuals by detector"}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "out/plots.png"));
}

}  // namespace
}  // namespace alidade
