# SPDX-License-Identifier: Apache-2.0
"""alidade calibrate board and simulate board: boards to print, and images of them with truth."""

import struct
import unittest

from program import ProgramTest


def picture_size(path):
    """Width and height of a PNG."""
    return struct.unpack(">II", path.read_bytes()[16:24])


class CalibrateBoard(ProgramTest):
    def test_writes_a_page_to_scale(self):
        done = self.assert_succeeds("calibrate", "board", "charuco:8x6:30mm:22mm:5X5_100", "-o", "board.pdf")
        self.assertIn("ChArUco of 8x6 squares of 30 mm", done.stdout)
        page = (self.directory / "board.pdf").read_bytes()
        self.assertTrue(page.startswith(b"%PDF-1.4"))
        self.assertIn(b"/MediaBox [0 0 841.8898 595.2756]", page)  # A4 on its side
        self.assertIn(b" 30.00000 30.00000 re", page)

    def test_writes_a_picture_of_whole_pixels(self):
        self.assert_succeeds("calibrate", "board", "chessboard:9x6:25mm", "--pixels-per-mm", 2, "--margin-mm", 5, "-o",
                             "board.png", "--quiet")
        self.assertEqual(picture_size(self.directory / "board.png"), (520, 370))

    def test_refuses_what_cannot_be_printed(self):
        words = ["calibrate", "board"]
        self.assert_refuses([*words, "chesboard:9x6:25mm", "-o", "x.pdf"], r"did you mean 'chessboard'\?")
        self.assert_refuses([*words, "chessboard:9x6:40mm", "-o", "x.pdf"], r"print it with --paper A2")
        self.assert_refuses([*words, "chessboard:9x6:25mm", "-o", "x.svg"], r"ends with \.pdf or \.png")
        self.assert_refuses([*words, "chessboard:9x6:25mm"], r"output is required")
        self.assertEqual(list(self.directory.iterdir()), [])


class SimulateBoard(ProgramTest):
    def test_writes_images_with_their_truth(self):
        self.assert_succeeds("simulate", "board", "--board", "chessboard:9x6:25mm", "--images", 3, "-o", "boards")
        boards = self.directory / "boards"
        images = sorted((boards / "images").iterdir())
        self.assertEqual(len(images), 3)
        self.assertEqual(picture_size(images[0]), (640, 480))
        truth = [line for line in (boards / "truth.tum").read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(len(truth), 3)
        self.assertLess(float(truth[0].split()[3]), 0)  # the camera looks along z, away from who looks at the print
        self.assertEqual(self.summary("boards")["board"], "chessboard:9x6:25mm")
        for name in ("camera.yaml", "options.yaml", "report.html"):
            self.assertTrue((boards / name).is_file(), name)

    def test_the_same_seed_gives_the_same_pixels(self):
        for name, seed in (("a", 5), ("b", 5), ("c", 6)):
            self.assert_succeeds("simulate", "board", "--images", 1, "--seed", seed, "-o", name)
        pictures = [(self.directory / name / "images" / "000000.png").read_bytes() for name in "abc"]
        self.assertEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[0], pictures[2])

    def test_draws_through_a_given_camera(self):
        self.assert_succeeds("simulate", "board", "--images", 1, "-o", "first")
        text = (self.directory / "first" / "camera.yaml").read_text()
        self.write("small.yaml", text.replace("640, 480", "660, 500"))
        self.assert_succeeds("simulate", "board", "--images", 1, "--camera", "small.yaml", "-o", "second")
        self.assertEqual(picture_size(self.directory / "second" / "images" / "000000.png"), (660, 500))

    def test_refuses_what_cannot_be(self):
        words = ["simulate", "board", "-o", "x", "--quiet"]
        self.assert_refuses([*words, "--images", "0"], r"images must be 1\.\.100000, got 0")
        self.assert_refuses([*words, "--tilt-deg", "90"], r"most_tilt_deg must be 0\.\.80 deg, got 90")
        self.assert_refuses([*words, "--board", "chessboard:9x6:25"], r"the length '25' has no unit")
        self.assertFalse((self.directory / "x").exists())


if __name__ == "__main__":
    unittest.main()
