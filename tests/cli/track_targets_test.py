# SPDX-License-Identifier: Apache-2.0
"""alidade simulate targets, track targets and evaluate: what they find, keep and refuse."""

import csv
import json
import math
import re
import resource
import signal
import socket
import subprocess
import unittest

from program import PROGRAM, ProgramTest

PERIODS = 20


class Targets(ProgramTest):
    """A simulated flight of two targets in sim."""

    def setUp(self):
        super().setUp()
        self.assert_succeeds("simulate", "targets", "--periods", PERIODS, "--detection-probability", 0.95,
                             "--false-bearings", 0.5, "-o", "sim", "--quiet")
        self.inputs = ["sim/receivers.yaml", "sim/observations.csv"]

    def track(self, *words, out="out", **keywords):
        return self.assert_succeeds("track", "targets", *(words or self.inputs), "-o", out, **keywords)

    def lines(self, name):
        return (self.directory / name).read_text(encoding="utf-8").splitlines()

    def table(self, name):
        return list(csv.DictReader(self.lines(name)))

    def scores(self, estimate, truth="sim/truth.csv"):
        done = self.assert_succeeds("evaluate", estimate, truth, "--json")
        return next(event for event in map(json.loads, done.stdout.splitlines()) if event["event"] == "result")

    def observations(self, rows, name="observations.csv"):
        """A file with the head of the simulated observations and these rows."""
        return self.write(name, "\n".join([self.lines("sim/observations.csv")[0], *rows]) + "\n").name

    def rows(self):
        return self.lines("sim/observations.csv")[1:]


