# SPDX-License-Identifier: Apache-2.0
"""alidade convert: camera files for other programs, and what mrcal itself reads and writes."""

import json
import subprocess
import unittest

from program import ProgramTest

RIG = """cameras:
  - name: left
    model: brown_conrady
    resolution_px: [640, 480]
    intrinsics_px: {fx: 500.5, fy: 501, cx: 320.25, cy: 240}
    distortion: {k1: -0.28, k2: 0.07, p1: 0.0002, p2: -0.0003}
  - name: right
    model: brown_conrady
    resolution_px: [640, 480]
    intrinsics_px: {fx: 499, fy: 500, cx: 310, cy: 241}
    distortion: {k1: 0.3, k2: 0.05, p1: 0.001, p2: -0.002, k3: 0.001, k4: 0.5, k5: -0.01, k6: 0.002}
    T_rig_camera: {translation_m: [0.12, 0.01, -0.02], quaternion_wxyz: [0.9887710779360422, 0.1, -0.1, 0.05]}
    pose_covariance: [1e-6, 0,0,0,0,0, 1e-6, 0,0,0,0, 1e-6, 0,0,0, 1e-6, 0,0, 1e-6, 0, 1e-6]
    clock_offset_s: 0.004
"""
RAYS = [[x / 5, y / 5, 1.0] for x in range(-2, 3) for y in range(-2, 3)]

# Debian's own interpreter has the package; the one that runs the tests may be another.
PROJECT_BY_MRCAL = """
import json, sys
import mrcal, numpy
model = mrcal.cameramodel(sys.argv[1])
rays = numpy.array(json.loads(sys.argv[2]))
if len(sys.argv) > 3: model.write(sys.argv[3])
print(json.dumps({"pixels": mrcal.project(rays, *model.intrinsics()).tolist(), "model": model.intrinsics()[0],
                  "Rt": model.extrinsics_Rt_toref().tolist()}))
"""


def project(fx, fy, cx, cy, k, ray):
    """OpenCV's formula."""
    x, y = ray[0] / ray[2], ray[1] / ray[2]
    k1, k2, p1, p2, k3, k4, k5, k6 = (*k, 0, 0, 0, 0)[:8]
    s = x * x + y * y
    radial = (1 + s * (k1 + s * (k2 + s * k3))) / (1 + s * (k4 + s * (k5 + s * k6)))
    return (fx * (x * radial + 2 * p1 * x * y + p2 * (s + 2 * x * x)) + cx,
            fy * (y * radial + 2 * p2 * x * y + p1 * (s + 2 * y * y)) + cy)


