# SPDX-License-Identifier: Apache-2.0
"""alidade track body: what it finds in a simulated recording, keeps and refuses."""

import csv
import json
import signal
import subprocess
import unittest

from program import PROGRAM, ProgramTest

FRAMES = 250


class TrackBody(ProgramTest):
    def setUp(self):
        super().setUp()
        self.assert_succeeds("simulate", "body", "--frames", FRAMES, "-o", "sim")
        self.inputs = ["track", "body", "sim/body.csv", "sim/detectors.yaml"]
        self.words = [*self.inputs, "sim/observations.csv"]

    def lines(self, name):
        return (self.directory / name).read_text(encoding="utf-8").splitlines()

    def poses(self, out):
        with open(self.directory / out / "poses.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def position_error(self, out, truth="sim/truth.tum"):
        done = self.assert_succeeds("evaluate", out, truth, "--align", "none", "--json")
        result = next(event for event in map(json.loads, done.stdout.splitlines()) if event["event"] == "result")
        return result["ape_translation_m"]["rmse"]

    def observations(self, rows):
        """A file with the head of the simulated observations and these rows."""
        return self.write("observations.csv", "\n".join([self.lines("sim/observations.csv")[0], *rows]) + "\n")

    def test_finds_the_path_and_leaves_its_files(self):
        done = self.assert_succeeds(*self.words, "-o", "out")
        self.assertIn(f"body1: {FRAMES} tracked, 0 ambiguous, 0 lost, of {FRAMES} batches", done.stdout)
        self.assertLess(self.position_error("out/trajectory.tum"), 2e-4)
        for name in ("poses.csv", "covariance.csv", "markers.trc", "residuals.csv", "scene.png", "plots.png",
                     "report.html", "options.yaml", "body.csv", "detectors.yaml"):
            self.assertTrue((self.directory / "out" / name).is_file(), name)
        body = self.summary("out")["bodies"][0]
        self.assertEqual((body["tracked"], body["lost"]), (FRAMES, 0))
        self.assertGreater(body["readings_explained"], 0.99)
        self.assertEqual(self.lines("out/markers.trc")[2].split("\t")[2:5], [str(FRAMES), "4", "m"])
        residuals = list(csv.DictReader(self.lines("out/residuals.csv")))
        self.assertEqual(len(residuals), 12 + 4)
        self.assertTrue(all(0.8 < float(row["rms_sigma"]) < 1.2 for row in residuals))

    def test_gives_the_same_bits_again_also_from_standard_input(self):
        self.assert_succeeds(*self.words, "-o", "a")
        with open(self.directory / "sim" / "observations.csv", encoding="utf-8") as feed:
            self.assert_succeeds(*self.inputs, "-", "-o", "b", stdin=feed)
        for name in ("trajectory.tum", "covariance.csv", "poses.csv", "markers.trc", "residuals.csv"):
            a, b = ((self.directory / out / name).read_bytes() for out in "ab")
            self.assertEqual(a, b, name)

    def test_smoothing_helps_and_the_paper_tracks_too(self):
        self.assert_succeeds(*self.words, "-o", "smoothed")
        self.assert_succeeds(*self.words, "--lag-s", 0, "-o", "causal")
        self.assertLess(self.position_error("smoothed/trajectory.tum"), self.position_error("causal/trajectory.tum"))
        self.assert_succeeds(*self.words, "--method", "paper", "-o", "paper")
        self.assertLess(self.position_error("paper/trajectory.tum"), 1e-3)
        self.assertEqual(self.poses("paper")[-1]["sigma_x_m"], "")

    def test_two_bodies_in_one_stream_are_as_exact_as_each_alone(self):
        self.assert_succeeds("simulate", "body", "--frames", 100, "--bodies", 2, "-o", "two")
        words = ["two/detectors.yaml", "two/observations.csv"]
        self.assert_succeeds("track", "body", "two/body.csv", *words, "-o", "both")
        head, *rows = self.lines("two/body.csv")
        markers = {row.split(",")[head.split(",").index("marker")] for row in rows if "body2" in row}
        self.write("alone.csv", "\n".join([head, *(row for row in rows if "body2" in row)]) + "\n")
        head, *rows = self.lines("two/observations.csv")
        column = head.split(",").index("marker")
        alone = [row for row in rows if row.split(",")[column] in markers]
        self.write("alone_observations.csv", "\n".join([head, *alone]) + "\n")
        self.assert_succeeds("track", "body", "alone.csv", "two/detectors.yaml", "alone_observations.csv", "-o", "one")
        self.assertEqual(self.lines("both/body2.tum"), self.lines("one/trajectory.tum"))
        self.assertEqual(len(self.poses("both")), 200)

    def test_streams_poses_as_json_lines(self):
        done = self.assert_succeeds(*self.words, "--stream", "-", "--start", 0.2, "--end", 0.3, "--quiet", "-o", "out")
        events = [json.loads(line) for line in done.stdout.splitlines()][1:-1]
        self.assertEqual([event["t_ns"] for event in events], list(range(200_000_000, 300_000_001, 4_000_000)))
        self.assertEqual({event["state"] for event in events}, {"tracked"})
        self.assertEqual(len(self.poses("out")), len(events))

    def test_refuses_bad_input_word_for_word(self):
        out = ["-o", "out", "--quiet"]
        row = "0,0,0,0.1"
        for rows, message in (
                ([row, "0,0,77,0.1"], "observations.csv:3: marker 77 belongs to no body; known are: 0, 1, 2, 3"),
                ([row, "0,99,0,0.1"], "observations.csv:3: unknown detector 99; known are: 0, 1, 2, "),
                ([row, "0,0,0,nan"], "observations.csv:3: column 'value_rad': 'nan' is not a finite number"),
                (["5000,0,0,0.1", "4000,0,0,0.1"],
                 "observations.csv:3: time goes back from 0.000005000 s to 0.000004000 s; sort the readings by time"),
                ([row, "0,0,0"], "observations.csv:3: has 3 cells, the header names 4")):
            self.observations(rows)
            done = self.alidade(*self.inputs, "observations.csv", *out)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertEqual(done.stdout, "")
            self.assertTrue(done.stderr.splitlines()[-1].startswith(message), done.stderr)
            self.assertFalse((self.directory / "out").exists())
        self.write("columns.csv", "t_ns,detector,value_rad\n")
        self.assert_refuses([*self.inputs, "columns.csv", *out], r"columns.csv:1: .*marker")
        self.write("empty.csv", "marker,x_m,y_m,z_m\n")
        self.assert_refuses(["track", "body", "empty.csv", *self.words[3:], *out], "empty.csv: ")
        self.assert_refuses([*self.inputs, "nowhere.csv", *out], "nowhere.csv: cannot be opened: No such file")
        self.assert_refuses(["track", "body", "sim/body.csv", "nowhere.yaml", self.words[4], *out], "nowhere.yaml: ")
        self.assert_refuses([*self.words, "--batch-s", 0, *out], "batch_s must be > 0 s and <= 1 s, got 0")
        self.assertFalse((self.directory / "out").exists())

    def keeps_what_was_tracked(self, message):
        done = self.alidade(*self.inputs, "observations.csv", "-o", "out", "--quiet")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.splitlines()[-1], message)
        self.assertEqual(self.summary("out")["fault"], message)
        self.assertEqual(len(self.poses("out")), 100)
        self.assertEqual(len([line for line in self.lines("out/trajectory.tum") if line[0] != "#"]), 100)

    def test_a_wrong_line_in_the_middle_keeps_what_was_tracked(self):
        rows = self.lines("sim/observations.csv")[1:1 + 100 * 48]
        self.observations([*rows, rows[0], *rows])
        self.keeps_what_was_tracked("observations.csv:4802: time goes back from 0.396000000 s to 0.000000000 s; sort "
                                    "the readings by time")

    def test_a_last_line_that_is_cut_off_keeps_what_was_tracked(self):
        rows = self.lines("sim/observations.csv")[:1 + 100 * 48]
        self.write("observations.csv", "\n".join(rows) + "\n400000000,3")
        self.keeps_what_was_tracked("observations.csv:4802: the last line is cut off; was the recording broken off? "
                                    "remove the line")

    def test_says_where_there_is_no_answer(self):
        for rows in (["0,0,0,0.1"], []):
            self.observations(rows)
            done = self.alidade(*self.inputs, "observations.csv", "-o", "out", "--quiet")
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertTrue((self.directory / "out" / "report.html").is_file())

    def interrupted_feed(self, signal_number):
        """A live feed that goes on; the signal comes while it is silent."""
        with subprocess.Popen([PROGRAM, *self.inputs, "-", "-o", "out", "--stream", "-"], cwd=self.directory, text=True,
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
            rows = self.lines("sim/observations.csv")[:1 + 100 * 48]
            process.stdin.write("\n".join(rows) + "\n")
            process.stdin.flush()
            seen = [process.stdout.readline() for _ in range(1 + 99)]  # hello; the last batch waits for its end
            process.send_signal(signal_number)
            rest = process.stdout.read().splitlines()
            self.assertEqual(process.wait(60), 130)
        self.assertEqual(len(seen) + len(rest), 1 + 100 + 1)
        self.assertTrue(self.summary("out")["interrupted"])
        self.assertEqual(len(self.poses("out")), 100)
        self.assertFalse((self.directory / "out" / ".part").exists())

    def test_ctrl_c_keeps_what_there_is(self):
        self.interrupted_feed(signal.SIGINT)

    def test_sigterm_keeps_what_there_is(self):
        self.interrupted_feed(signal.SIGTERM)


if __name__ == "__main__":
    unittest.main()