class TrackTargets(Targets):
    def test_finds_the_targets_and_leaves_its_files(self):
        done = self.track("sim", "--truth", "sim/truth.csv")
        self.assertRegex(done.stdout, r"\d+ bearings of 3 receivers in 19\.\d s: 2 targets\ntarget 1: ")
        for name in ("tracks.csv", "tracks/target_1.tum", "tracks/target_2.tum", "receivers.yaml", "options.yaml",
                     "plots.png", "scene.png", "report.html", "summary.json"):
            self.assertTrue((self.directory / "out" / name).is_file(), name)
        self.assertFalse((self.directory / "out" / ".part").exists())
        scores = self.scores("out")
        self.assertLess(scores["rms_m"], 0.35)
        self.assertGreater(scores["completeness"], 0.75)  # it takes three of the twenty periods to be sure
        self.assertEqual((scores["identity_switches"], scores["false_identities"]), (0, 0))
        self.assertLess(scores["nees"]["mean_per_degree_of_freedom"], 1.4)
        self.assertEqual(self.scores("out/tracks.csv", "sim"), scores)
        self.assertEqual([target["target"] for target in self.summary("out")["targets"]], [1, 2])
        page = (self.directory / "out" / "report.html").read_text(encoding="utf-8")
        for words in ("Target tracks of sim", "direction finder", "receiver3", "track targets sim --truth"):
            self.assertIn(words, page)

    def test_each_method_answers(self):
        for method, most_m in (("paper-alternative", 3.0), ("paper-proposed", 2.0)):
            self.track(*self.inputs, "--method", method, out=method)
            self.assertLess(self.scores(method)["median_m"], most_m, method)
            self.assertIn("UAV paper", self.summary(method)["method"])
        self.assert_succeeds("simulate", "targets", "--targets", 1, "--periods", PERIODS, "-o", "one", "--quiet")
        self.track("one", "--method", "flight", "--flight-step-s", 1, out="flight")
        self.assertLess(self.scores("flight", "one")["rms_m"], 0.6)
        self.assertEqual(len(self.summary("flight")["targets"]), 1)

    def test_the_same_bits_come_again_also_from_standard_input(self):
        for method in ("ours", "paper-alternative"):
            self.track(*self.inputs, "--method", method, out="a")
            self.track(*self.inputs, "--method", method, out="b")
            with open(self.directory / "sim" / "observations.csv", encoding="utf-8") as feed:
                self.track(self.inputs[0], "-", "--method", method, out="c", stdin=feed)
            a, b, c = ((self.directory / out / "tracks.csv").read_bytes() for out in "abc")
            self.assertEqual(a, b)
            self.assertEqual(a, c)

    def test_nearest_neighbour_and_joint_association_are_chosen_by_name(self):
        for name, words in (("joint", "joint probabilistic"), ("nearest-neighbour", "global nearest neighbour")):
            self.track(*self.inputs, "--association", name, out=name)
            self.assertIn(words, self.summary(name)["method"])
            self.assertLess(self.scores(name)["rms_m"], 0.4)

    def test_the_options_it_writes_make_the_same_run_again(self):
        self.track(*self.inputs, "--output-s", 0.5, "--lag-s", 0.4, "--association", "nearest-neighbour", out="a")
        self.track(*self.inputs, "--config", "a/options.yaml", out="b")
        for name in ("options.yaml", "tracks.csv"):
            a, b = ((self.directory / out / name).read_bytes() for out in "ab")
            self.assertEqual(a, b, name)
        self.write("wrong.yaml", "lag: 1\n")
        self.assert_refuses(["track", "targets", *self.inputs, "--config", "wrong.yaml", "-o", "out", "--quiet"],
                            "^wrong.yaml:1: unknown .*'lag'.*lag_s")

    def test_simulates_the_same_scene_again_and_another_for_another_seed(self):
        for out, words in (("b", []), ("c", ["--seed", 2])):
            self.assert_succeeds("simulate", "targets", "--config", "sim/options.yaml", *words, "-o", out, "--quiet")
        read = {out: (self.directory / out / "observations.csv").read_bytes() for out in ("sim", "b", "c")}
        self.assertEqual(read["sim"], read["b"])
        self.assertNotEqual(read["sim"], read["c"])

    def test_cues_tell_each_receiver_where_each_target_will_be(self):
        self.track("sim", "--cue", "--cue-slew-rad-s", 2)
        cues = self.table("out/cues.csv")
        self.assertEqual({cue["receiver"] for cue in cues}, {"0", "1", "2"})
        self.assertLessEqual({"1", "2"}, {cue["target"] for cue in cues})
        self.assertTrue(all(int(cue["t_ns"]) >= int(cue["told_ns"]) for cue in cues))
        self.assertNotEqual(cues, [])

    def test_turning_and_steered_receivers_are_followed_too(self):
        for law, words in (("rotating", []), ("cued", ["--temperature-sigma-k", 2])):
            self.assert_succeeds("simulate", "targets", "--scan-law", law, "--periods", PERIODS, *words, "-o", law,
                                 "--quiet")
            self.track(law, out=f"{law}-out")
            self.assertLess(self.scores(f"{law}-out", law)["rms_m"], 0.4)
            self.track(law, "--method", "paper-proposed", out=f"{law}-paper")
            # The paper's estimates have a time for each target: they are judged together nevertheless.
            self.assertLessEqual(self.scores(f"{law}-paper", law)["moments"], PERIODS + 2)
        kelvin = [target["temperature_k"] for target in self.summary("cued-out")["targets"]]
        self.assertTrue(all(250 < value < 350 for value in kelvin), kelvin)

    def test_a_plan_needs_no_observations(self):
        done = self.track("sim/receivers.yaml", "--plan", "--plan-least-m=-40,-40,0", "--plan-greatest-m", "40,40,40",
                          "--plan-step-m", 20, "--plan-delays-s", "0,0.1,0.2")
        self.assertRegex(done.stdout, "bound of a position: median 0\\.[0-9]+ m, best .* m, worst .* m")
        places = self.table("out/placement.csv")
        self.assertEqual(len(places), 5 * 5 * 3)
        self.assertTrue(all(0.05 < float(place["rms_m"]) < 1 for place in places))
        self.assertEqual(self.summary("out")["places"], 75)
        self.assertTrue((self.directory / "out" / "placement.png").is_file())

    def test_shuffled_rows_within_a_second_change_nothing(self):
        rows = self.rows()
        shuffled = [row for i in range(0, len(rows), 2) for row in reversed(rows[i:i + 2])]
        self.track(*self.inputs, out="a")
        self.track(self.inputs[0], self.observations(shuffled), out="b")
        a, b = self.table("a/tracks.csv"), self.table("b/tracks.csv")
        self.assertEqual(len(a), len(b))
        for one, other in zip(a, b, strict=True):
            self.assertAlmostEqual(float(one["x_m"]), float(other["x_m"]), 6)

    def test_angles_may_be_in_degrees_if_the_columns_say_so(self):
        head, *rows = self.lines("sim/observations.csv")
        cells = [row.split(",") for row in rows]
        for row in cells:
            row[3:5] = (repr(math.degrees(float(cell))) for cell in row[3:5])
        self.write("degrees.csv", "\n".join([head.replace("azimuth_rad", "azimuth_deg").replace(
            "elevation_rad", "elevation_deg"), *map(",".join, cells)]) + "\n")
        self.track(self.inputs[0], "degrees.csv")
        self.assertLess(self.scores("out")["rms_m"], 0.35)

    def test_evaluates_with_another_clock_and_cutoff(self):
        self.track("sim")
        rows = self.table("out/tracks.csv")
        text = "\n".join(["t_ns,target,x_m,y_m,z_m", *(
            f"{int(row['t_ns']) + 10**12},{row['target']},{row['x_m']},{row['y_m']},{row['z_m']}" for row in rows)])
        self.write("late.csv", text + "\n")
        self.assert_refuses(["evaluate", "late.csv", "sim/truth.csv"],
                            "^late.csv: no estimate lies within the time of sim/truth.csv; set --time-offset-s$")
        done = self.assert_succeeds("evaluate", "late.csv", "sim/truth.csv", "--time-offset-s", -1000, "-o", "scores")
        self.assertIn("identity switches            0", done.stdout)
        self.assertAlmostEqual(self.summary("scores")["rms_m"], self.scores("out")["rms_m"], 9)
        self.assertTrue((self.directory / "scores" / "report.html").is_file())


