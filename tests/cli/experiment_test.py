# SPDX-License-Identifier: Apache-2.0
"""alidade experiment camera on recordings: what it makes of them, and what it refuses."""

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


if __name__ == "__main__":
    unittest.main()
