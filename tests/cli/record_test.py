# SPDX-License-Identifier: Apache-2.0
"""devices and record: a GigE Vision camera on loopback, listed, recorded alone and beside another, interrupted."""

import contextlib
import csv
import json
import os
import signal
import subprocess
import unittest

from program import ProgramTest

CAMERA = os.environ["GIGE_TEST_CAMERA"]  # set by ctest


def address(number):
    """One of this machine's own that no other test uses at the same time."""
    return f"127.{1 + os.getpid() % 200}.{os.getpid() // 200 % 250}.{1 + number}"


@contextlib.contextmanager
def camera(number, *words):
    command = [CAMERA, "--address", address(number), "--serial", f"T{number}", "--size", "64x48", *map(str, words)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            if not process.stdout.readline().startswith("ready"):
                raise RuntimeError(f"no test camera at {address(number)}")
            yield f"genicam:{address(number)}"
        finally:
            process.kill()


class DevicesTest(ProgramTest):
    def test_a_camera_tells_its_formats_and_features(self):
        with camera(0) as source:
            done = self.assert_succeeds("devices", source)
            told = json.loads(self.assert_succeeds("devices", source, "--json").stdout.splitlines()[-1])
        self.assertRegex(done.stdout, r"serial T0")
        self.assertRegex(done.stdout, r"\n  Mono12Packed\n")
        self.assertRegex(done.stdout, r"\n    ExposureAuto = Off  \(choice\): Off, Continuous\n")
        self.assertEqual(told["cameras"][0]["serial"], "T0")

    def test_a_name_that_is_no_cameras_is_refused(self):
        self.assert_refuses(["devices", "firewire:0"], r"^firewire:0: is not a camera; name it like v4l2:")

    def test_a_device_that_is_not_there_is_a_fault_of_the_device(self):
        self.assert_refuses(["devices", "v4l2:/dev/video99"], r"^/dev/video99: open: no such device; ", code=3)


class RecordTest(ProgramTest):
    def rows(self, folder):
        with open(self.directory / folder / "frames.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_a_recording_holds_the_frames_asked_for_and_is_verified(self):
        with camera(0, "--fps", 100) as source:
            self.assert_succeeds("record", source, "-o", "session", "--frames", 20, "--codec", "ffv1")
        rows = self.rows("session")
        self.assertEqual([int(row["index"]) for row in rows], list(range(20)))
        told = self.summary("session")["cameras"][0]
        self.assertEqual((told["frames"], told["codec"], told["pixel_format"]), (20, "ffv1", "Mono8"))
        self.assertEqual((told["dropped"], told["discarded"], told["damaged"]), (0, 0, 0))
        self.assertTrue((self.directory / "session" / "report.html").is_file())
        self.assert_succeeds("verify", "session")

    def test_what_the_camera_drops_is_in_the_manifest(self):
        with camera(0, "--fps", 200, "--drop", 0.2) as source:
            self.assert_succeeds("record", source, "-o", "session", "--frames", 100)
        rows = self.rows("session")
        ids = [int(row["sequence"]) for row in rows]
        gaps = sum(after - before - 1 for before, after in zip(ids, ids[1:]))
        self.assertGreater(gaps, 5)
        self.assertEqual(sum(int(row["dropped_before"]) for row in rows), gaps)
        self.assertEqual(self.summary("session")["cameras"][0]["dropped"], gaps)

    def test_two_cameras_are_recorded_beside_each_other(self):
        with camera(0, "--fps", 50) as left, camera(1, "--fps", 25, "--clock-offset", 500) as right:
            self.assert_succeeds("record", f"left={left}", f"right={right}", "-o", "pair", "--duration", 2,
                                 "--set", "right:ExposureTime=5000")  # fmt: skip
        told = {each["name"]: each for each in self.summary("pair")["cameras"]}
        self.assertAlmostEqual(told["left"]["rate_hz"], 50, delta=1)
        self.assertAlmostEqual(told["right"]["rate_hz"], 25, delta=1)
        self.assertAlmostEqual(told["right"]["host_minus_device_s"], -500, delta=0.02)
        group = json.loads((self.directory / "pair" / "session.json").read_text(encoding="utf-8"))
        self.assertEqual([(each["folder"], each["state"]) for each in group["members"]],
                         [("left", "closed"), ("right", "closed")])
        self.assert_succeeds("verify", "pair")

    def test_an_interrupted_recording_is_closed(self):
        with camera(0, "--fps", 100) as source:
            code, _ = self.interrupt(["record", source, "-o", "session"], "recording", signal.SIGTERM)
        self.assertEqual(code, 130)
        self.assertTrue(self.summary("session")["interrupted"])
        self.assertEqual(len(self.rows("session")), self.summary("session")["cameras"][0]["frames"])
        self.assert_succeeds("verify", "session")

    def test_two_cameras_of_one_name_are_refused(self):
        self.assert_refuses(["record", "a=genicam:1", "a=genicam:2", "-o", "pair"], "^a=genicam:2: another camera has that name")

    def test_a_size_that_is_none_is_refused_before_a_camera_is_asked(self):
        self.assert_refuses(["record", "genicam:1", "-o", "session", "--camera-size", "large"],
                            "camera.size must be WIDTHxHEIGHT in px like 640x480, got 'large'")  # fmt: skip
        self.assertFalse((self.directory / "session").exists())

    def test_a_feature_that_the_camera_has_not_is_named_with_the_nearest(self):
        with camera(0) as source:
            words = ["record", source, "-o", "session", "--set", "ExposureTme=3"]
            self.assert_refuses(words, "set ExposureTme=3: the camera has no such feature; did you mean 'ExposureTime'", 3)


if __name__ == "__main__":
    unittest.main()
