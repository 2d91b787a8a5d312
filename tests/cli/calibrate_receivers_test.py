# SPDX-License-Identifier: Apache-2.0
"""alidade calibrate receivers: what it finds of cameras that watched a flight, tells and refuses."""

import csv
import math
import random
import signal
import unittest

from program import ProgramTest, data_folder

CAMERAS = 3
FLIGHT_S = 220.0
RATE_HZ = 5.0
FOCAL_PX = 900.0
CENTRE_PX = 999.5


def place(t):
    """Of the target, m, after t seconds."""
    return (15 * math.sin(0.31 * t), 12 * math.cos(0.4 * t), 20 + 5 * math.sin(0.23 * t))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def camera(k):
    """Where camera k stands, and its axes x, y, z in the world; it looks at the middle of the flight."""
    angle = 2 * math.pi * k / CAMERAS
    centre = (50 * math.cos(angle), 50 * math.sin(angle), 1.0)
    z = unit(tuple(b - a for a, b in zip(centre, (0, 0, 20))))
    x = unit(cross(z, (0, 0, 1)))
    return centre, (x, cross(z, x), z)


def quaternion(axes):
    """w, x, y, z of the rotation whose columns are the axes."""
    (a, d, g), (b, e, h), (c, f, i) = axes
    w = 0.5 * math.sqrt(max(0.0, 1 + a + e + i))
    if w > 0.1:
        return (w, (h - f) / (4 * w), (c - g) / (4 * w), (d - b) / (4 * w))
    x, y, z = (0.5 * math.sqrt(max(0.0, 1 + s)) for s in (a - e - i, e - a - i, i - a - e))
    return (w, math.copysign(x, h - f), math.copysign(y, c - g), math.copysign(z, d - b))


def times(q, p):
    (a, b, c, d), (e, f, g, h) = q, p
    return (a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e)


