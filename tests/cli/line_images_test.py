# SPDX-License-Identifier: Apache-2.0
"""Line images of blinking markers: simulated, tracked and calibrated from; what is wrong with a recording is named."""

import shutil
import unittest

from program import ProgramTest

ROWS = 600  # more than one part


class LineImages(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.recording = None

    def setUp(self):
        super().setUp()
        if LineImages.recording is None:
            LineImages.recording = ProgramTest()
            LineImages.recording.setUp()
            LineImages.addClassCleanup(LineImages.recording.doCleanups)
            LineImages.recording.assert_succeeds("simulate", "body", "--line-images", "--frames", ROWS, "-o", "sim")
        shutil.copytree(LineImages.recording.directory / "sim", self.directory / "sim")
        self.images = self.directory / "sim" / "line_images"
        self.inputs = ["sim/body.csv", "sim/detectors.yaml"]
        self.words = ["track", "body", *self.inputs, "sim/line_images", "--quiet", "-o", "out"]

    def tracked(self, out):
        return self.summary(out)["bodies"][0]["tracked"]

    def test_gives_poses_and_the_readings_they_are_of(self):
        self.assert_succeeds(*self.words)
        self.assertEqual(self.tracked("out"), ROWS)
        signals = self.summary("out")["signals"]
        self.assertEqual([signal["detector"] for signal in signals], list(range(12)))
        for signal in signals:
            self.assertEqual(signal["rows"], ROWS)
            self.assertGreater(signal["identified"], 0.9 * signal["spots"])
        self.assert_succeeds("track", "body", *self.inputs, "out/readings.csv", "-o", "again")
        poses = [(self.directory / name / "poses.csv").read_text(encoding="utf-8") for name in ("out", "again")]
        self.assertEqual(*poses)
        self.assert_succeeds("track", "body", *self.inputs, "sim/observations.csv", "-o", "exact")
        self.assertEqual(self.tracked("exact"), ROWS)

    def test_finds_the_width_and_the_noise_that_are_not_given(self):
        index = self.images / "lines.yaml"
        kept = [line for line in index.read_text(encoding="utf-8").splitlines()
                if not line.startswith(("spot_sigma_px", "noise"))]
        index.write_text("\n".join(kept) + "\n", encoding="utf-8")
        self.assert_succeeds(*self.words)
        self.assertEqual(self.tracked("out"), ROWS)

    def test_calibrates_detectors(self):
        self.assert_succeeds("calibrate", "detectors", *self.inputs, "sim/line_images", "--end", 1, "--verify-start", 1,
                             "-o", "calibration")
        windows = self.summary("calibration")["verification"]["windows"]
        self.assertEqual(windows["explained_share"], 1)

    def test_keeps_what_came_before_a_fault(self):
        (self.images / "detector_3_1.png").unlink()
        self.assert_refuses(self.words, r"line_images/detector_3_0\.png: ends after row 512, detector_\d+_1\.png goes on; ")
        self.assertGreater(self.tracked("out"), 400)
        whole = (self.images / "detector_4_1.png").read_bytes()
        (self.images / "detector_3_1.png").write_bytes(whole[:len(whole) // 2])
        self.assert_refuses(self.words, r"line_images/detector_3_1\.png: is a PNG that is cut off; ")

    def test_names_what_does_not_belong_together(self):
        index = self.images / "lines.yaml"
        text = index.read_text(encoding="utf-8")
        index.write_text(text.replace("id: 3", "id: 9"), encoding="utf-8")
        self.assert_refuses(self.words, r"lines\.yaml: marker 9 is on no body; list it")
        index.write_text(text.replace("1111111100110", "1111101011110"), encoding="utf-8")
        self.assert_refuses(self.words, r"lines\.yaml: markers 0 and 1 cannot be told apart")
        index.write_text(text, encoding="utf-8")
        shutil.copy(self.images / "detector_3_0.png", self.images / "detector_33_0.png")
        self.assert_refuses(self.words, r"detector_33_0\.png: there is no detector 33; ")
        (self.images / "detector_33_0.png").unlink()
        rig = self.directory / "sim" / "detectors.yaml"
        rig.write_text(rig.read_text(encoding="utf-8").replace("width_px: 2048", "width_px: 4096"), encoding="utf-8")
        self.assert_refuses(self.words, r"detector_0_0\.png: is 2048 px wide, detector 0 is 4096; ")
        self.assert_refuses(["simulate", "body", "--line-images", "--wrong-ids", 0.1, "-o", "other"],
                            "wrong_ids: in line images ")


if __name__ == "__main__":
    unittest.main()
