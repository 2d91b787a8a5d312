# SPDX-License-Identifier: Apache-2.0
"""How scripts/figures judges and computes, without running anything that takes long."""

import pathlib
import subprocess
import sys
import tempfile
import unittest
import zlib

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPTS))
from figure_topics import TOPICS, colmap, images  # noqa: E402
from figure_topics.figure import Fact, Failed, Figure, Section, Skipped, format_line, measure_section  # noqa: E402
from figure_topics.main_job import recordings  # noqa: E402


def section(measure, *figures):
    return [(figure.name, status, value) for figure, status, value in
            measure_section(Section("part", list(figures), measure), None)]


class Judgement(unittest.TestCase):
    def test_a_value_on_the_bound_holds_unless_it_must_be_below(self):
        self.assertTrue(Figure("a", at_most=2.5).holds(2.5))
        self.assertFalse(Figure("a", at_most=2.5).holds(2.5001))
        self.assertFalse(Figure("a", below=2.5).holds(2.5))
        self.assertTrue(Figure("a", at_least=15).holds(15))
        self.assertFalse(Figure("a", at_least=15).holds(14.9))
        self.assertTrue(Figure("a").holds(1e9))
        self.assertFalse(Figure("a", at_most=2.5).holds(float("nan")))

    def test_statuses_follow_bounds_and_facts(self):
        def measure(_):
            yield "a", 1.0
            yield "b", 3.0
            yield "c", Fact("exit 3", False)

        self.assertEqual([row[1] for row in section(measure, Figure("a", at_most=2), Figure("b", at_most=2),
                                                    Figure("c", expected="exit 2"))], ["ok", "short", "short"])

    def test_what_was_not_measured_is_never_ok(self):
        def fails(_):
            yield "a", 1.0
            raise Failed("it crashed")

        def skips(_):
            raise Skipped("no data")
            yield

        figures = [Figure("a", at_most=2), Figure("b", at_most=2), Figure("c", manual="look")]
        self.assertEqual(section(fails, *figures),
                         [("a", "ok", 1.0), ("b", "short", "failed: it crashed"), ("c", "manual", "look")])
        self.assertEqual([row[1] for row in section(skips, *figures)], ["skipped", "skipped", "manual"])
        self.assertEqual(section(lambda _: iter(()), Figure("b", at_most=2)), [("b", "short", "not measured")])

    def test_the_line_has_status_name_value_bound_and_goal(self):
        line = format_line("short", "main-job", Figure("x/time", "s", at_most=0.4, goal=0.25), 0.5)
        self.assertRegex(line, r"^short +main-job/x/time +0\.5 s +<= 0\.4 s +0\.25 s$")

    def test_every_figure_of_a_topic_has_a_name_of_its_own(self):
        for sections in TOPICS.values():
            names = [figure.name for part in sections for figure in part.figures]
            self.assertEqual(len(names), len(set(names)))

    def test_unknown_topics_are_refused(self):
        done = subprocess.run([sys.executable, "-B", SCRIPTS / "figures", "mainjob"], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("unknown topic 'mainjob'; known are: main-job", done.stderr)


class Computation(unittest.TestCase):
    def test_colmap_pose_becomes_centre_and_camera_to_world_quaternion(self):
        # World to camera: a quarter turn about z, (x, y, z) -> (-y, x, z), and t = (1, 2, 3).
        # C = -R^T t, and R^T maps (x, y, z) to (y, -x, z): C = -(2, -1, 3).
        half = 0.5 ** 0.5
        centre, quaternion = colmap.centre_of((half, 0, 0, half), (1, 2, 3))
        for got, expected in zip((*centre, *quaternion), (-2, 1, -3, 0, 0, -half, half)):
            self.assertAlmostEqual(got, expected)

    def test_colmap_images_are_timed_by_their_place(self):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "images.txt")
            source.write_text("# comment\n1 1 0 0 0 1 2 3 1 b.jpg\n1.5 2.5 -1\n2 1 0 0 0 0 0 0 1 a.jpg\n\n")
            target = pathlib.Path(folder, "t.tum")
            self.assertEqual(colmap.write_tum(source, ["a.jpg", "b.jpg"], target), 2)
            self.assertEqual(target.read_text(), "0 -0 -0 -0 -0 -0 -0 1\n1 -1 -2 -3 -0 -0 -0 1\n")

    def test_straight_line_is_the_best_one(self):
        line = [(1 + 2 * i, 3 - i, 0.5 * i) for i in range(7)]
        self.assertAlmostEqual(recordings.straight_line_rmse(line), 0)
        # One axis 0, 1, 0: the best line is 1/3 everywhere; squares 1/9 + 4/9 + 1/9 = 2/3 over 3 frames.
        self.assertAlmostEqual(recordings.straight_line_rmse([(0,), (1,), (0,)]), (2 / 9) ** 0.5)

    def test_reference_cases_are_all_read(self):
        text = "## evo_ape tum T E -as\n   max\t5.066735\n  rmse\t3.1\n## evo_rpe kitti T E (translation)\n rmse\t1.0\n"
        self.assertEqual(list(recordings.reference_cases(text)),
                         [(["evo_ape", "tum", "T", "E", "-as"], {"max": "5.066735", "rmse": "3.1"}),
                          (["evo_rpe", "kitti", "T", "E", "(translation)"], {"rmse": "1.0"})])

    def test_png_holds_the_rows(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "a.png")
            images.write_png(path, 2, 2, [b"\x01\x02", b"\x03\x04"])
            data = path.read_bytes()
            start = data.index(b"IDAT") + 4
            length = int.from_bytes(data[start - 8:start - 4], "big")
            self.assertEqual(zlib.decompress(data[start:start + length]), b"\0\x01\x02\0\x03\x04")


if __name__ == "__main__":
    unittest.main()
