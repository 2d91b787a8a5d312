// SPDX-License-Identifier: Apache-2.0
#include "io/camera_file.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/support/data_directory.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

constexpr ImageSize kSize{640, 480};

class CameraFile : public testing::Test {
 protected:
  Camera read(std::string_view name, std::string_view text, std::optional<ImageSize> size = std::nullopt) {
    return read_camera(folder_.write(name, text), size);
  }
  std::string message(std::string_view name, std::string_view text, std::optional<ImageSize> size = std::nullopt) {
    return test::message_of(folder_.path(), [&] { read(name, text, size); });
  }
  test::TemporaryDirectory folder_;
};

TEST_F(CameraFile, GivesBackExactlyWhatWasWritten) {
  const Camera plain{640, 480, 500.1, 501.2, 1.0 / 3.0, 239.5, {}};
  const Camera bent{
      1536, 1024, 1379.74, 1382.08, 760.095, 503.155, BrownConrady{0.1 + 0.2, -0.9531, -0.0054, 1e-17, 1.1633}};
  Camera rolling = bent;
  rolling.readout_s = 0.0173;
  for (const Camera& camera : {plain, bent, rolling}) {
    write_camera(folder_ / "c.yaml", camera, "left \\ \"front\"");
    EXPECT_EQ(read_camera(folder_ / "c.yaml"), camera);
    EXPECT_EQ(read_cameras(folder_ / "c.yaml").front().name, "left \\ \"front\"");
  }
}

TEST_F(CameraFile, ReadsAListOfCamerasAndWantsOne) {
  const std::string camera = "{model: pinhole, resolution_px: [640, 480], intrinsics_px: {fx: 500, fy: 500, cx: 3";
  const std::string text = "cameras:\n  - " + camera + "10, cy: 240}}\n  - " + camera + "20, cy: 240}}\n";
  const auto cameras = read_cameras(folder_.write("rig.yaml", text));
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[1].camera, (Camera{640, 480, 500, 500, 320, 240, {}}));
  EXPECT_EQ(
      message("rig.yaml", text),
      "rig.yaml: holds 2 cameras ('camera 0', 'camera 1', ...), one is wanted; keep only the one of these images");
}

TEST_F(CameraFile, NamesWhatIsWrongInOurYaml) {
  const auto camera = [](const std::string& rest) { return "camera:\n  model: pinhole\n" + rest; };
  const std::string size = "  resolution_px: [640, 480]\n",
                    k = "  intrinsics_px: {fx: 500, fy: 500, cx: 320, cy: 240}\n";
  EXPECT_EQ(message("c.yaml", camera("  resolution: [640, 480]\n" + k)),
            "c.yaml:3: unknown key 'resolution'; did you mean 'resolution_px'?");
  EXPECT_EQ(message("c.yaml", camera(size)), "c.yaml:2: the camera has no 'intrinsics_px'");
  EXPECT_EQ(message("c.yaml", camera(size + "  intrinsics_px:\n    fx: -3.1\n    fy: 500\n    cx: 320\n    cy: 240\n")),
            "c.yaml:5: camera 'camera 0': fx must be > 0 px, got -3.1; correct the file or calibrate the camera again");
  EXPECT_EQ(message("c.yaml", camera(size + k + "  readout_s: 17\n")),
            "c.yaml:5: camera 'camera 0': readout_s must lie in [0, 1) s, got 17; correct the file or calibrate the "
            "camera again");
  EXPECT_EQ(message("c.yaml", camera(size + "  intrinsics_px: {fx: 500, fy: wide, cx: 320, cy: 240}\n")),
            "c.yaml:4: 'wide' is not a number");
  EXPECT_EQ(message("c.yaml", camera(size + "  intrinsics_px: {fx: .nan, fy: 500, cx: 320, cy: 240}\n")),
            "c.yaml:4: '.nan' is not a number");
  EXPECT_EQ(message("c.yaml", camera("  resolution_px: 640\n" + k)),
            "c.yaml:3: resolution_px must be [width, height]; e.g. [640, 480]");
  EXPECT_EQ(
      message("c.yaml", camera("  resolution_px: [640, 0]\n" + k)),
      "c.yaml:3: camera 'camera 0': image size must be > 0 px, got 640x0; correct the file or calibrate the camera "
      "again");
  EXPECT_EQ(message("c.yaml", camera(size + k + "  distortion: {k1: 0.1}\n")),
            "c.yaml:5: model pinhole has no distortion; write model: brown_conrady");
  EXPECT_EQ(message("c.yaml", "camera:\n  model: pinhol\n"),
            "c.yaml:2: unknown camera model 'pinhol'; did you mean 'pinhole'?");
  EXPECT_EQ(message("c.yaml", "camera:\n  model: [pinhole\n  x\n"),
            "c.yaml:4: damaged YAML: end of sequence flow not found; correct the line or write the file again");
  EXPECT_EQ(message("c.yaml", "colour: red\n"),
            "c.yaml: holds no camera; a key 'camera', 'cameras', 'cam0' or 'camera_matrix' is wanted");
}

