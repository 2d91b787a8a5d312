# SPDX-License-Identifier: Apache-2.0
"""alidade calibrate detectors: what it finds in a simulated recording, tells and refuses."""

import csv
import re
import signal
import unittest

from program import ProgramTest

FRAMES = 200  # 0.8 s


class CalibrateDetectors(ProgramTest):
    def setUp(self):
        super().setUp()
        self.assert_succeeds("simulate", "body", "--frames", FRAMES, "-o", "sim")
        self.disturb()
        self.inputs = ["calibrate", "detectors", "sim/body.csv", "rough.yaml"]
        self.words = [*self.inputs, "sim/observations.csv"]

    def read(self, name):
        return (self.directory / name).read_text(encoding="utf-8")

    @staticmethod
    def translations(text):
        """Of the stations, in the file's order."""
        stations = text[:text.index("detectors:")]
        found = re.findall(r"translation_m: \[([^\]]*)\]", stations)
        return [[float(number) for number in numbers.split(",")] for numbers in found]

    def disturb(self):
        """All stations but the first stand 2 cm off."""
        text, count = self.read("sim/detectors.yaml"), 0

        def shift(match):
            nonlocal count
            count += 1
            x, rest = match.group(1).split(",", 1)
            return f"translation_m: [{float(x) + (0.02 if count > 1 else 0)!r},{rest}]"

        head, tail = text[:text.index("detectors:")], text[text.index("detectors:"):]
        self.write("rough.yaml", re.sub(r"translation_m: \[([^\]]*)\]", shift, head) + tail)

    def test_finds_the_stations_within_their_covariance_and_leaves_its_files(self):
        done = self.assert_succeeds(*self.words, "--end", 0.6, "--verify-start", 0.6, "--verify-reference",
                                    "sim/truth.tum", "-o", "out")
        self.assertIn("calibration: settled after", done.stdout)
        self.assertIn("verification: worst median residual", done.stdout)
        for name in ("detectors.yaml", "body.csv", "trajectory.tum", "stations.csv", "residuals.csv", "scene.png",
                     "plots.png", "report.html", "options.yaml"):
            self.assertTrue((self.directory / "out" / name).is_file(), name)
        summary = self.summary("out")
        self.assertTrue(summary["converged"])
        held, *moved = summary["stations"]
        self.assertTrue(held["held"])
        truth, found = (self.translations(self.read(name)) for name in ("sim/detectors.yaml", "out/detectors.yaml"))
        self.assertEqual(truth[0], found[0])
        for station, true_place, place in zip(moved, truth[1:], found[1:]):
            off = sum((a - b) ** 2 for a, b in zip(true_place, place)) ** 0.5
            sigma = sum(s * s for s in station["sigma_m_rad"][:3]) ** 0.5
            self.assertLess(off, 4 * sigma)
            self.assertLess(sigma, 2e-3)
        verification = summary["verification"]
        before, after = (max(row["median_sigmas"] for row in verification[when]["detectors"])
                         for when in ("before", "after"))
        self.assertGreater(before, 3.0)
        self.assertLess(after, 0.8)
        self.assertEqual(verification["windows"]["explained"], verification["windows"]["count"])
        errors = verification["reference"]
        self.assertEqual(errors["answered"], errors["asked"])
        self.assertLess(errors["after"]["mean_m"], min(1e-3, 0.5 * errors["before"]["mean_m"]))
        with open(self.directory / "out" / "residuals.csv", newline="", encoding="utf-8") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 3 * (12 + 4))

    def test_track_body_reads_what_it_wrote(self):
        self.assert_succeeds(*self.words, "--quiet", "-o", "out")
        self.assertNotIn("verification", self.summary("out"))
        self.assert_succeeds("track", "body", "out/body.csv", "out/detectors.yaml", "sim/observations.csv", "-o",
                             "track", "--quiet")
        self.assertGreater(self.summary("track")["bodies"][0]["readings_explained"], 0.99)

    def test_goes_by_a_reference_of_another_frame(self):
        rows = [line.split() for line in self.read("sim/truth.tum").splitlines() if not line.startswith("#")]
        turned = [f"{t},{-float(y) + 5},{x},{z}" for t, x, y, z, *_ in rows]
        self.write("capture.csv", "\n".join(["t_s,x_m,y_m,z_m", *turned]) + "\n")
        self.assert_succeeds(*self.words, "--reference", "capture.csv", "--reference-sigma-m", 1e-4, "--verify",
                             "sim/observations.csv", "--verify-reference", "capture.csv", "--verify-onboard",
                             "sim/truth.tum", "-o", "out")
        summary = self.summary("out")
        self.assertTrue(summary["truth_aided"])
        self.assertIn("onboard", summary["verification"]["reference"])

    def test_says_that_it_has_not_settled(self):
        done = self.assert_succeeds(*self.words, "--max-iterations", 2, "--quiet", "-o", "out")
        self.assertEqual(done.stderr.strip(), "warning: the calibration has not settled after 2 iterations; raise "
                                              "--max-iterations")
        self.assertFalse(self.summary("out")["converged"])

    def test_warns_of_a_verification_that_is_none(self):
        done = self.assert_succeeds(*self.words, "--end", 0.5, "--verify-start", 0.4, "--quiet", "-o", "out")
        self.assertIn("verification uses readings of the calibration", done.stderr)

    def test_refuses_bad_input_word_for_word(self):
        out = ["-o", "out", "--quiet"]
        head, *rows = self.read("sim/observations.csv").splitlines()
        self.write("nan.csv", "\n".join([head, rows[0], "0,0,0,nan"]) + "\n")
        self.write("empty.csv", head + "\n")
        self.write("late.csv", "t_s,x_m,y_m,z_m\n100,0,0,0\n101,0,0,0\n")
        self.write("broken.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n0.1,0,nan,0\n")
        for words, message in (
                ([*self.inputs, "nowhere.csv"], "nowhere.csv: cannot be opened: No such file"),
                ([*self.words, "--verify", "nowhere.csv"], "nowhere.csv: cannot be opened: No such file"),
                ([*self.inputs, "nan.csv"], r"nan\.csv:3: column 'value_rad': 'nan' is not a finite number"),
                ([*self.inputs, "empty.csv"], r"empty\.csv: holds no reading; record the moving body"),
                ([*self.words, "--held-station", "blok1"], r"rough\.yaml: no station 'blok1'; (did you mean|known are)"),
                ([*self.words, "--body", "nobody"], r"sim/body\.csv: no body 'nobody'; "),
                ([*self.words, "--start", 5], r"sim/observations\.csv: no reading from 5 to inf s; the recording spans "
                                              r"0\.000 to 0\.\d+ s; change --start or --end"),
                ([*self.words, "--verify-end", -1], "change --verify-start or --verify-end"),
                ([*self.words, "--reference", "late.csv"], r"late\.csv: no position in the time of the readings, .*; it "
                                                           r"spans 100\.000 to 101\.000 s; both must count time"),
                ([*self.words, "--reference", "broken.csv"], r"broken\.csv:3: column 'y_m'"),
                ([*self.words, "--knot-interval-s", 0], "knot_interval_s must be > 0, got 0"),
                ([*self.words, "--reference-sigma-m", 0], "reference_sigma_m must be > 0 m, got 0")):
            self.assert_refuses([*words, *out], message)
            self.assertFalse((self.directory / "out").exists())

    def test_says_where_there_is_no_answer(self):
        self.assert_refuses([*self.words, "--end", 0.003, "-o", "out", "--quiet"], "too few readings: 24 of each", code=4)
        self.assertFalse((self.directory / "out").exists())

    def test_ctrl_c_ends_it_in_order(self):
        code, printed = self.interrupt([*self.words, "--json", "-o", "out"], "following the body", signal.SIGINT)
        self.assertEqual(code, 130, printed)
        self.assertFalse((self.directory / "out" / ".part").exists())
        if (self.directory / "out").exists():  # the stations had begun to move
            self.assertTrue(self.summary("out")["interrupted"])
            self.assertFalse(self.summary("out")["converged"])


if __name__ == "__main__":
    unittest.main()
