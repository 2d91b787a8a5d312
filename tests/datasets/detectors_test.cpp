// SPDX-License-Identifier: Apache-2.0
#include "datasets/detectors.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "geometry/pose.h"
#include "geometry/rotation.h"
#include "io/body_file.h"
#include "io/detector_file.h"
#include "io/reading_file.h"
#include "io/table.h"
#include "tests/support/data_directory.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

const LineDetector& detector_with(const DetectorRig& rig, int id) {
  return *std::find_if(rig.detectors.begin(), rig.detectors.end(), [&](const auto& d) { return d.id == id; });
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

SweepTerms& terms_of(LineModel& model) {
  if (auto* first = std::get_if<Lighthouse1>(&model)) return first->terms;
  return std::get<Lighthouse2>(model).terms;
}

// The drone's own model, with which it corrected its angles, knows neither curve nor ogee.
LineModel model_of_drone(const LineModel& model) {
  if (const auto* full = std::get_if<Lighthouse2Full>(&model)) return Lighthouse2{full->sweep, full->terms};
  return model;
}

// The planes of the two corrected angles of a marker meet in its direction, which has to be read at the raw angles.
class RawAngles : public testing::TestWithParam<const char*> {};

TEST_P(RawAngles, FollowFromCorrectedOnes) {
  const auto folder = test::data_directory("marker1d") / GetParam();
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const DetectorRig rig = read_detectors(folder);
  const Table table = read_table(folder / "observations.csv");
  const auto raw = table.column("angle_raw_rad"), corrected = table.column("angle_corrected_rad");
  const auto detector_column = table.column("detector"), marker = table.column("marker"), cycle = table.column("cycle");
  std::vector<double> errors;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const LineDetector& first = detector_with(rig, static_cast<int>(table.integer(row, detector_column)));
    if (first.id % 2 != 0) continue;
    for (std::size_t other = row - std::min<std::size_t>(row, 20); other < row + 20 && other < table.row_count();
         ++other) {
      const bool same_pair = table.integer(other, detector_column) == first.id + 1 &&
                             table.integer(other, marker) == table.integer(row, marker) &&
                             table.integer(other, cycle) == table.integer(row, cycle);
      if (!same_pair) continue;
      const LineDetector& second = detector_with(rig, first.id + 1);
      const LineModel model[] = {model_of_drone(first.model), model_of_drone(second.model)};
      LineModel ideal[] = {model[0], model[1]};
      for (LineModel& m : ideal) terms_of(m) = {};
      const auto normal = [&](const LineModel& m, double angle) {
        return plane_of(LineDetector{0, "", m}, angle)->normal;
      };
      Eigen::Vector3d direction =
          normal(ideal[0], table.number(row, corrected)).cross(normal(ideal[1], table.number(other, corrected)));
      if (direction.x() < 0) direction = -direction;
      errors.push_back(std::abs(project(model[0], direction)->value - table.number(row, raw)));
      errors.push_back(std::abs(project(model[1], direction)->value - table.number(other, raw)));
    }
  }
  ASSERT_GT(errors.size(), 5000u);
  EXPECT_LT(median(errors), 4e-8);  // both angles are rounded to 1e-7
}

INSTANTIATE_TEST_SUITE_P(Marker1d, RawAngles, testing::Values("lh1_flight02", "lh2_flight01"));

// Gauss-Newton on one pose for all readings.
std::vector<double> residuals_of_one_pose(const DetectorRig& rig, const RigidBody& body,
                                          const std::vector<LineReading>& readings, Eigen::Isometry3d T) {
  std::vector<double> residuals;
  for (int iteration = 0; iteration < 50; ++iteration) {
    Matrix6d H = Matrix6d::Zero();
    Vector6d b = Vector6d::Zero();
    residuals.clear();
    for (const LineReading& reading : readings) {
      const auto m = std::find_if(body.markers.begin(), body.markers.end(),
                                  [&](const auto& marker) { return marker.id == reading.marker; });
      const LineDetector& detector = detector_with(rig, reading.detector);
      const auto projection = project(detector, Eigen::Vector3d(T * m->p_body));
      if (!projection) continue;
      const double r = residual(detector.model, reading.value, projection->value);
      const double scale = iteration < 20 ? 1e-1 : 3e-4;  // Cauchy
      const double w = 1.0 / (1.0 + r * r / (scale * scale));
      Eigen::Matrix<double, 1, 6> J;
      J << projection->J_value_point * T.linear(), -projection->J_value_point * T.linear() * skew(m->p_body);
      H += w * J.transpose() * J;
      b += w * J.transpose() * r;
      residuals.push_back(std::abs(r));
    }
    T = T * perturbation(H.ldlt().solve(b));
  }
  return residuals;
}

