# SPDX-License-Identifier: Apache-2.0
"""alidade evaluate: what it prints, writes and refuses."""

import csv
import json
import math
import unittest

from program import ProgramTest, data_folder


def winding(count, scale=1.0, start_s=0.0, shift=0.0):
    """A winding path in TUM form, ten poses per second."""
    lines = ["# timestamp tx ty tz qx qy qz qw\n"]
    for i in range(count):
        t = 0.1 * i
        centre = [scale * (math.cos(t) + shift), scale * math.sin(2 * t), scale * 0.3 * t]
        lines.append(f"{start_s + t:.3f} {centre[0]:.9f} {centre[1]:.9f} {centre[2]:.9f} 0 0 0 1\n")
    return "".join(lines)


def row(stdout, title):
    """The six numbers of a line of the table: rmse, mean, median, std, min, max."""
    line = next(line for line in stdout.splitlines() if line.startswith(title))
    return [float(word) for word in line.split()[-6:]]


class Evaluate(ProgramTest):
    def test_the_alignment_decides_what_is_an_error(self):
        self.write("truth.tum", winding(50))
        self.write("estimate.tum", winding(50, scale=0.5, shift=2.0))
        similar = self.assert_succeeds("evaluate", "estimate.tum", "truth.tum").stdout
        self.assertIn("alignment   sim3, scale 2.000000", similar)
        self.assertLess(row(similar, "APE translation")[5], 1e-6)
        rigid = self.assert_succeeds("evaluate", "estimate.tum", "truth.tum", "--align", "se3").stdout
        self.assertIn("alignment   se3, scale 1.000000", rigid)
        self.assertGreater(row(rigid, "APE translation")[0], 0.1)
        unaligned = self.assert_succeeds("evaluate", "estimate.tum", "truth.tum", "--align", "none").stdout
        self.assertGreater(row(unaligned, "APE translation")[0], row(rigid, "APE translation")[0])

    def test_a_result_directory_brings_its_covariances(self):
        self.write("truth.tum", winding(30))
        self.write("out/trajectory.tum", winding(30, shift=0.1))
        variances = ",".join("0.01" if i == j else "0" for i in range(6) for j in range(i, 6))
        header = "t_ns" + ",c" * 21 + "\n"
        self.write("out/covariance.csv", header + "".join(f"{i}00000000,{variances}\n" for i in range(30)))
        printed = self.assert_succeeds("evaluate", "out", "truth.tum", "--align", "none", "-o", "result").stdout
        # 0.1 m with a sigma of 0.1 m: one of six degrees of freedom is one sigma off.
        self.assertIn("NEES per degree of freedom 0.167 over 30 poses", printed)
        self.assertAlmostEqual(self.summary("result")["nees"]["mean_per_degree_of_freedom"], 1 / 6, 9)
        with open(self.directory / "result/errors.csv", encoding="utf-8") as file:
            errors = list(csv.DictReader(file))
        self.assertEqual(len(errors), 30)
        self.assertAlmostEqual(float(errors[3]["translation_m"]), 0.1, 8)
        self.assertAlmostEqual(float(errors[3]["nees"]), 1.0, 8)

    def test_results_are_a_page_pictures_and_tables(self):
        self.write("truth.tum", winding(30))
        self.assert_succeeds("evaluate", "truth.tum", "truth.tum", "-o", "result")
        names = sorted(path.name for path in (self.directory / "result").iterdir())
        self.assertEqual(names, ["errors.csv", "errors.png", "options.yaml", "path.png", "report.html", "summary.json"])
        self.assertIn("A trajectory against its truth", (self.directory / "result/report.html").read_text())

    def test_json_is_the_summary(self):
        self.write("truth.tum", winding(30))
        printed = self.assert_succeeds("evaluate", "truth.tum", "truth.tum", "--json").stdout
        events = [json.loads(line) for line in printed.splitlines()]
        result = next(event for event in events if event["event"] == "result")
        self.assertIn("ape_translation_m", json.dumps(result))

    def test_poses_without_times_are_paired_by_number(self):
        poses = [f"1 0 0 {math.cos(i)} 0 1 0 {math.sin(i)} 0 0 1 {i}\n" for i in range(10)]
        self.write("a.txt", "".join(poses))
        self.write("b.txt", "".join(poses[:9]))
        self.write("c.tum", winding(10))
        self.assertIn("associated  10 poses by number", self.assert_succeeds("evaluate", "a.txt", "a.txt").stdout)
        self.assertIn("associated  10 poses by number", self.assert_succeeds("evaluate", "c.tum", "a.txt").stdout)
        self.assert_refuses(["evaluate", "b.txt", "a.txt"],
                            r"^b\.txt: has 9 poses, a\.txt has 10: without times pose i belongs to pose i; give both")

    def test_times_that_do_not_meet_are_told_with_the_flags_that_help(self):
        self.write("truth.tum", winding(30, start_s=1000))
        self.write("estimate.tum", winding(30))
        self.assert_refuses(["evaluate", "estimate.tum", "truth.tum"],
                            r"^estimate\.tum: 0 of 30 poses lie within 0\.01 s of a pose of truth\.tum, 3 are needed; the "
                            r"nearest two are 997\.1 s apart; set --time-offset-s or --max-time-difference-s, or .*--by-index")
        for flags in (["--time-offset-s", "1000"], ["--by-index"], ["--time-offset-s", "1000.04",
                                                                    "--max-time-difference-s", "0.05"]):
            printed = self.assert_succeeds("evaluate", "estimate.tum", "truth.tum", *flags).stdout
            self.assertIn("associated  30 poses", printed)

    def test_a_straight_path_has_no_alignment(self):
        self.write("line.tum", "".join(f"{i} {i} 0 0 0 0 0 1\n" for i in range(9)))
        done = self.alidade("evaluate", "line.tum", "line.tum")
        self.assertEqual(done.returncode, 4)
        self.assertRegex(done.stderr, r"on one line.*use --align none")
        self.assert_succeeds("evaluate", "line.tum", "line.tum", "--align", "none")

    def test_bad_data_is_named_with_path_and_line(self):
        self.write("truth.tum", winding(30))
        self.write("nan.tum", winding(5) + "9 0 nan 0 0 0 0 1\n")
        self.assert_refuses(["evaluate", "nan.tum", "truth.tum"], r"^nan\.tum:7: ")
        self.write("back.tum", winding(5) + "0.2 0 0 0 0 0 0 1\n")
        self.assert_refuses(["evaluate", "truth.tum", "back.tum"], r"^back\.tum:7: times must increase")
        self.assert_refuses(["evaluate", "none.tum", "truth.tum"], r"^none\.tum: does not exist")
        self.write("estimate.tum", winding(30))
        self.write("estimate.covariance.csv", "t_ns\n5,1\n")
        self.assert_refuses(["evaluate", "estimate.tum", "truth.tum"], r"^estimate\.covariance\.csv:1: has 1 columns")
        self.assert_refuses(["evaluate", "truth.tum", "truth.tum", "--rpe-step", "0"], r"rpe_step must be > 0, got 0")

    def test_the_step_of_the_relative_error_has_a_unit(self):
        self.write("truth.tum", winding(30))
        for unit, shown in (("frames", "3 frames"), ("m", "3 m"), ("s", "3 s")):
            printed = self.assert_succeeds("evaluate", "truth.tum", "truth.tum", "--rpe-step", "3", "--rpe-unit", unit)
            self.assertIn("RPE translation [m] over " + shown, printed.stdout)

    def test_recordings_are_their_own_truth(self):
        data = data_folder()
        if not data:
            self.skipTest("the recordings are not there")
        for name, count in (("fountain", 11), ("seven-scenes", 400), ("kitti-clip", 51), ("tum-fr1-rpy", 997)):
            printed = self.assert_succeeds("evaluate", data / name, data / name).stdout
            self.assertIn(f"associated  {count} poses by time", printed)
            self.assertLess(row(printed, "APE translation")[5], 1e-6)


if __name__ == "__main__":
    unittest.main()
