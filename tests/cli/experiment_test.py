# SPDX-License-Identifier: Apache-2.0
"""alidade experiment camera on recordings and objects, experiment body and targets: what they make of it, what they
refuse."""

import unittest

import recorded_scene
from program import ProgramTest


class ExperimentOnRecording(ProgramTest):
    def setUp(self):
        super().setUp()
        recorded_scene.write(self.directory / "scene")

    def test_tracks_in_a_map_of_other_frames(self):
        self.assert_succeeds("experiment", "camera", "--only", "known-map", "--video", "scene", "-o", "out")
        result = self.summary("out")["known-map"]
        self.assertEqual(result["frames"], 20)  # of 24: two are the map's, two start the paper's filter
        self.assertEqual(result["lost"], {"ours, causal": [], "RANSAC-EPnP + LM": []})
        for method in ("ours, causal", "RANSAC-EPnP + LM"):
            self.assertLess(result[method]["position_m"]["rmse"], 0.005, method)
        for name in ("known_map.png", "known-map_1.csv", "report.html"):
            self.assertTrue((self.directory / "out" / name).is_file(), name)

    def test_starts_stills_from_two_true_poses(self):
        self.assert_succeeds("experiment", "camera", "--only", "stills", "--stills", "scene", "-o", "out")
        result = self.summary("out")["stills"]
        self.assertEqual(result["ours"]["frames_lost"], 0)
        for name in ("stills.png", "stills_ours.png", "stills_1.csv", "report.html"):
            self.assertTrue((self.directory / "out" / name).is_file(), name)

    def test_refuses_what_is_not_given(self):
        words = ["experiment", "camera", "--only"]
        self.assert_refuses([*words, "known-map"], "known-map: needs a recording; .*--video FOLDER")
        self.assert_refuses([*words, "stills"], "stills: needs a recording; .*--stills FOLDER")
        self.assert_refuses([*words, "known-map", "--video", "nowhere"], "nowhere")

    def test_says_what_a_recording_lacks(self):
        words = ["experiment", "camera", "--quiet", "--only"]
        (self.directory / "scene" / "depth.txt").unlink()
        self.assert_refuses([*words, "known-map", "--video", "scene"], "scene: has no depth images; give .*TUM RGB-D")
        (self.directory / "scene" / "groundtruth.txt").unlink()
        self.assert_refuses([*words, "stills", "--stills", "scene"], "scene: has no true poses; give .*Strecha")


PLY = """ply
format ascii 1.0
element vertex {count}
property float x
property float y
property float z
end_header
{rows}
"""


class ExperimentOnObject(ProgramTest):
    def write_object(self, count):
        rows = "\n".join(f"{i % 3} {i % 5} {i * i % 7}" for i in range(count))
        (self.directory / "object.ply").write_text(PLY.format(count=count, rows=rows), encoding="utf-8")
        return ["experiment", "camera", "--only", "outliers", "--runs", "2", "--points", "object.ply"]

    def test_takes_the_vertices_of_a_ply(self):
        self.assert_succeeds(*self.write_object(100), "-o", "out", "--quiet")
        shares = self.summary("out")["outliers"]
        for share in ("30", "50"):
            self.assertLess(shares[share]["ours, causal"]["position_ratio"]["value"], 2.0)
        self.assertTrue((self.directory / "out" / "report.html").is_file())

    def test_refuses_what_is_no_object(self):
        self.assert_refuses(self.write_object(9), "object.ply: has 9 vertices, 10 are needed; give the PLY")
        (self.directory / "object.ply").write_text("solid", encoding="utf-8")
        self.assert_refuses(["experiment", "camera", "--points", "object.ply"], "object.ply")
        self.assert_refuses(["experiment", "camera", "--points", "nothing.ply"], "nothing.ply")
        self.assert_refuses(["experiment", "camera", "--runs", "0"], "runs must be >= 1, got 0")