TEST(FullModel, FitsADeviceAtRestToTheFiguresOfItsReadme) {
  const auto folder = test::data_directory("marker1d") / "sv_index32";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const DetectorRig rig = read_detectors(folder);
  const auto bodies = read_bodies(folder / "body.csv");
  ReadingReader reader(folder / "observations.csv", rig.detectors, bodies);
  std::vector<LineReading> readings;
  while (const auto reading = reader.next()) {
    const double t = to_seconds(reading->time.time_since_epoch());
    if (t >= 23.0 && t < 23.1) readings.push_back(*reading);
  }
  ASSERT_EQ(readings.size(), 386u);
  double best = 1.0;
  for (int start = 0; start < 8; ++start) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = exp_so3({start * 0.8, 0.3 * start, 0});
    T.translation() = Eigen::Vector3d(0.07, 0.35, 0.6);
    const auto residuals = residuals_of_one_pose(rig, bodies.front(), readings, T);
    if (residuals.size() > 380) best = std::min(best, median(residuals));
  }
  EXPECT_NEAR(best, 0.080e-3, 0.004e-3);
}

class LaserSweepRig : public testing::Test {
 protected:
  std::string message(const std::string& text) {
    return test::message_of(folder_.path(), [&] { read_detectors(folder_.write("detectors.json", text)); });
  }
  test::TemporaryDirectory folder_;
};

const std::string kPose = R"("pose_logged": {"origin": [1, 2, 3], "rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]})";
const std::string kTerms = R"("factory_calibration": {"phase": 0.1, "tilt": 0.2, "curve": 0.3, "gibmag": 0.4,
  "gibphase": 0.5})";

std::string detector_text(int id, const std::string& kind, const std::string& rest) {
  return fmt::format("{{\"id\": {}, \"station\": {}, \"sweep\": {},\n\"kind\": \"{}\",\n{}}}", id, id / 2, id % 2, kind,
                     rest);
}

std::string file_text(const std::string& system, const std::string& detectors) {
  return "{\n\"system\": \"" + system + "\",\n\"detectors\": [\n" + detectors + "]}\n";
}

TEST_F(LaserSweepRig, TellsTheModelFromTheSystem) {
  const std::string rest = kPose + ",\n" + kTerms;
  const auto first =
      read_detectors(folder_.write("detectors.json", file_text("Lighthouse 1", detector_text(3, "focal-line", rest))));
  EXPECT_EQ(first.detectors.at(0).model, LineModel(Lighthouse1{1, {0.1, 0.2, 0.3, 0.4, 0.5}}));
  EXPECT_EQ(first.detectors[0].station, "1");
  EXPECT_EQ(centre_world(first.detectors[0]), Eigen::Vector3d(1, 2, 3));
  const Eigen::Vector3d forward = first.detectors[0].T_world_station.linear().col(0);
  EXPECT_LT((forward - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  const auto second = read_detectors(
      folder_.write("detectors.json", file_text("Lighthouse 2", detector_text(4, "tilted-plane", rest))));
  EXPECT_EQ(second.detectors.at(0).model.index(), LineModel(Lighthouse2Full{}).index());
  // its station's x looks forward: a point to the left (y) of that is read at a positive angle, as the drone has it
  LineDetector bare = second.detectors.at(0);
  bare.T_world_station = Eigen::Isometry3d::Identity();
  bare.model = Lighthouse2Full{};
  const Eigen::Vector3d p(2.0, 0.5, -0.3);
  EXPECT_NEAR(project(bare, p)->value, project(Lighthouse2{}, p)->value, 1e-12);
  const std::string ogee = R"("factory_calibration": {"phase": 0, "tilt": 0, "curve": 0, "gibmag": 0, "gibphase": 0,
    "ogeemag": 0.6, "ogeephase": 0.7})";
  const auto full =
      read_detectors(folder_.write("detectors.json", "{\"device\": \"T20\", \"detectors\": [" +
                                                         detector_text(4, "tilted-plane", kPose + "," + ogee) + "]}"));
  EXPECT_EQ(full.detectors.at(0).model, LineModel(Lighthouse2Full{0, {0, 0, 0, 0, 0, 0.6, 0.7}}));
}

