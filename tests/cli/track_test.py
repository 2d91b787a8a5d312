# SPDX-License-Identifier: Apache-2.0
"""alidade track camera: what it finds in a rendered scene, keeps and refuses."""

import csv
import json
import unittest

from program import ProgramTest

SCENE = ["--width", 320, "--height", 240, "--frames", 60]


class TrackCamera(ProgramTest):
    def setUp(self):
        super().setUp()
        self.assert_succeeds("simulate", "camera", *SCENE, "-o", "scene")
        self.words = ["track", "camera", "scene", "--camera", "scene/camera.yaml", "--no-overlay"]

    def frames(self, out):
        with open(self.directory / out / "frames.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def errors(self, out, alignment="sim3"):
        done = self.assert_succeeds("evaluate", out, "scene/truth.tum", "--align", alignment, "--json")
        return next(event for event in map(json.loads, done.stdout.splitlines()) if event["event"] == "result")

    def test_finds_the_path(self):
        self.assert_succeeds(*self.words, "-o", "track")
        result = self.errors("track")
        self.assertLess(result["ape_translation_m"]["rmse"], 0.005 * result["path_length_m"])
        self.assertEqual({row["state"] for row in self.frames("track")}, {"tracked"})
        for name in ("trajectory.tum", "covariance.csv", "map.ply", "colmap/images.txt", "scene.png", "report.html",
                     "options.yaml", "camera.yaml"):
            self.assertTrue((self.directory / "track" / name).is_file(), name)

    def test_gives_the_same_bits_again(self):
        for out in ("a", "b"):
            self.assert_succeeds(*self.words, "-o", out)
        a, b = ((self.directory / out / "trajectory.tum").read_bytes() for out in "ab")
        self.assertEqual(a, b)

    def test_every_estimator_follows(self):
        for pose in ("ekf-paper", "ukf", "ekf-slam", "epnp", "epnp-lm", "sqpnp"):
            self.assert_succeeds(*self.words, "--pose", pose, "--refine", "none", "-o", pose)
            result = self.errors(pose)
            self.assertLess(result["ape_translation_m"]["rmse"], 0.05 * result["path_length_m"], pose)

    def test_given_poses_bring_metres(self):
        self.assert_succeeds(*self.words, "--init-poses", "scene/truth.tum", "-o", "metric")
        self.assertAlmostEqual(self.errors("metric")["scale"], 1.0, delta=0.01)

    def test_tracks_in_a_map_made_before(self):
        self.assert_succeeds("map", "scene", "--camera", "scene/camera.yaml", "--poses", "scene/truth.tum", "-o", "map")
        self.assert_succeeds(*self.words, "--map", "map", "-o", "located")
        result = self.errors("located", "none")
        self.assertLess(result["ape_translation_m"]["rmse"], 0.01 * result["path_length_m"])

    def test_refuses_what_cannot_work(self):
        out = ["-o", "out", "--quiet"]
        camera = ["--camera", "scene/camera.yaml"]
        self.assert_refuses(["track", "camera", "nowhere", *camera, *out], "nowhere")
        self.assert_refuses(["track", "camera", "scene", "--camera", "no.yaml", *out], "no.yaml")
        self.assert_refuses([*self.words, "--scale", "marker:-1", *out], "marker:SIDE_M")
        self.assert_refuses([*self.words, "--map", "no-map", *out], "no-map")
        self.assertFalse((self.directory / "out").exists())


if __name__ == "__main__":
    unittest.main()