class Convert(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("rig.yaml", RIG)

    def read(self, name):
        return (self.directory / name).read_text(encoding="utf-8")

    def test_round_trips_give_the_same_file(self):
        self.assert_succeeds("convert", "rig.yaml", "-o", "plain.yaml")
        self.assertIn("clock_offset_s: 0.004", self.read("plain.yaml"))
        self.assertIn("pose_covariance", self.read("plain.yaml"))
        self.assert_succeeds("convert", "rig.yaml", "--format", "opencv", "-o", "stereo.yml")
        self.assert_succeeds("convert", "stereo.yml", "-o", "back.yaml")
        self.assert_succeeds("convert", "back.yaml", "--format", "opencv", "-o", "again.yml")
        self.assertIn("distortion: {k1: 0.3, k2: 0.05, p1: 0.001, p2: -0.002, k3: 0.001, k4: 0.5, k5: -0.01, k6: 0.002}",
                      self.read("back.yaml"))
        self.assertEqual(self.read("stereo.yml").split("R:")[0], self.read("again.yml").split("R:")[0])

    def test_says_what_is_lost(self):
        done = self.assert_succeeds("convert", "rig.yaml", "--format", "colmap", "-o", "cameras.txt", "--json")
        events = [json.loads(line) for line in done.stdout.splitlines()]
        result = next(event for event in events if event["event"] == "result")
        self.assertEqual(result["lost"], ["covariances", "clock offsets", "poses on the rig"])
        self.assertEqual(result["cameras"], 2)
        self.assertIn("has no place for clock offsets", done.stdout + done.stderr)

    def test_joins_the_cameras_of_several_files(self):
        for name in ("left", "right"):
            self.assert_succeeds("convert", "rig.yaml", "--camera", name, "--format", "mrcal", "-o",
                                 f"{name}.cameramodel")
        self.assert_succeeds("convert", "left.cameramodel", "right.cameramodel", "-o", "both.yaml")
        text = self.read("both.yaml")
        self.assertIn('name: "left"', text)
        self.assertIn('name: "right"', text)
        self.assertIn("T_rig_camera", text)

    def test_refuses_what_cannot_be_written_or_read(self):
        out = ["-o", "out.yaml"]
        self.assert_refuses(["convert", "rig.yaml", "--format", "kalibr", *out],
                            r"^out.yaml: cannot be written: Kalibr has no rational distortion .*'right'")
        self.assert_refuses(["convert", "rig.yaml", "--format", "ros", *out], "holds one camera, not 2")
        self.assert_refuses(["convert", "rig.yaml", "--camera", "rigth", *out],
                            "rig.yaml: there is no camera 'rigth'; did you mean 'right'")
        self.assert_refuses(["convert", "nowhere.yaml", *out], "nowhere.yaml: cannot be opened")
        self.assert_refuses(["convert", "rig.yaml", "--format", "kaliber", *out], "kalibr")
        self.assert_refuses(["convert", "rig.yaml"], "output")
        self.write("K.txt", "500 0 320\n0 500 240\n0 0 1\n")
        self.assert_refuses(["convert", "K.txt", *out], "K.txt:1: says no image size")
        self.assertFalse((self.directory / "out.yaml").exists())
        self.assert_succeeds("convert", "K.txt", "--size", 640, 480, *out)
        self.assertIn("resolution_px: [640, 480]", self.read("out.yaml"))


class Mrcal(ProgramTest):
    def by_mrcal(self, *words):
        done = subprocess.run(["/usr/bin/python3", "-c", PROJECT_BY_MRCAL, *words], cwd=self.directory,
                              capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def setUp(self):
        super().setUp()
        try:
            done = subprocess.run(["/usr/bin/python3", "-c", "import mrcal"], capture_output=True, check=False)
        except FileNotFoundError:
            self.skipTest("there is no /usr/bin/python3")
        if done.returncode != 0:
            self.skipTest("mrcal is not installed")
        self.write("rig.yaml", RIG)

    def test_projects_our_cameras_as_we_do(self):
        left = (500.5, 501, 320.25, 240, (-0.28, 0.07, 0.0002, -0.0003))
        right = (499, 500, 310, 241, (0.3, 0.05, 0.001, -0.002, 0.001, 0.5, -0.01, 0.002))
        for name, camera, model in (("left", left, "LENSMODEL_OPENCV4"), ("right", right, "LENSMODEL_OPENCV8")):
            self.assert_succeeds("convert", "rig.yaml", "--camera", name, "--format", "mrcal", "-o", "a.cameramodel")
            result = self.by_mrcal("a.cameramodel", json.dumps(RAYS))
            self.assertEqual(result["model"], model)
            for ray, pixel in zip(RAYS, result["pixels"]):
                expected = project(*camera, ray)
                self.assertLess(abs(pixel[0] - expected[0]) + abs(pixel[1] - expected[1]), 1e-6)
        for got, expected in zip(result["Rt"][3], (0.12, 0.01, -0.02)):  # where the right camera sits
            self.assertAlmostEqual(got, expected, delta=1e-9)

    def test_its_own_files_come_back(self):
        self.assert_succeeds("convert", "rig.yaml", "--camera", "right", "--format", "mrcal", "-o", "ours.cameramodel")
        first = self.by_mrcal("ours.cameramodel", json.dumps(RAYS), "its.cameramodel")
        self.assert_succeeds("convert", "its.cameramodel", "--format", "mrcal", "-o", "again.cameramodel")
        second = self.by_mrcal("again.cameramodel", json.dumps(RAYS))
        for a, b in zip(first["pixels"], second["pixels"]):
            self.assertLess(abs(a[0] - b[0]) + abs(a[1] - b[1]), 1e-6)


if __name__ == "__main__":
    unittest.main()