constexpr const char* kOpenCvYaml =
    "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n"
    "   dt: d\n   data: [ 5.36e+02, 0., 342., 0., 537., 235.5, 0., 0., 1. ]\n"
    "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   data: [ -0.26, -0.03, 1e-3, 2e-3, "
    ".25 ]\n";

TEST_F(CameraFile, ReadsOpenCvsYaml) {
  const Camera expected{640, 480, 536, 537, 342, 235.5, BrownConrady{-0.26, -0.03, 1e-3, 2e-3, 0.25}};
  EXPECT_EQ(read("c.yml", kOpenCvYaml), expected);
  EXPECT_EQ(read("no_extension", kOpenCvYaml), expected);
  EXPECT_EQ(read("ros.yaml",
                 "image_width: 640\nimage_height: 480\ncamera_name: left\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
                 "  data: [536, 0, 342, 0, 537, 235.5, 0, 0, 1]\ndistortion_model: plumb_bob\n"
                 "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.26, -0.03, 0.001, 0.002, 0.25]\n"),
            expected);
  EXPECT_EQ(read("python.yaml",
                 "camera_matrix: [[536, 0, 342], [0, 537, 235.5], [0, 0, 1]]\n"
                 "dist_coeff: [[-0.26, -0.03, 0.001, 0.002, 0.25]]\n",
                 kSize),
            expected);
}

TEST_F(CameraFile, NamesWhatIsWrongInOpenCvsYaml) {
  const std::string text = kOpenCvYaml;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    return changed.replace(changed.find(from), from.size(), to);
  };
  EXPECT_EQ(message("c.yml", with("5.36e+02", "-5.36e+02")),
            "c.yml:5: camera 'camera': fx must be > 0 px, got -536; correct the file or calibrate the camera again");
  EXPECT_EQ(message("c.yml", with("0., 0., 1. ]", "0. ]")),
            "c.yml:5: is no camera matrix; [fx 0 cx; 0 fy cy; 0 0 1] is wanted");
  EXPECT_EQ(message("c.yml", with("537.", "5x7")), "c.yml:9: '5x7' is not a number");
  EXPECT_EQ(message("c.yml", with(".25 ]", ".25, 0, 0, 0.7, 0.1 ]")),
            "c.yml:10: distortion with 9 coefficients is not supported; calibrate with k1 k2 p1 p2 k3 k4 k5 k6, "
            "without thin prisms and tilt");
  EXPECT_EQ(message("c.yml", text.substr(0, text.find("-0.26"))),
            "c.yml:14: damaged YAML: end of sequence flow not found; correct the line or write the file again");
  EXPECT_EQ(message("c.yml", with("image_width: 640\n", "")),
            "c.yml:4: says no image size; give it the images' width and height");
}

constexpr const char* kOpenCvXml =
    "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>640</image_width>\n<image_height>480</image_height>\n"
    "<camera_matrix type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  <cols>3</cols>\n  <dt>d</dt>\n"
    "  <data>536. 0. 342. 0. 537. 235.5 0. 0. 1.</data></camera_matrix>\n"
    "<distortion_coefficients type_id=\"opencv-matrix\">\n  <rows>5</rows>\n  <cols>1</cols>\n  <dt>d</dt>\n"
    "  <data>-0.26 -0.03 1e-3 2e-3 .25</data></distortion_coefficients>\n</opencv_storage>\n";

TEST_F(CameraFile, ReadsOpenCvsXml) {
  EXPECT_EQ(read("c.xml", kOpenCvXml),
            (Camera{640, 480, 536, 537, 342, 235.5, BrownConrady{-0.26, -0.03, 1e-3, 2e-3, 0.25}}));
}

