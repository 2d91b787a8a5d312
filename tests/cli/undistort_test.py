# SPDX-License-Identifier: Apache-2.0
"""alidade undistort: images and video in, straight ones and their camera out."""

import csv
import shutil
import unittest

from program import ProgramTest

CAMERA = """camera:
  name: wide
  model: {model}
  resolution_px: [{width}, 120]
  intrinsics_px: {{fx: 100, fy: 100, cx: 80, cy: 60}}
  distortion: {{k1: {k1}}}
  readout_s: 0.02
"""


class Undistort(ProgramTest):
    def setUp(self):
        super().setUp()
        self.assert_succeeds("simulate", "camera", "--width", 160, "--height", 120, "--frames", 4, "-o", "scene")
        self.write("camera.yaml", CAMERA.format(model="brown_conrady", width=160, k1=-0.1))

    def undistort(self, *words, source="scene/images", out="out"):
        self.assert_succeeds("undistort", source, "--camera", "camera.yaml", "-o", out, *words)
        return self.summary(out)

    def test_images_keep_their_names(self):
        summary = self.undistort()
        self.assertEqual(summary["frames"], 4)
        names = sorted(path.name for path in (self.directory / "out" / "images").iterdir())
        self.assertEqual(names, [f"{i:06}.png" for i in range(4)])
        for name in ("camera.yaml", "options.yaml", "report.html"):
            self.assertTrue((self.directory / "out" / name).is_file(), name)
        text = (self.directory / "out" / "camera.yaml").read_text(encoding="utf-8")
        self.assertIn("model: pinhole", text)
        self.assertIn("readout_s: 0.02", text)

    def test_more_alpha_shows_more(self):
        focal = [self.undistort("--alpha", alpha, out=f"out{alpha}")["intrinsics_px"]["fx"] for alpha in (0, 0.5, 1)]
        self.assertEqual(focal, sorted(focal, reverse=True))
        self.assertLess(focal[2], focal[0])
        self.assertEqual(self.undistort("--focal-px", 77, out="f")["intrinsics_px"]["fx"], 77)

    def test_its_own_output_stays_as_it_is(self):
        self.undistort(out="once")
        self.assert_succeeds("undistort", "once/images", "--camera", "once/camera.yaml", "-o", "twice")
        for i in range(4):
            once, twice = (self.directory / out / "images" / f"{i:06}.png" for out in ("once", "twice"))
            self.assertEqual(once.read_bytes(), twice.read_bytes())

    def test_a_video_becomes_a_video_and_times_are_kept(self):
        self.assert_succeeds("simulate", "camera", "--width", 160, "--height", 120, "--frames", 4, "--form", "lossless",
                             "-o", "clip")
        self.assertEqual(self.undistort(source="clip/video.mkv")["frames"], 4)
        self.assertTrue((self.directory / "out" / "video.mp4").is_file())
        with open(self.directory / "out" / "frames.csv", newline="", encoding="utf-8") as file:
            times = [int(row["t_ns"]) for row in csv.DictReader(file)]
        self.assertEqual(len(times), 4)
        self.undistort("--form", "images", source="clip/video.mkv", out="stills")
        self.assertTrue((self.directory / "stills" / "images" / "000003.png").is_file())
        self.assertEqual(self.undistort(source="out/video.mp4", out="again")["frames"], 4)

    def test_ctrl_c_keeps_what_there_is(self):
        many = self.directory / "many"
        many.mkdir()
        for i in range(4000):  # far more than are undistorted before the signal comes
            (many / f"{i:06}.png").symlink_to(self.directory / "scene" / "images" / f"{i % 4:06}.png")
        code, printed = self.interrupt(["undistort", "many", "--camera", "camera.yaml", "-o", "out"],
                                       once_seen="undistorting")
        self.assertEqual(code, 130, printed)
        summary = self.summary("out")
        self.assertTrue(summary["interrupted"])
        written = list((self.directory / "out" / "images").iterdir())
        self.assertEqual(len(written), summary["frames"])
        self.assertLess(len(written), 4000)

    def test_a_fisheye_too_wide_is_told_what_to_do(self):
        text = CAMERA.format(model="fisheye", width=160, k1=0).replace("fx: 100, fy: 100", "fx: 45, fy: 45")
        self.write("camera.yaml", text)
        self.assertEqual(self.undistort()["frames"], 4)
        self.assert_refuses(["undistort", "scene/images", "--camera", "camera.yaml", "--alpha", 1, "-o", "no"],
                            "^camera.yaml: a pixel at the border looks 80 degrees or more .*; set --focal-px, or --alpha 0$")

    def test_refuses_what_does_not_fit(self):
        self.write("other.yaml", CAMERA.format(model="brown_conrady", width=200, k1=-0.1))
        out = ["-o", "no", "--quiet"]
        self.assert_refuses(["undistort", "scene/images", "--camera", "other.yaml", *out],
                            "^other.yaml: the camera is for 200x120 px, the images of scene/images have 160x120; ")
        self.assert_refuses(["undistort", "scene/images", "--camera", "camera.yaml", "--alpha", 2, *out],
                            r"alpha must lie in \[0, 1\], got 2")
        self.assert_refuses(["undistort", "nowhere", "--camera", "camera.yaml", *out], "nowhere")
        shutil.copytree(self.directory / "scene" / "images", self.directory / "b" / "images")
        self.assert_refuses(["undistort", "*/images/000001.png", "--camera", "camera.yaml", *out],
                            "^000001.png: two images have this name; ")
        self.assertFalse((self.directory / "no").exists())


if __name__ == "__main__":
    unittest.main()