class CalibrateReceivers(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("true.yaml", self.receivers(0.0))
        self.write("rough.yaml", self.receivers(1.0))
        self.write("observations.csv", self.observations())
        moments = [0.2 * i for i in range(-15, int(5 * FLIGHT_S) + 20)]
        rows = [",".join(map(repr, (t, *place(t)))) for t in moments]
        self.write("path.csv", "\n".join(["t_s,x_m,y_m,z_m", *rows]) + "\n")
        self.words = ["calibrate", "receivers", "rough.yaml", "observations.csv"]

    @staticmethod
    def receivers(disturbed):
        """All but the first are given wrong by some decimetres, a hundredth of a radian and hundredths of a second."""
        text = "receivers:\n"
        for k in range(CAMERAS):
            centre, axes = camera(k)
            off = disturbed * k
            centre = (centre[0] + 0.3 * off, centre[1] - 0.2 * off, centre[2] + 0.2 * off)
            q = times(quaternion(axes), unit((1.0, 0.002 * off, -0.003 * off, 0.002 * off)))
            text += (f"  - id: {k}\n    name: cam{k}\n    model: pinhole\n    resolution_px: [2000, 2000]\n"
                     f"    intrinsics_px: {{fx: {FOCAL_PX}, fy: {FOCAL_PX}, cx: {CENTRE_PX}, cy: {CENTRE_PX}}}\n"
                     f"    sigma_px: 0.5\n"
                     f"    T_world_receiver: {{translation_m: {list(centre)}, quaternion_wxyz: {list(q)}}}\n"
                     f"    clock: {{offset_s: {0.3 * k + 0.04 * off}}}\n")
        return text

    @staticmethod
    def observations(noise_px=0.5):
        draw = random.Random(1)
        rows = ["t_s,receiver,u_px,v_px"]
        for k in range(CAMERAS):
            centre, axes = camera(k)
            for i in range(int(FLIGHT_S * RATE_HZ)):
                t = 0.011 * k + i / RATE_HZ
                away = tuple(a - b for a, b in zip(place(t), centre))
                x, y, z = (sum(a * b for a, b in zip(axis, away)) for axis in axes)
                u, v = (CENTRE_PX + FOCAL_PX * c / z + draw.gauss(0, noise_px) for c in (x, y))
                rows.append(f"{t - 0.3 * k:.9f},{k},{u!r},{v!r}")
        return "\n".join(rows) + "\n"

    def rmse_m(self, receivers, out):
        """Of the flight's track with these receivers."""
        self.assert_succeeds("track", "targets", receivers, "observations.csv", "--method", "flight", "-o", out)
        squares = []
        with open(self.directory / out / "tracks.csv", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                p = place(int(row["t_ns"]) * 1e-9)
                squares.append(sum((float(row[c]) - q) ** 2 for c, q in zip(("x_m", "y_m", "z_m"), p)))
        self.assertGreater(len(squares), 100)
        return math.sqrt(sum(squares) / len(squares))

    def test_a_known_path_makes_tracks_right(self):
        done = self.assert_succeeds(*self.words, "--truth", "path.csv", "--quiet", "-o", "out")
        self.assertEqual(done.stderr, "")
        rough, calibrated = self.rmse_m("rough.yaml", "before"), self.rmse_m("out/receivers.yaml", "after")
        self.assertGreater(rough, 0.1)
        self.assertLess(calibrated, 0.05)
        self.assertLess(calibrated, 0.3 * rough)

    def test_leaves_a_page_pictures_and_numbers(self):
        done = self.assert_succeeds(*self.words, "--truth", "path.csv", "-o", "out")
        self.assertIn("cam1: 1100 readings", done.stdout)
        for name in ("receivers.yaml", "report.html", "options.yaml", "summary.json"):
            self.assertTrue((self.directory / "out" / name).exists(), name)
        self.assertFalse((self.directory / "out" / "trajectory.tum").exists())
        summary = self.summary("out")
        self.assertEqual(summary["method"], "resection")
        self.assertEqual(summary["findings"], [])
        one = summary["receivers"][1]
        self.assertAlmostEqual(one["change"]["clock_s"], -0.04, delta=0.01)
        self.assertAlmostEqual(one["change"]["place_m"], math.sqrt(0.17), delta=0.1)
        self.assertLess(one["median_px"], 0.8)
        self.assertGreater(one["median_before_px"], 3)
        self.assertGreater(one["sigma"]["place_m"], 0)

    def test_finds_the_path_itself_where_it_is_not_known(self):
        self.assert_succeeds(*self.words, "--quiet", "-o", "out")
        summary = self.summary("out")
        self.assertEqual(summary["method"], "bundle")
        for one in summary["receivers"]:
            self.assertLess(one["median_px"], 0.8)
        self.assertTrue((self.directory / "out" / "trajectory.tum").exists())
        with open(self.directory / "out" / "trajectory.tum", encoding="utf-8") as file:
            rows = [list(map(float, line.split())) for line in file if not line.startswith("#")]
        self.assertGreater(len(rows), 9 * FLIGHT_S)
        worst_m = max(math.dist(row[1:4], place(row[0])) for row in rows)
        self.assertLess(worst_m, 1.5)  # as a whole it may be where the rough receivers are

    def test_a_part_can_be_used(self):
        done = self.assert_succeeds(*self.words, "--truth", "path.csv", "--start-s", 5, "--end-s", 45, "--quiet",
                                    "-o", "out")
        self.assertIn("warning: the readings span 40 s only: standard deviations may be too small", done.stderr)
        for one in self.summary("out")["receivers"]:
            self.assertLessEqual(one["readings"], 40 * RATE_HZ + 1)

    def test_names_a_wrong_focal_length(self):
        text = (self.directory / "true.yaml").read_text(encoding="utf-8")
        wrong = text.replace(f"fx: {FOCAL_PX}, fy: {FOCAL_PX}", "fx: 930.0, fy: 930.0", 1)
        self.write("wrong.yaml", wrong)
        done = self.assert_succeeds("calibrate", "receivers", "wrong.yaml", "observations.csv", "--truth", "path.csv",
                                    "--quiet", "-o", "out")
        self.assertRegex(done.stderr, r"warning: receiver 0: its focal lengths are to be multiplied by 0\.9\d\d "
                                      r"\(cam0\); calibrate its lens")
        self.assertEqual(self.summary("out")["findings"][0]["fault"], "wrong_focal")
        self.assert_succeeds("calibrate", "receivers", "wrong.yaml", "observations.csv", "--truth", "path.csv",
                             "--resection-find-focal", "--quiet", "-o", "found")
        self.assertAlmostEqual(self.summary("found")["receivers"][0]["change"]["focal"], 900 / 930, delta=0.005)

    def test_passes_direction_finders_through(self):
        finder = ("  - id: 9\n    model: direction_finder\n    sigma_rad: 0.001\n"
                  "    T_world_receiver: {translation_m: [1, 2, 3], quaternion_wxyz: [1, 0, 0, 0]}\n    clock: common\n")
        self.write("mixed.yaml", self.receivers(1.0) + finder)
        head, *rows = (self.directory / "observations.csv").read_text(encoding="utf-8").splitlines()
        mixed = [head + ",azimuth_rad,elevation_rad", *(row + ",," for row in rows), "1.0,9,,,0.5,0.2"]
        self.write("mixed.csv", "\n".join(mixed) + "\n")
        done = self.assert_succeeds("calibrate", "receivers", "mixed.yaml", "mixed.csv", "--truth", "path.csv",
                                    "--quiet", "-o", "out")
        self.assertEqual(done.stderr.strip(), "warning: receiver 9 is left as given: it is a direction finder; only "
                                              "cameras can be calibrated")
        self.assertIn("translation_m: [1, 2, 3]", (self.directory / "out" / "receivers.yaml").read_text("utf-8"))
        self.write("finders.yaml", "receivers:\n" + finder)
        self.assert_refuses(["calibrate", "receivers", "finders.yaml", "observations.csv", "-o", "none", "--quiet"],
                            r"finders\.yaml: holds direction finders alone; only cameras can be calibrated")

    def test_refuses_bad_input_word_for_word(self):
        head, *rows = (self.directory / "observations.csv").read_text(encoding="utf-8").splitlines()
        self.write("nan.csv", "\n".join([head, rows[0], "0.1,0,nan,5"]) + "\n")
        self.write("empty.csv", head + "\n")
        self.write("one.csv", "\n".join([head, *(row for row in rows if row.split(",")[1] == "0")]) + "\n")
        self.write("late.csv", "t_s,x_m,y_m,z_m\n" + "".join(f"{t},0,0,{t}\n" for t in range(1000, 1005)))
        self.write("broken.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n0.1,0,nan,0\n")
        start, out = self.words[:3], ["-o", "out", "--quiet"]
        for words, message in (
                ([*start, "nowhere.csv"], "nowhere.csv: cannot be opened: No such file"),
                (["calibrate", "receivers", "nowhere.yaml", "observations.csv"], "nowhere.yaml: cannot be opened"),
                ([*self.words, "--truth", "nowhere.csv"], "nowhere.csv: .*No such file"),
                (start, "rough.yaml: no observations are given; name a CSV of observations after it"),
                ([*start, "nan.csv"], r"nan\.csv:3: column 'u_px': 'nan' is not a finite number"),
                ([*start, "empty.csv"], r"empty\.csv: holds no reading of a camera"),
                ([*start, "one.csv"], r"one\.csv: holds readings of one camera; without --truth two"),
                ([*self.words, "--start-s", 500], r"observations\.csv: no reading from 500 to inf s; the cameras' span "
                                                  r"\d.* to \d.* s; change --start-s or --end-s"),
                ([*self.words, "--truth", "late.csv"], r"late\.csv: spans 1000\.000 to 1004\.000 s, the observations "
                                                       r"\d.* s; both must count time by one clock"),
                ([*self.words, "--truth", "broken.csv"], r"broken\.csv:3: column 'y_m'"),
                ([*self.words, "--resection-search-s", 0], "search_s must be > 0, got 0"),
                ([*self.words, "--time-receiver", "cam7"], r"rough\.yaml: no camera 'cam7'")):
            self.assert_refuses([*words, *out], message)
            self.assertFalse((self.directory / "out").exists())

    def test_says_in_one_line_where_there_is_no_answer(self):
        self.assert_refuses([*self.words, "--truth", "path.csv", "--end-s", 3, "-o", "out", "--quiet"],
                            r"warning: no camera can be calibrated \(cam0: \d+ of its readings lie on the path, wanted "
                            r"are 100; .*\); check that path and observations are of one flight", code=4)
        self.assertFalse((self.directory / "out").exists())

    def test_ctrl_c_keeps_what_there_is(self):
        code, printed = self.interrupt([*self.words, "--truth", "path.csv", "--json", "-o", "out"], "resecting",
                                       signal.SIGINT)
        self.assertEqual(code, 130, printed)
        self.assertFalse((self.directory / "out" / ".part").exists())
        if (self.directory / "out").exists():
            self.assertEqual(len(self.summary("out")["receivers"]), CAMERAS)

    @staticmethod
    def later_errors_m(tracks, truth, from_s):
        """Of a track, at the times of the truth's rows that are near to its own."""
        with open(truth, encoding="utf-8") as file:
            known = {round(float(row["t"]) * 1e3): tuple(float(row[c]) for c in "xyz") for row in csv.DictReader(file)}
        with open(tracks, encoding="utf-8") as file:
            for row in csv.DictReader(file):
                t_ms = int(row["t_ns"]) * 1e-6
                p = known.get(round(t_ms))
                if p and t_ms > from_s * 1e3:
                    yield math.dist(p, [float(row[c]) for c in ("x_m", "y_m", "z_m")])

    def test_a_real_flight_gives_poses_that_hold_on_its_other_half(self):
        data = data_folder()
        if data is None or not (data / "uav").is_dir():
            self.skipTest("no recorded flight")
        flight = data / "uav"
        self.assert_succeeds("calibrate", "receivers", flight, "--truth", flight, "--end-s", 352, "--quiet", "-o",
                             "out")
        receivers = self.summary("out")["receivers"]
        self.assertEqual(len(receivers), 6)
        for one in receivers:
            self.assertTrue(one["is_calibrated"], one["name"])
            self.assertLess(one["median_px"], 7)
        self.assert_succeeds("track", "targets", "out/receivers.yaml", flight, "--method", "flight", "-o", "track")
        errors = list(self.later_errors_m(self.directory / "track" / "tracks.csv", flight / "groundtruth.csv", 352))
        self.assertGreater(len(errors), 500)
        self.assertLess(math.sqrt(sum(e * e for e in errors) / len(errors)), 0.21)


if __name__ == "__main__":
    unittest.main()
