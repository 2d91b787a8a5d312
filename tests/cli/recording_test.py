# SPDX-License-Identifier: Apache-2.0
"""alidade repair and verify, and recordings as sources of other verbs."""

import json
import os
import subprocess
import unittest

from program import ProgramTest

CAMERA = """camera:
  name: synthetic
  model: pinhole
  resolution_px: [160, 120]
  intrinsics_px: {fx: 100, fy: 100, cx: 80, cy: 60}
"""


class Recording(ProgramTest):
    def record(self, folder, *words):
        subprocess.run([os.environ["SYNTHETIC_RECORDER"], folder, *map(str, words)], cwd=self.directory, check=True)

    def result(self, *words, code=0):
        done = self.alidade(*words, "--json")
        self.assertEqual(done.returncode, code, done.stderr)
        events = [json.loads(line) for line in done.stdout.splitlines()]
        return [event for event in events if event["event"] == "result"][0]

    def names(self, folder):
        return sorted(path.name for path in (self.directory / folder).iterdir())

    def test_a_good_recording_is_verified(self):
        self.record("rec")
        done = self.assert_succeeds("verify", "rec")
        self.assertRegex(done.stdout, r"^rec: 10 frames, 0\.\d MB: no fault\n$")
        recording = self.result("verify", "rec")["recordings"][0]
        self.assertEqual(recording["faults"], [])
        self.assertEqual(recording["totals"]["frames"], 10)
        self.assertTrue(recording["closed"])

    def test_a_flipped_bit_is_named_by_file_and_line(self):
        self.record("rec")
        video = self.directory / "rec" / "video.mkv"
        data = bytearray(video.read_bytes())
        data[len(data) // 2] ^= 1
        video.write_bytes(data)
        done = self.alidade("verify", "rec")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stdout, r"rec/frames.csv:\d+: ")
        self.assertRegex(done.stdout, r"rec/video.mkv: has checksum [0-9a-f]{8}, not [0-9a-f]{8}\n")
        self.assert_refuses(["verify", "rec", "--quiet"],
                            r"^rec/frames.csv:\d+: .* \(and 1 fault more\); take it from a copy of the recording$")
        self.assertEqual(len(self.result("verify", "rec", code=2)["recordings"][0]["faults"]), 2)

    def test_an_interrupted_recording_is_used_as_it_is_and_repaired(self):
        self.record("rec", "--unclosed")
        self.write("camera.yaml", CAMERA)
        done = self.assert_succeeds("undistort", "rec", "--camera", "camera.yaml", "--form", "images", "-o", "straight")
        self.assertIn("rec: was not closed (see 'alidade repair')", done.stderr)
        self.assertEqual(self.summary("straight")["frames"], 10)
        self.assert_refuses(["verify", "rec", "--quiet"],
                            "^rec/session.json: the recording was not closed; run 'alidade repair rec'$")
        done = self.assert_succeeds("repair", "rec")
        self.assertEqual(done.stdout, "rec: closed with 10 frames\n")
        self.assertEqual(self.names("rec"), ["events.csv", "frames.csv", "session.json", "video.mkv"])
        self.assert_succeeds("verify", "rec")
        self.assertEqual(self.assert_succeeds("repair", "rec").stdout, "rec: needs no repair, 10 frames\n")

    def test_half_rows_and_half_frames_are_cut_off(self):
        self.record("rec", "--unclosed")
        for name in ("frames.csv.part", "video.mkv.part"):
            path = self.directory / "rec" / name
            path.write_bytes(path.read_bytes()[:-7])
        repaired = self.result("repair", "rec", "-o", "out")["recordings"][0]
        self.assertEqual(repaired["totals"]["frames"], 9)
        self.assertGreater(repaired["cut_bytes"], 0)
        self.assertEqual(self.summary("out")["recordings"][0]["lost"], 0)
        self.assert_succeeds("verify", "rec")

    def test_the_recordings_of_several_cameras_are_done_one_by_one(self):
        self.record("both", "--member", "left", "--member", "right", "--unclosed")
        self.assert_refuses(["undistort", "both", "--camera", self.write("camera.yaml", CAMERA), "-o", "x"],
                            "both: holds the recordings of 2 cameras; name one of them: both/left")
        done = self.assert_succeeds("repair", "both")
        self.assertEqual(done.stdout, "both/left: closed with 10 frames\nboth/right: closed with 10 frames\n")
        group = json.loads((self.directory / "both" / "session.json").read_text(encoding="utf-8"))
        self.assertEqual([member["state"] for member in group["members"]], ["closed", "closed"])
        self.assertEqual(len(self.assert_succeeds("verify", "both").stdout.splitlines()), 2)

    def test_what_is_no_recording_is_refused(self):
        (self.directory / "empty").mkdir()
        for verb in ("verify", "repair"):
            self.assert_refuses([verb, "empty"], "^empty: is no recording; name a folder that 'alidade record' has written$")
            self.assert_refuses([verb, "absent"], "^absent: is no recording")
        self.record("rec")
        self.write("rec/session.json", '{"format": "alidade recording", "version": 7}')
        self.assert_refuses(["verify", "rec"], "^rec/session.json: is of version 7 of the format, known is 1; ")


if __name__ == "__main__":
    unittest.main()
