# SPDX-License-Identifier: Apache-2.0
"""alidade calibrate camera, stereo and rig, on rendered boards."""

import csv
import shutil
import unittest

from program import ProgramTest

BOARD = "chessboard:9x6:25mm"


class CalibrateCamera(ProgramTest):
    def images(self, name, *words, board=BOARD):
        self.assert_succeeds("simulate", "board", "--board", board, "-o", name, "--quiet", *words)
        return self.directory / name / "images"

    def copy(self, name, images):
        (self.directory / name).mkdir()
        for image, to in images:
            shutil.copy(image, self.directory / name / to)
        return name

    def test_finds_the_camera_that_took_the_images(self):
        self.images("boards", "--images", 14)
        done = self.assert_succeeds("calibrate", "camera", "boards/images", "--board", BOARD, "-o", "out")
        self.assertIn("verdict: ", done.stdout)
        result = self.summary("out")
        fx = result["intrinsics"]["fx"]
        self.assertLess(abs(fx["value"] - 520), 4 * fx["sigma"] + 0.02)
        self.assertLess(fx["sigma"], 0.5)
        self.assertLess(result["held_out_rms_px"], 0.1)
        self.assertEqual(result["board"], BOARD)
        for name in ("camera.yaml", "report.html", "options.yaml", "views.csv", "corners.csv", "coverage.png",
                     "residuals.png", "uncertainty.png", "views.png", "radial.png"):
            self.assertGreater((self.directory / "out" / name).stat().st_size, 0, name)
        with open(self.directory / "out" / "corners.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 54 * result["images_with_board"])
        self.assert_succeeds("convert", "out/camera.yaml", "--format", "opencv", "-o", "opencv.yml")

    def test_guesses_the_board_and_says_so(self):
        self.images("boards", "--images", 10)
        done = self.assert_succeeds("calibrate", "camera", "boards/images", "-o", "out", "--quiet")
        self.assertIn("warning: the board was guessed: chessboard of 9x6 inner corners", done.stderr)
        self.assertEqual(self.summary("out")["board"], BOARD)

    def test_takes_boards_that_are_seen_in_part(self):
        board = "charuco:8x6:30mm:22mm:5X5_100"
        self.images("boards", "--images", 12, "--partial", board=board)
        self.assert_succeeds("calibrate", "camera", "boards/images", "--board", board, "-o", "out", "--quiet")
        fx = self.summary("out")["intrinsics"]["fx"]
        self.assertLess(abs(fx["value"] - 520), 4 * fx["sigma"] + 0.05)

    def test_names_the_trouble_and_the_remedy(self):
        good = sorted(self.images("good", "--images", 4).iterdir())
        words = ["--board", BOARD, "-o", "out", "--quiet"]
        one = self.copy("one", [(good[0], "a.png")])
        self.assert_refuses(["calibrate", "camera", one, *words], r"^one: no calibration: .* 1 image, three are the least")
        same = self.copy("same", [(good[0], f"{i}.png") for i in range(4)])
        self.assert_refuses(["calibrate", "camera", same, *words], r"4 images, but only 1 of them differs")
        self.assert_refuses(["calibrate", "camera", "good/images", "--board", "chessboard:8x5:25mm", "-o", "out", "--quiet"],
                            r"no chessboard of 8x5 .*: give --board chessboard:9x6:25mm")
        self.assert_refuses(["calibrate", "camera", "nowhere", *words], r"^nowhere")
        self.assert_refuses(["calibrate", "camera", "good/images", "--board", "chessboard:9x6", "-o", "out"],
                            r"chessboard:9x6:25mm")
        self.assertFalse((self.directory / "out").exists())

    def test_calibrates_a_rig_of_images_with_the_same_numbers(self):
        self.images("boards", "--images", 10)
        for name in ("left", "right"):
            shutil.copytree(self.directory / "boards" / "images", self.directory / name)
        # One camera twice: its baseline is 0, and no pair has an epipolar error.
        self.assert_succeeds("calibrate", "stereo", "left", "right", "--board", BOARD, "-o", "stereo", "--quiet")
        result = self.summary("stereo")
        self.assertEqual([camera["name"] for camera in result["cameras"]], ["left", "right"])
        self.assertEqual(result["moments"], 10)
        self.assertLess(result["rms_px"], 0.1)
        for name in ("rig.yaml", "report.html", "left-corners.csv", "right-coverage.png"):
            self.assertTrue((self.directory / "stereo" / name).is_file(), name)

    def test_is_interrupted_without_a_trace(self):
        self.images("boards", "--images", 10)
        code, _ = self.interrupt(["calibrate", "camera", "boards/images", "--board", BOARD, "-o", "out"],
                                 "finding the board")[:2]
        self.assertEqual(code, 130)
        self.assertFalse((self.directory / "out" / "summary.json").exists())


if __name__ == "__main__":
    unittest.main()