class TargetStream(Targets):
    def messages(self, lines):
        hello, *middle, end = map(json.loads, lines)
        self.assertEqual((hello["type"], hello["pose"], end["type"]), ("hello", "p_world_m", "end"))
        self.assertEqual({message["type"] for message in middle} - {"target", "cue"}, set())
        for message in middle:
            if message["type"] == "target":
                self.assertEqual(len(message["p_world_m"]), 3)
                self.assertEqual([len(row) for row in message["covariance"]], [6] * 6)
                self.assertIn(message["state"], ("tentative", "confirmed", "coasting"))
        return [message for message in middle if message["type"] == "target"], end

    def test_goes_to_standard_output_alone(self):
        done = self.track(*self.inputs, "--stream", "-", "--cue")
        targets, end = self.messages(done.stdout.splitlines())
        self.assertEqual(end["tracked"], 2)
        self.assertEqual(sum('"cue"' in line for line in done.stdout.splitlines()), len(self.table("out/cues.csv")))
        written = {(row["t_ns"], row["target"]) for row in self.table("out/tracks.csv")}
        told = {(str(message["t_ns"]), str(message["target"])) for message in targets}
        self.assertGreater(len(written & told), 0.8 * len(written))

    def test_a_reader_gets_each_time_as_soon_as_it_is_known(self):
        with subprocess.Popen([PROGRAM, "track", "targets", self.inputs[0], "-", "-o", "out", "--stream", "tcp://:0"],
                              cwd=self.directory, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL) as process:
            port = int(re.fullmatch(r"live output at tcp://127.0.0.1:(\d+)\n", process.stdout.readline()).group(1))
            with socket.create_connection(("127.0.0.1", port), timeout=60) as reader, reader.makefile() as feed:
                lines = [feed.readline()]
                rows = self.lines("sim/observations.csv")
                half = next(i for i, row in enumerate(rows[1:], 1) if int(row.split(",")[0]) > 10.05e9)
                process.stdin.write("\n".join(rows[:half + 1]) + "\n")
                process.stdin.flush()
                while '"t_ns":10000000000' not in lines[-1]:  # while the feed is silent
                    lines.append(feed.readline())
                process.stdin.write("\n".join(rows[half + 1:]) + "\n")
                process.stdin.close()
                lines.extend(feed)
            process.stdout.read()
            self.assertEqual(process.wait(60), 0)
        self.messages(lines)
        self.assertEqual(len(self.summary("out")["targets"]), 2)

    def test_ctrl_c_keeps_what_there_is(self):
        for signal_number in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen([PROGRAM, "track", "targets", self.inputs[0], "-", "-o", "out", "--stream", "-"],
                                  cwd=self.directory, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL) as process:
                rows = self.lines("sim/observations.csv")
                half = next(i for i, row in enumerate(rows[1:], 1) if int(row.split(",")[0]) > 10.05e9)
                process.stdin.write("\n".join(rows[:half + 1]) + "\n")
                process.stdin.flush()
                while '"t_ns":10000000000' not in process.stdout.readline():
                    pass
                process.send_signal(signal_number)
                rest = process.stdout.read().splitlines()
                self.assertEqual(process.wait(60), 130)
            self.assertTrue(json.loads(rest[-1])["interrupted"])
            self.assertTrue(self.summary("out")["interrupted"])
            self.assertEqual(self.table("out/tracks.csv")[-1]["t_ns"], "10000000000")
            self.assertIn("interrupted", (self.directory / "out" / "report.html").read_text(encoding="utf-8"))
            self.assertFalse((self.directory / "out" / ".part").exists())