class ExperimentOnBodies(ProgramTest):
    words = ("experiment", "body", "--frames", "300", "--quiet")

    def test_agrees_with_derivatives_and_other_solvers(self):
        self.assert_succeeds(*self.words, "--only", "solvers", "-o", "out")
        result = self.summary("out")["solvers"]
        self.assertLess(max(result["derivatives"].values()), 1e-9)
        self.assertLess(max(result["exact"].values()), 1e-12)
        self.assertLess(max(result["agreement"].values()), 1e-8)
        for name in ("solvers_1.csv", "options.yaml", "report.html"):
            self.assertTrue((self.directory / "out" / name).is_file(), name)

    def test_stays_at_the_bound_among_wrong_ids_where_the_paper_fails(self):
        self.assert_succeeds(*self.words, "--only", "wrong-ids", "-o", "out")
        result = self.summary("out")["wrong-ids"]["30"]
        self.assertLess(result["ours"]["position_to_bound"], 1.05)
        self.assertLess(result["ours"]["worst_m"], 0.005)
        self.assertGreater(result["paper"]["position_to_bound"], 10)
        self.assertTrue((self.directory / "out" / "wrong-ids.png").is_file())

    def test_is_not_certain_of_a_wrong_start(self):
        self.assert_succeeds(*self.words, "--only", "start", "-o", "out")
        result = self.summary("out")["start"]
        self.assertEqual(result["any readings, 4 markers"]["certain_wrong"], 0)
        self.assertGreater(result["any readings, 4 markers"]["certain"], 270)
        self.assertGreater(result["2+2+2"]["ambiguous"], 270)
        self.assertEqual(result["2+2+2"]["ambiguous_without_truth"], 0)

    def test_refuses_too_few_frames(self):
        self.assert_refuses(["experiment", "body", "--frames", "5"], "frames must be >= 100, got 5")


class ExperimentOnTargets(ProgramTest):
    words = ("experiment", "targets", "--quiet", "--only")

    def test_recreates_the_papers_tables_with_the_batch_beside(self):
        self.assert_succeeds(*self.words, "tables", "--runs", "60", "-o", "out")
        cells = self.summary("out")["tables"]
        self.assertEqual(len(cells), 8)
        near = cells["proposed m=1 .3/.4"]
        self.assertAlmostEqual(near["orthogonal_bound_m"], 0.52, delta=0.005)
        self.assertAlmostEqual(near["on_vectors"]["d_mean_m"]["value"], 0.16, delta=0.04)
        self.assertGreater(near["on_bearings"]["d_mean_m"]["value"], 0.3)
        self.assertLess(near["batch_to_paper"], 0.3)
        self.assertTrue((self.directory / "out" / "tables_1.csv").is_file())

    def test_formulas_hold_under_their_own_noise(self):
        self.assert_succeeds(*self.words, "formulas", "-o", "out")
        result = self.summary("out")["formulas"]
        for value in [v for pair in result["pair"].values() for v in pair["white"]]:
            self.assertAlmostEqual(value, 1, delta=0.03)
        for one in result["several"].values():
            self.assertAlmostEqual(one["white"], 1, delta=0.03)

    def test_the_tracker_does_not_mind_the_order_of_arrival(self):
        self.assert_succeeds(*self.words, "tracker", "--runs", "10", "-o", "out")
        result = self.summary("out")["tracker"]
        for targets in ("2 targets", "5 targets"):
            in_order, shuffled = (result["standard"][name] for name in (targets, f"{targets}, shuffled within 1 s"))
            self.assertLess(shuffled["moved_by_shuffling_m"], 1e-9)
            self.assertEqual(shuffled["rms_m"], in_order["rms_m"])
            self.assertLess(in_order["to_true_association"], 1.1)
        self.assertEqual(len(result["sweeps"]), 8)

    def test_cues_hold_their_covariance(self):
        self.assert_succeeds(*self.words, "cue", "--runs", "100", "-o", "out")
        for flight in self.summary("out")["cue"].values():
            self.assertGreater(flight["1"]["within_95"], 0.88)
            self.assertGreater(flight["1"]["rms_mrad"], flight["0.1"]["rms_mrad"])

    def test_refuses_too_few_runs(self):
        self.assert_refuses(["experiment", "targets", "--runs", "5"], "runs must be >= 10, got 5")


if __name__ == "__main__":
    unittest.main()
