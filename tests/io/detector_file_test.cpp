// SPDX-License-Identifier: Apache-2.0
#include "io/detector_file.h"

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

const Camera kCamera{640, 480, 517.3, 516.5, 318.6, 255.3, BrownConrady{0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};

class DetectorFile : public testing::Test {
 protected:
  std::string message(const std::string& text) {
    return test::message_of(folder_.path(), [&] { read_detector_rig(folder_.write("rig.yaml", text)); });
  }
  test::TemporaryDirectory folder_;
};

const std::string kStations =
    "stations:\n"
    "  - name: north\n"
    "    T_world_station: {translation_m: [2, 0, 1.5], quaternion_wxyz: [1, 0, 0, 0]}\n";

std::string one_detector(const std::string& rest) {
  return kStations + "detectors:\n  - id: 0\n    station: north\n" + rest;
}

DetectorRig rig_of_all_models() {
  const SweepTerms terms{0.0178680419921875, -0.1 / 3, 0.0044, 0.0169, 1.705, 0.3, 1e-17};
  const LineModel models[] = {FocalLine{},
                              LineCamera{2048, 1500.1, 1023.5, -0.12, 0.03, -0.004},
                              Lighthouse1{1, terms},
                              Lighthouse2{0, terms},
                              Lighthouse2Full{1, terms},
                              PixelAxis{kCamera, 1}};
  DetectorRig rig;
  for (const LineModel& model : models) {
    LineDetector detector;
    detector.id = 7 * static_cast<int>(rig.detectors.size());
    detector.station = rig.detectors.size() < 3 ? "north \"1\"" : "2";
    detector.model = model;
    detector.sigma = 1.0 / 3.0;
    const double turn = rig.detectors.size() < 3 ? 0.4 : -1.9;
    detector.T_world_station.linear() = exp_so3({turn, 0.3, -0.2});
    detector.T_world_station.translation() = Eigen::Vector3d(turn, 1.0 / 7, -2);
    rig.detectors.push_back(detector);
  }
  rig.detectors[1].T_station_detector.linear() = exp_so3({0, 0, 0.8});
  rig.station_covariance["2"] = Matrix6d::Identity() / 3 + 0.1 * Matrix6d::Ones();
  return rig;
}

TEST_F(DetectorFile, GivesBackWhatWasWritten) {
  const DetectorRig rig = rig_of_all_models();
  write_detector_rig(folder_ / "rig.yaml", rig);
  const DetectorRig back = read_detector_rig(folder_ / "rig.yaml");
  ASSERT_EQ(back.detectors.size(), rig.detectors.size());
  for (std::size_t i = 0; i < rig.detectors.size(); ++i) {
    const LineDetector &a = rig.detectors[i], &b = back.detectors[i];
    EXPECT_EQ(b.id, a.id);
    EXPECT_EQ(b.station, a.station);
    EXPECT_EQ(b.model, a.model) << i;
    EXPECT_EQ(b.sigma, a.sigma);
    EXPECT_TRUE(b.T_world_station.isApprox(a.T_world_station, 1e-15));
    EXPECT_TRUE(b.T_station_detector.isApprox(a.T_station_detector, 1e-15));
  }
  EXPECT_EQ(back.station_covariance, rig.station_covariance);
}

TEST_F(DetectorFile, LeavesOutWhatHasADefault) {
  const auto rig = read_detector_rig(folder_.write("rig.yaml", one_detector("    model: lighthouse2\n    sweep: 1\n")));
  EXPECT_EQ(rig.detectors.at(0).model, LineModel(Lighthouse2{1, {}}));
  EXPECT_EQ(rig.detectors[0].sigma, 1e-4);
  EXPECT_EQ(centre_world(rig.detectors[0]), Eigen::Vector3d(2, 0, 1.5));
  EXPECT_TRUE(rig.station_covariance.empty());
  const std::string camera = "{model: pinhole, resolution_px: [640, 480], intrinsics_px: {fx: 5, fy: 5, cx: 3, cy: 2}}";
  const auto pixel = read_detector_rig(
      folder_.write("rig.yaml", one_detector("    model: pixel\n    axis: y\n    camera: " + camera + "\n")));
  EXPECT_EQ(pixel.detectors.at(0).model, LineModel(PixelAxis{{640, 480, 5, 5, 3, 2, {}}, 1}));
  EXPECT_EQ(pixel.detectors[0].sigma, 0.5);
}

TEST_F(DetectorFile, NamesWhatIsWrongWithADetector) {
  EXPECT_EQ(message(one_detector("    model: lighthouse3\n")),
            "rig.yaml:7: unknown detector model 'lighthouse3'; did you mean 'lighthouse1'?");
  EXPECT_EQ(message(one_detector("    model: focal_line\n    swep: 1\n")),
            "rig.yaml:8: unknown key 'swep'; known are: id, station, model, T_station_detector, sigma_rad");
  EXPECT_EQ(message(one_detector("    model: lighthouse1\n    swep: 1\n")),
            "rig.yaml:8: unknown key 'swep'; did you mean 'sweep'?");
  EXPECT_EQ(message(one_detector("    model: lighthouse1\n")), "rig.yaml:5: the detector has no 'sweep'");
  EXPECT_EQ(message(one_detector("    model: lighthouse1\n    sweep: 2\n")),
            "rig.yaml:5: detector 0: sweep must be 0 or 1, got 2; correct the file");
  EXPECT_EQ(message(one_detector("    model: lighthouse1\n    sweep: 0\n    terms: {phas: 1}\n")),
            "rig.yaml:9: unknown key 'phas'; did you mean 'phase'?");
  EXPECT_EQ(message(one_detector("    model: focal_line\n    sigma_rad: -1\n")),
            "rig.yaml:5: detector 0: sigma must be > 0 rad, got -1; correct the file");
  EXPECT_EQ(message(one_detector("    model: focal_line\n    sigma_rad: .nan\n")),
            "rig.yaml:8: '.nan' is not a number");
  EXPECT_EQ(message(one_detector("    model: line_camera\n    width_px: 2048\n    intrinsics_px: {f: 0, c: 1000}\n")),
            "rig.yaml:5: detector 0: f must be > 0 px, got 0; correct the file");
  EXPECT_EQ(message(kStations + "detectors:\n  - {id: 0, station: nort, model: focal_line}\n"),
            "rig.yaml:5: unknown station 'nort'; did you mean 'north'?");
  EXPECT_EQ(message(kStations + "detectors:\n  - &a {id: 0, station: north, model: focal_line}\n  - *a\n"),
            "rig.yaml:5: two detectors have the id 0");
  EXPECT_EQ(message(one_detector("    model: pixel\n    axis: z\n    camera: {}\n")),
            "rig.yaml:8: unknown axis 'z'; did you mean 'x'?");
}

TEST_F(DetectorFile, NamesWhatIsWrongWithAStation) {
  const std::string detectors = "detectors:\n  - {id: 0, station: north, model: focal_line}\n";
  const auto station = [&](const std::string& pose) {
    return "stations:\n  - name: north\n    T_world_station: " + pose + "\n" + detectors;
  };
  EXPECT_EQ(message(station("{translation_m: [2, 0, 1.5], quaternion_wxyz: [1, 0, 0, 1]}")),
            "rig.yaml:3: the quaternion's length must be 1, got 1.41421; its order is w, x, y, z");
  EXPECT_EQ(message(station("{translation_m: [2, 0], quaternion_wxyz: [1, 0, 0, 0]}")),
            "rig.yaml:3: a list of 3 numbers is wanted here; e.g. [0, 0, 1.5]");
  EXPECT_EQ(message(station("{translation: [2, 0, 1]}")),
            "rig.yaml:3: unknown key 'translation'; did you mean 'translation_m'?");
  EXPECT_EQ(message(kStations + "    covariance: [1, 2]\n" + detectors),
            "rig.yaml:4: a list of 21 numbers is wanted here; e.g. the upper triangle of the 6x6 matrix, row by row");
  EXPECT_EQ(message(kStations + "    covariance: [-1, 0,0,0,0,0,0, 0,0,0,0,0,0, 0,0,0,0,0,0, 0,0]\n" + detectors),
            "rig.yaml:4: the covariance is not positive semi-definite; calibrate again, or leave it out");
  EXPECT_EQ(message(detectors), "rig.yaml:1: the rig has no 'stations'");
  EXPECT_EQ(message(kStations), "rig.yaml:1: the rig has no 'detectors'");
  EXPECT_EQ(message(kStations + "detectors: []\n"), "rig.yaml:4: a list of detectors is wanted");
  EXPECT_EQ(message(""), "rig.yaml: holds no detectors; keys 'stations' and 'detectors' are wanted");
  EXPECT_EQ(message("stations: [\n"),
            "rig.yaml:2: damaged YAML: end of sequence flow not found; correct the line or write the file again");
}

TEST_F(DetectorFile, RefusesAStationOfTwoPoses) {
  DetectorRig rig = rig_of_all_models();
  rig.detectors[1].T_world_station.translation().x() += 0.01;
  EXPECT_THROW(write_detector_rig(folder_ / "rig.yaml", rig), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