class TargetVideos(ProgramTest):
    def setUp(self):
        super().setUp()
        self.assert_succeeds("simulate", "targets", "--videos", "--targets", 1, "--receivers", 2, "--video-duration-s", 4,
                             "--video-width", 320, "--video-height", 180, "--video-focal-px", 225, "-o", "films",
                             "--quiet")
        self.videos = ["films/camera1.mkv", "films/camera2.mkv"]
        self.words = ["track", "targets", "films/receivers.yaml"]

    def test_go_from_videos_to_tracks_and_the_readings_to_the_same_ones(self):
        done = self.assert_succeeds(*self.words, *self.videos, "-o", "out")
        self.assertIn("1 target\n", done.stdout)
        scores = json.loads(self.assert_succeeds("evaluate", "out", "films", "--json").stdout.splitlines()[-1])
        self.assertLess(scores["rms_m"], 0.2)
        self.assertEqual(scores["false_identities"], 0)
        tracks = (self.directory / "out" / "tracks.csv").read_bytes()
        self.assert_succeeds("track", "targets", "films", "-o", "folder")
        self.assertEqual((self.directory / "folder" / "tracks.csv").read_bytes(), tracks)
        self.assert_succeeds(*self.words, "out/observations.csv", "-o", "again")
        self.assertEqual(len(self.summary("again")["targets"]), 1)
        with open(self.directory / "out" / "observations.csv", encoding="utf-8") as feed:
            self.assert_succeeds(*self.words, "-", "-o", "fed", stdin=feed)
        self.assertEqual(len(self.summary("fed")["targets"]), 1)

    def test_refuse_what_does_not_fit(self):
        out = ["-o", "out", "--quiet"]
        self.assert_refuses([*self.words, self.videos[0], *out],
                            "^films/camera1.mkv: 1 video for 2 receivers; give one for each receiver, in the order of "
                            "their file$")
        self.assert_refuses([*self.words, self.videos[0], "nowhere.mkv", *out], "^nowhere.mkv: ")
        self.assert_refuses([*self.words, self.videos[0], "films/report.html", *out],
                            "^films/report.html: is no readable video: ")
        text = (self.directory / "films" / "receivers.yaml").read_text(encoding="utf-8")
        self.write("large.yaml", text.replace("320", "640").replace("180", "360"))
        self.assert_refuses(["track", "targets", "large.yaml", *self.videos, *out],
                            "^films/camera1.mkv: images are 320x180 px, those of receiver 'camera1' 640x360; give the "
                            "videos in the order of the receivers, unscaled$")
        self.assertFalse((self.directory / "out").exists())

    def test_tell_where_one_is_cut_off_and_keep_the_rest(self):
        video = self.directory / self.videos[1]
        video.write_bytes(video.read_bytes()[:video.stat().st_size // 2])
        done = self.assert_succeeds(*self.words, *self.videos, "-o", "out", "--quiet")
        self.assertRegex(done.stderr, "^warning: films/camera2.mkv: .*\n$")
        self.assertIn("camera2.mkv", (self.directory / "out" / "report.html").read_text(encoding="utf-8"))


class BadTargets(Targets):
    def refuses(self, words, message):
        """One line, word for word at its begin; and nothing is left."""
        done = self.alidade("track", "targets", *words, "-o", "bad", "--quiet")
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertTrue(done.stderr.startswith(message), done.stderr)
        self.assertFalse((self.directory / "bad").exists())

    def test_receivers_that_cannot_be(self):
        text = (self.directory / "sim" / "receivers.yaml").read_text(encoding="utf-8")
        self.write("clockless.yaml", "".join(line for line in text.splitlines(True) if "clock" not in line))
        self.refuses(["clockless.yaml", self.inputs[1]],
                     "clockless.yaml:5: receiver 'receiver1' has no clock; write 'clock: {offset_s: ...}', or 'clock: "
                     "common' where it runs with the others'")
        self.write("one.yaml", text[:text.index("  - id: 1")])
        self.refuses(["one.yaml", self.inputs[1]],
                     "one.yaml: holds 1 receiver, wanted are 2; a place in space takes lines of sight from two places; ")
        self.write("two.yaml", text[:text.index("  - id: 2")])
        self.refuses(["two.yaml", self.inputs[1], "--method", "paper-proposed"],
                     "two.yaml: holds 2 receivers, wanted are 3; ")
        self.write("twice.yaml", text.replace("id: 1", "id: 0"))
        self.refuses(["twice.yaml", self.inputs[1]], "twice.yaml:12: two receivers have the id 0; give each its own")
        self.refuses(["nowhere.yaml", self.inputs[1]], "nowhere.yaml: cannot be opened: No such file or directory")

    def test_observations_that_cannot_be(self):
        first, second, *rest = self.rows()
        cells = second.split(",")

        def changed(column, text):
            return [first, ",".join([*cells[:column], text, *cells[column + 1:]]), *rest]

        head = self.lines("sim/observations.csv")[0].split(",")
        degrees = ",".join([*cells[:3], "59.2", "4.5", *cells[5:]])
        for rows, message in (
                (changed(head.index("azimuth_rad"), "nan"),
                 "observations.csv:3: column 'azimuth_rad': 'nan' is not a finite number; "),
                (changed(head.index("elevation_rad"), ""),
                 "observations.csv:3: column 'elevation_rad': '' is not a finite number; "),
                (changed(head.index("receiver"), "9"),
                 "observations.csv:3: unknown receiver 9; known are: 0, 1, 2"),
                ([first, degrees], "observations.csv:3: azimuth 59.2 rad, elevation 4.5 rad is no direction; are these "
                                   "degrees? name the columns azimuth_deg, elevation_deg"),
                (["9000000000,0,,0,0,,", "5000000000,0,,0,0,,"],
                 "observations.csv:3: time of receiver 0 goes back from 9.000000000 s to 5.000000000 s; sort the "
                 "readings by time"),
                ([first, "0,0,0"], "observations.csv:3: has 3 cells, the header names 7")):
            self.refuses([self.inputs[0], self.observations(rows[:4])], message)
        self.refuses([self.inputs[0], "nowhere.csv"], "nowhere.csv: cannot be opened: No such file or directory; ")
        self.write("empty.csv", "")
        self.refuses([self.inputs[0], "empty.csv"], "empty.csv: is empty; its first line must name the columns")
        self.write("columns.csv", "t_ns,receiver,azimut_rad,elevation_rad\n")
        self.refuses([self.inputs[0], "columns.csv"], "columns.csv:1: has no column 'azimuth_rad'; ")
        self.write("bare/receivers.yaml", (self.directory / "sim/receivers.yaml").read_text(encoding="utf-8"))
        self.refuses(["bare"], "bare/observations.csv: cannot be opened: No such file or directory; ")
        self.refuses([*self.inputs, self.inputs[1]], "sim/observations.csv: one table of observations is wanted; ")
        self.refuses([*self.inputs, "--truth", "nowhere.csv"], "nowhere.csv: cannot be opened: ")

    def test_pixels_of_another_resolution(self):
        self.write("cameras.yaml", "receivers:\n" + "".join(
            f"  - {{id: {i}, model: pinhole, resolution_px: [640, 480], intrinsics_px: {{fx: 500, fy: 500, cx: 320, "
            f"cy: 240}}, clock: common,\n     T_world_receiver: {{translation_m: [{i}, 0, 0], quaternion_wxyz: "
            f"[1, 0, 0, 0]}}}}\n" for i in (0, 1)))
        self.write("large.csv", "t_s,receiver,u_px,v_px\n0,0,320,240\n0,1,1500,700\n")
        self.refuses(["cameras.yaml", "large.csv"],
                     "large.csv:3: pixel (1500, 700) lies outside the image of 640x480 px; are the receivers those of "
                     "this recording, at its resolution?")

    def test_options_that_cannot_be(self):
        for words, message in (
                (["--lag-s", -1], "options: lag_s must be >= 0 s, got -1"),
                (["--method", "best"], "alidade track targets: --method: must be one of ours, flight, paper-alternative, "),
                (["--period-s", "nan"], "alidade track targets: --period-s: must be a finite number, got 'nan'"),
                (["--plan", "--plan-least-m", "0,0"], "options: plan.least_m must be three numbers x,y,z"),
                (["--plan", "--plan-greatest-m", "0,0,0", "--plan-least-m", "0,0,5"],
                 "options: plan.greatest_m must be >= plan.least_m in each coordinate, got 0,0,0 and 0,0,5"),
                (["--plan", "--plan-step-m", "1e-3"], "options: step_m must be so large that the grid has at most ")):
            self.refuses([*self.inputs, *words], message)
        for words, pattern in ((["--targets", 0], "^options: targets must be >= 1, got 0"),
                               (["--delays-s", "0;1"], "^options: delays_s must be numbers with commas between, got '0;1'"),
                               (["--videos", "--video-fps-hz", 0], "fps_hz must be")):
            self.assert_refuses(["simulate", "targets", *words, "-o", "bad"], pattern)

    def keeps_what_lies_before(self, message):
        done = self.alidade("track", "targets", self.inputs[0], "observations.csv", "-o", "out", "--quiet")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.splitlines(), [message])
        self.assertEqual(self.summary("out")["fault"], message)
        self.assertEqual(len(self.summary("out")["targets"]), 2)
        self.assertIn(message.split(";", maxsplit=1)[0], (self.directory / "out/report.html").read_text(encoding="utf-8"))

    def test_a_last_line_that_is_cut_off_keeps_what_lies_before(self):
        self.observations(self.rows()[:80])
        with open(self.directory / "observations.csv", "a", encoding="utf-8") as file:
            file.write("12000000000,1,")
        self.keeps_what_lies_before("observations.csv:82: the last line is cut off; was the recording broken off? "
                                    "remove the line")

    def test_a_wrong_line_in_the_middle_keeps_what_lies_before(self):
        rows = self.rows()
        self.observations([*rows[:80], "12000000000,7,,0,0,,", *rows[80:]])
        self.keeps_what_lies_before("observations.csv:82: unknown receiver 7; known are: 0, 1, 2")

    def line_up(self, place):
        """Two receivers 100 m apart on the x axis, and what they see of a target that is at place(t)."""
        self.write("two.yaml", "receivers:\n" + "".join(
            f"  - {{id: {k}, model: direction_finder, sigma_rad: 0.001, clock: common,\n     T_world_receiver: "
            f"{{translation_m: [{100 * k}, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}}}}\n" for k in (0, 1)))
        rows = ["t_s,receiver,azimuth_rad,elevation_rad"]
        for i in range(20):
            for k in (0, 1):
                x, y, z = place(i + 0.1 * k)
                x -= 100 * k
                noise = [1e-3 * math.sin(7 * i + 3 * k), 1e-3 * math.cos(5 * i + k)]
                rows.append(f"{i + 0.1 * k:.3f},{k},{math.atan2(x, z) + noise[0]:.9f},"
                            f"{math.asin(-y / math.hypot(x, y, z)) + noise[1]:.9f}")
        self.write("lined.csv", "\n".join(rows) + "\n")

    def test_no_target_where_lines_of_sight_do_not_cross(self):
        """On the receivers' own line, beside it, and so far that the lines are parallel."""
        for place in (lambda t: (300 + 10 * t, 0, 0), lambda t: (300 + 10 * t, 0.3, 0.3), lambda t: (50, 0, 4e4 - 10 * t)):
            self.line_up(place)
            for method in ("ours", "flight", "paper-alternative"):
                done = self.alidade("track", "targets", "two.yaml", "lined.csv", "--method", method, "-o", "out", "--quiet")
                self.assertEqual(done.returncode, 4, done.stderr)
                self.assertRegex(done.stderr, "^warning: lined.csv: no target was found: do lines of sight of two receivers "
                                              "cross at an angle, are poses, clocks and the period those of this "
                                              "recording\\?\n$")
                self.assertEqual(self.summary("out")["targets"], [])
                self.assertTrue((self.directory / "out" / "report.html").is_file())
        self.line_up(lambda t: (50, 0, 200 + t))
        self.assert_succeeds("track", "targets", "two.yaml", "lined.csv", "-o", "out", "--quiet")

    def test_coplanar_lines_of_sight_are_flagged_by_their_covariance(self):
        """The paper's 6x6 system is singular there: it answers nothing, or says how unsure it is."""
        self.assert_succeeds("simulate", "targets", "--elevation-rad", 0, "--periods", PERIODS, "-o", "flat", "--quiet")
        self.alidade("track", "targets", "flat", "--method", "paper-proposed", "-o", "out", "--quiet")
        truth = {}
        for row in self.table("flat/truth.csv"):
            truth.setdefault(row["t_ns"], []).append([float(row[axis]) for axis in ("x_m", "y_m", "z_m")])
        for row in self.table("out/tracks.csv"):
            place = [float(row[axis]) for axis in ("x_m", "y_m", "z_m")]
            sigma = math.sqrt(sum(float(row[f"c_{axis}_{axis}"]) for axis in "xyz"))
            error = min(math.dist(place, other) for other in truth[row["t_ns"]])
            self.assertLess(error, 5 * sigma)

    def test_says_where_there_is_nothing(self):
        self.observations([])
        done = self.alidade("track", "targets", self.inputs[0], "observations.csv", "-o", "out", "--quiet")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(done.stderr, "warning: observations.csv: holds no bearing: nothing was seen, or it is another "
                                      "file\n")

    def test_a_full_disk_is_told_and_leaves_nothing_half_done(self):
        self.track("sim", out="out")
        before = (self.directory / "out" / "tracks.csv").read_bytes()

        def fill_up():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))

        for verb, words in (("track", ["sim"]), ("simulate", [])):
            done = self.alidade(verb, "targets", *words, "-o", "out" if verb == "track" else "other", "--quiet",
                                preexec_fn=fill_up, restore_signals=False)
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertRegex(done.stderr, "^(out|other)/.part/[a-z./0-9_]+: .*File too large.*\n$")
        self.assertEqual((self.directory / "out" / "tracks.csv").read_bytes(), before)
        self.assertFalse((self.directory / "out" / ".part").exists())
        self.assertFalse((self.directory / "other").exists())


if __name__ == "__main__":
    unittest.main()