TEST_F(CameraFile, NamesTheDamageInOpenCvsXml) {
  const std::string text = kOpenCvXml;
  for (std::size_t length = 25; length < text.size() - 1; length += 7) {
    EXPECT_THROW(read("c.xml", text.substr(0, length)), InputError) << "cut after " << length;
  }
  const auto message_cut_at = [&](const char* word) { return message("c.xml", text.substr(0, text.find(word))); };
  EXPECT_EQ(message_cut_at("235.5"),
            "c.xml:5: damaged XML: element <camera_matrix> does not end; write the file again");
  EXPECT_EQ(message_cut_at("</opencv_s"),
            "c.xml: damaged XML: the end </opencv_storage> is missing; write the file again");
  std::string wrong = text;
  EXPECT_EQ(message("c.xml", wrong.replace(wrong.find("537."), 4, "5x7.")), "c.xml:9: '5x7.' is not a number");
  EXPECT_EQ(message("c.xml", "<?xml version=\"1.0\"?>\n<opencv_storage>\n<a>1</a>\n</opencv_storage>\n"),
            "c.xml: holds no camera; an element <camera_matrix> is wanted");
}

TEST_F(CameraFile, ShiftsColmapsPixelOrigin) {
  // COLMAP counts pixels from the image's corner, so its centre (320, 240) of a 640×480 image is our (319.5, 239.5).
  const std::string head = "# Camera list with one line of data per camera:\n";
  EXPECT_EQ(read("cameras.txt", head + "1 SIMPLE_PINHOLE 640 480 500 320 240\n"),
            (Camera{640, 480, 500, 500, 319.5, 239.5, {}}));
  EXPECT_EQ(read("cameras.txt", head + "1 PINHOLE 640 480 500 510 320 240\n"),
            (Camera{640, 480, 500, 510, 319.5, 239.5, {}}));
  EXPECT_EQ(read("cameras.txt", "7 SIMPLE_RADIAL 640 480 500 320 240 0.1\n"),
            (Camera{640, 480, 500, 500, 319.5, 239.5, BrownConrady{0.1, 0, 0, 0, 0}}));
  EXPECT_EQ(read("cameras.txt", "7 RADIAL 640 480 500 320 240 0.1 0.2\n"),
            (Camera{640, 480, 500, 500, 319.5, 239.5, BrownConrady{0.1, 0.2, 0, 0, 0}}));
  EXPECT_EQ(read("cameras.txt", "7 OPENCV 640 480 500 510 320 240 0.1 0.2 0.3 0.4\n"),
            (Camera{640, 480, 500, 510, 319.5, 239.5, BrownConrady{0.1, 0.2, 0.3, 0.4, 0}}));
  EXPECT_EQ(read("cameras.txt", head + "1 OPENCV_FISHEYE 640 480 500 510 320 240 0.1 0 0 0\n"),
            (Camera{640, 480, 500, 510, 319.5, 239.5, Fisheye{0.1, 0, 0, 0}}));
  EXPECT_EQ(message("cameras.txt", head + "1 FOV 640 480 500 510 320 240 0.9\n"),
            "cameras.txt:2: COLMAP's camera model 'FOV' is not supported; supported are SIMPLE_PINHOLE, PINHOLE, "
            "SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV, OPENCV_FISHEYE");
  EXPECT_EQ(message("cameras.txt", "1 PINHOLE 640 480 500 510 320\n"),
            "cameras.txt:1: PINHOLE has 4 parameters, got 3");
}

TEST_F(CameraFile, ReadsPairsOfNamesAndValues) {
  EXPECT_EQ(
      read("camera.txt", "# colour\nfx 517 fy 516 cx 318 cy 255\nk1 0.2 k2 -0.9 p1 -0.005 p2 0.002 k3 1.1\n", kSize),
      (Camera{640, 480, 517, 516, 318, 255, BrownConrady{0.2, -0.9, -0.005, 0.002, 1.1}}));
  EXPECT_EQ(read("camera.txt", "fx 5 fy 5 cx 3 cy 2 width 8 height 6\n", kSize), (Camera{8, 6, 5, 5, 3, 2, {}}));
  EXPECT_EQ(message("camera.txt", "fx 517 fy 516 cx 318\n", kSize), "camera.txt: the camera has no 'cy'");
  EXPECT_EQ(message("camera.txt", "fx 517 fy 516\ncx 318 cy\n", kSize),
            "camera.txt:2: 'cy' has no value; pairs like 'fx 500' are wanted");
  EXPECT_EQ(message("camera.txt", "fx 517 fy 516 cx 318 cy 255\nk4 0.1\n", kSize).substr(0, 29),
            "camera.txt:2: unknown name 'k");
  EXPECT_EQ(message("camera.txt", "fx 517 fy 0 cx 318 cy 255\n", kSize),
            "camera.txt:1: camera 'camera': fy must be > 0 px, got 0; correct the file or calibrate the camera again");
  EXPECT_EQ(message("camera.txt", "fx 517 fy 516 cx 318 cy 255\n"),
            "camera.txt:1: says no image size; give it the images' width and height");
}

