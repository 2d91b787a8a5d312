# SPDX-License-Identifier: Apache-2.0
"""alidade simulate camera, simulate body and view: what they write, draw and refuse."""

import csv
import os
import struct
import unittest

from program import ProgramTest

SMALL = ["--width", 160, "--height", 120, "--frames", 6]


def picture_size(path):
    """Width and height of a PNG."""
    return struct.unpack(">II", path.read_bytes()[16:24])


class SimulateCamera(ProgramTest):
    def test_writes_frames_with_their_truth(self):
        self.assert_succeeds("simulate", "camera", *SMALL, "--fps-hz", 10, "-o", "scene")
        scene = self.directory / "scene"
        with open(scene / "frames.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([int(row["t_ns"]) for row in rows], [100_000_000 * i for i in range(6)])
        for row in rows:
            self.assertEqual(picture_size(scene / row["image"]), (160, 120))
        truth = [line for line in (scene / "truth.tum").read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(len(truth), 6)
        self.assertIn("resolution_px: [160, 120]", (scene / "camera.yaml").read_text())
        self.assertTrue((scene / "report.html").is_file())
        self.assertEqual(self.summary("scene")["frames"], 6)

    def test_the_same_seed_gives_the_same_pixels(self):
        for name, seed in (("a", 5), ("b", 5), ("c", 6)):
            self.assert_succeeds("simulate", "camera", *SMALL, "--seed", seed, "-o", name)
        pictures = [(self.directory / name / "images" / "000003.png").read_bytes() for name in "abc"]
        self.assertEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[0], pictures[2])

    def test_writes_videos(self):
        for form, name in (("movie", "video.mp4"), ("lossless", "video.mkv")):
            self.assert_succeeds("simulate", "camera", *SMALL, "--form", form, "-o", form)
            self.assertGreater((self.directory / form / name).stat().st_size, 1000)
            self.assertFalse((self.directory / form / "images").exists())

    def test_refuses_what_cannot_be_drawn(self):
        words = ["simulate", "camera", "-o", "x"]
        self.assert_refuses([*words, "--frames", "0", "--quiet"], r"frames must be >= 1, got 0")
        self.assert_refuses([*words, "--form", "movie", "--depth", "--quiet"], r"depth must be written with form images")
        self.assert_refuses([*words, "--distortion-k1", "-3", "--quiet"],
                            r"the distortion has no inverse in a part of the image; give a weaker distortion")
        self.assertFalse((self.directory / "x").exists())

    def test_draws_without_a_display(self):
        environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
        self.assert_succeeds("simulate", "camera", *SMALL, "-o", "scene", env=environment)

    def test_keeps_what_is_there_when_interrupted(self):
        code, printed = self.interrupt(["simulate", "camera", "--frames", 2000, "--width", 160, "--height", 120, "-o",
                                        "scene"], once_seen="rendering")
        self.assertEqual(code, 130, printed)
        summary = self.summary("scene")
        self.assertTrue(summary["interrupted"])
        self.assertGreater(summary["frames"], 0)
        self.assertEqual(len(list((self.directory / "scene" / "images").iterdir())), summary["frames"])


class SimulateBody(ProgramTest):
    def test_writes_readings_with_their_truth(self):
        self.assert_succeeds("simulate", "body", "--frames", 50, "--markers", 3, "--wrong-ids", 0.2, "-o", "body")
        body = self.directory / "body"
        with open(body / "observations.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 50 * 12 * 3)
        self.assertEqual({int(row["t_ns"]) for row in rows}, {4_000_000 * i for i in range(50)})
        self.assertLess(max(abs(float(row["value_rad"])) for row in rows), 0.5)
        with open(body / "body.csv", encoding="utf-8") as file:
            self.assertEqual([row["marker"] for row in csv.DictReader(file)], ["0", "1", "2"])
        truth = [line for line in (body / "truth.tum").read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(len(truth), 50)
        for name in ("detectors.yaml", "options.yaml", "report.html"):
            self.assertTrue((body / name).is_file(), name)
        summary = self.summary("body")
        self.assertEqual((summary["frames"], summary["readings"]), (50, len(rows)))
        self.assertAlmostEqual(summary["readings_with_wrong_id"] / len(rows), 0.2, delta=0.05)

    def test_the_same_seed_gives_the_same_readings(self):
        for name, seed in (("a", 5), ("b", 5), ("c", 6)):
            self.assert_succeeds("simulate", "body", "--frames", 3, "--seed", seed, "-o", name)
        readings = [(self.directory / name / "observations.csv").read_bytes() for name in "abc"]
        self.assertEqual(readings[0], readings[1])
        self.assertNotEqual(readings[0], readings[2])

    def test_several_bodies_have_their_own_truth(self):
        self.assert_succeeds("simulate", "body", "--frames", 3, "--bodies", 2, "-o", "two")
        self.assertEqual(self.summary("two")["truth"], ["truth_body1.tum", "truth_body2.tum"])
        self.assertTrue((self.directory / "two" / "truth_body2.tum").is_file())

    def test_refuses_what_cannot_be(self):
        words = ["simulate", "body", "-o", "x", "--quiet"]
        self.assert_refuses([*words, "--markers", "5"], r"markers must be 3, 4 or 8, got 5")
        self.assert_refuses([*words, "--wrong-ids", "1.5"], r"wrong_ids must be 0\.\.1, got 1\.5")
        self.assertFalse((self.directory / "x").exists())

    def test_keeps_what_is_there_when_interrupted(self):
        code, printed = self.interrupt(["simulate", "body", "--frames", 5_000_000, "-o", "body"],
                                       once_seen="reading markers")
        self.assertEqual(code, 130, printed)
        summary = self.summary("body")
        self.assertTrue(summary["interrupted"])
        rows = (self.directory / "body" / "observations.csv").read_text().count("\n") - 1
        self.assertEqual(rows, summary["readings"])
        self.assertEqual(rows, 48 * summary["frames"])


class View(ProgramTest):
    def test_draws_a_result_from_any_side_and_as_a_movie(self):
        self.assert_succeeds("simulate", "camera", *SMALL, "-o", "scene")
        words = ["view", "scene", "--width", 240, "--height", 160]
        self.assert_succeeds(*words, "-o", "front")
        self.assert_succeeds(*words, "--azimuth-deg", 120, "--turntable", "--turn-s", 0.2, "-o", "side")
        front, side = (self.directory / name / "scene.png" for name in ("front", "side"))
        self.assertEqual(picture_size(front), (240, 160))
        self.assertNotEqual(front.read_bytes(), side.read_bytes())
        self.assertGreater((self.directory / "side" / "turntable.mp4").stat().st_size, 1000)
        self.assertEqual(self.summary("front")["true_poses"], 6)

    def test_refuses_what_holds_nothing_to_draw(self):
        (self.directory / "empty").mkdir()
        self.assert_refuses(["view", "empty", "-o", "x"], r"^empty: holds nothing to draw; give a result directory")
        self.assert_refuses(["view", "nowhere", "-o", "x"], r"^nowhere: ")
        self.assert_refuses(["view", "empty", "-o", "x", "--width", "1"], r"width must be 64\.\.4096 px, got 1")


if __name__ == "__main__":
    unittest.main()