TEST_F(LaserSweepRig, IsFoundInAFolderAndReadAlikeAsYaml) {
  folder_.write("detectors.json", file_text("Lighthouse 1", detector_text(2, "focal-line", kPose + "," + kTerms)));
  const DetectorRig rig = read_detectors(folder_.path());
  write_detector_rig(folder_ / "detectors.yaml", rig);
  const DetectorRig back = read_detectors(folder_.path());
  EXPECT_EQ(back.detectors.at(0).model, rig.detectors.at(0).model);
  test::TemporaryDirectory empty;
  EXPECT_EQ(test::message_of(empty.path().parent_path(), [&] { read_detectors(empty.path()); }),
            empty.path().filename().string() + ": holds neither detectors.yaml nor detectors.json; name the file");
}

TEST_F(LaserSweepRig, NamesWhatIsWrong) {
  const std::string rest = kPose + ",\n" + kTerms;
  EXPECT_EQ(
      message("{\"detectors\": []}"),
      "detectors.json: says neither 'system' nor 'device'; write \"system\": \"Lighthouse 1\" or \"Lighthouse 2\"");
  EXPECT_EQ(message(file_text("Lighthouse 3", "")),
            "detectors.json:2: unknown system 'Lighthouse 3'; did you mean 'Lighthouse 1'?");
  EXPECT_EQ(message(file_text("Lighthouse 1", "")), "detectors.json:3: a list of detectors is wanted");
  EXPECT_EQ(message(file_text("Lighthouse 1", detector_text(0, "tilted-plane", rest))),
            "detectors.json:5: the kind 'tilted-plane' is not this system's; 'focal-line' is wanted");
  EXPECT_EQ(message(file_text("Lighthouse 1", detector_text(0, "focal-line", kPose))),
            "detectors.json:4: the detector has no 'factory_calibration'");
  EXPECT_EQ(message(file_text("Lighthouse 1", detector_text(0, "focal-line",
                                                            rest + ",\"focal_line\": {\"point\": [1, 2, 3],\n"
                                                                   "\"direction\": [1, 0, 0]}"))),
            "detectors.json:9: the focal line is not the axis of this sweep; that is the station's z axis for sweep 0, "
            "its y axis for sweep 1");
  const std::string skewed = R"("pose_logged": {"origin": [1, 2, 3], "rotation": [[1, 1, 0], [0, 1, 0], [0, 0, 1]]})";
  EXPECT_EQ(message(file_text("Lighthouse 1", detector_text(0, "focal-line", skewed))),
            "detectors.json:4: the detector has no 'factory_calibration'");
  EXPECT_EQ(message(file_text("Lighthouse 1", detector_text(0, "focal-line", skewed + ",\n" + kTerms))),
            "detectors.json:6: is not a rotation; its columns are the station's axes in the world");
  EXPECT_EQ(message(file_text("Lighthouse 1",
                              detector_text(0, "focal-line", rest) + ",\n" + detector_text(0, "focal-line", rest))),
            "detectors.json:9: two detectors have the id 0");
  const std::string elsewhere =
      R"("pose_logged": {"origin": [1, 2, 4], "rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]})";
  EXPECT_EQ(message(file_text("Lighthouse 1", detector_text(0, "focal-line", rest) + ",\n" +
                                                  detector_text(1, "focal-line", elsewhere + "," + kTerms))),
            "detectors.json:9: station 0 has two poses; its detectors stand rigidly together: give them the same");
}

}  // namespace
}  // namespace alidade