TEST_F(CameraFile, ReadsKittisProjectionMatrices) {
  const std::string P = "707 0 601 0 0 707 183 0 0 0 1 0\n", right = "707 0 601 -379 0 707 183 0 0 0 1 0\n";
  const Camera expected{1226, 370, 707, 707, 601, 183, {}};
  EXPECT_EQ(read("calib.txt", P + right, ImageSize{1226, 370}), expected);
  EXPECT_EQ(read("calib.txt", "P0: " + P + "P1: " + right + "Tr: 1 2 3\n", ImageSize{1226, 370}), expected);
  EXPECT_EQ(message("calib.txt", "P0: 707 0 601 0\n", ImageSize{1226, 370}),
            "calib.txt:1: has 4 numbers, a 3x4 projection matrix has 12");
}

TEST_F(CameraFile, ReadsStrechasCameras) {
  const std::string K = "1379.74 0 760.095 \n0 1382.08 503.155 \n0 0 1 \n";
  const std::string pose = "1 0 0\n0 1 0\n0 0 1\n-7 -7 0.2\n";
  EXPECT_EQ(read("0.jpg.camera", K + "0 0 0\n" + pose + "1536 1024\n"),
            (Camera{1536, 1024, 1379.74, 1382.08, 760.095, 503.155, {}}));
  EXPECT_EQ(read("K.txt", K, ImageSize{1536, 1024}), (Camera{1536, 1024, 1379.74, 1382.08, 760.095, 503.155, {}}));
  EXPECT_EQ(message("0.jpg.camera", K + "0.1 0 0\n" + pose + "1536 1024\n"),
            "0.jpg.camera:4: distortion must be 0 in a *.camera file, got 0.1; undistort the images first");
  EXPECT_EQ(message("0.jpg.camera", K + "0 0 0\n" + pose),
            "0.jpg.camera: has 8 lines, a camera matrix has 3 and Strecha's *.camera 9; the file may be cut off");
  EXPECT_EQ(message("0.jpg.camera", "1379 2.5 760\n0 1382 503\n0 0 1\n", kSize),
            "0.jpg.camera:1: the camera matrix has a skew of 2.5 px, which is not supported; calibrate without skew");
}

TEST_F(CameraFile, IsRefusedWhereItIsNone) {
  EXPECT_EQ(message("empty.yaml", "").substr(0, 43), "empty.yaml: is empty, a camera is wanted; k");
  EXPECT_EQ(message("poem.txt", "Of shoes and ships\n").substr(0, 33), "poem.txt:1: is not a camera file;");
  EXPECT_EQ(test::message_of(folder_.path(), [&] { read_camera(folder_ / "none.yaml"); }),
            "none.yaml: cannot be opened: No such file or directory; check the name");
}

TEST(RealCameraFiles, AreRead) {
  const auto data = test::data_directory("");
  if (!std::filesystem::exists(data / "fountain")) GTEST_SKIP() << data << " is not there";
  EXPECT_EQ(read_camera(data / "fountain/0000.jpg.camera"),
            (Camera{1536, 1024, 1379.74, 1382.08, 760.095, 503.155, {}}));
  EXPECT_EQ(read_camera(data / "seven-scenes/camera.txt", kSize),
            (Camera{640, 480, 518.8, 518.8, 320, 240, BrownConrady{-0.0308, 0, 0, 0, 0}}));
  EXPECT_EQ(read_camera(data / "seven-scenes/camera-intrinsics.txt", kSize),
            (Camera{640, 480, 585, 585, 320, 240, {}}));
  EXPECT_EQ(std::get<BrownConrady>(read_camera(data / "tum-fr1-rpy/camera.txt", kSize).distortion).k3, 1.1633);
  EXPECT_EQ(read_camera(data / "kitti-clip/calib.txt", ImageSize{1226, 370}).fx, 707.0912);
  EXPECT_EQ(read_camera(data / "chessboard-stereo/left_intrinsics.yml").fx, 535.91573396163199);
  EXPECT_EQ(read_cameras(data / "chessboard-stereo/intrinsics.yml", kSize).at(1).camera.cx, 334.55744527912015);
}

}  // namespace
}  // namespace alidade
