# SPDX-License-Identifier: Apache-2.0
"""--stream: what readers of a running track get, and what a bad address is answered with."""

import contextlib
import json
import re
import socket
import subprocess
import unittest

from program import PROGRAM, ProgramTest

STATES = {"tracked", "predicted", "waiting", "ambiguous", "lost"}


class Stream(ProgramTest):
    def trajectory(self, path):
        """{t_ns: (x, y, z, qx, qy, qz, qw)} of a TUM file."""
        poses = {}
        for line in (self.directory / path).read_text(encoding="utf-8").splitlines():
            if not line.startswith("#"):
                time, *pose = line.split()
                poses[round(float(time) * 1e9)] = tuple(map(float, pose))
        return poses

    def assert_is_schema(self, messages, pose_name):
        """hello, poses, end; each with what the schema says."""
        hello, *poses, end = messages
        self.assertEqual((hello["type"], hello["schema"], hello["version"]), ("hello", "alidade.live", 1))
        self.assertEqual(hello["pose"], pose_name)
        for key in ("program", "verb", "source", "clock", "sent_clock", "unit_of_length", "covariance"):
            self.assertIsInstance(hello[key], str, key)
        self.assertEqual(end["type"], "end")
        self.assertEqual(end["tracked"], sum(pose["state"] == "tracked" for pose in poses))
        for pose in poses:
            self.assertEqual((pose["type"], pose["source"]), ("pose", hello["source"]))
            self.assertIn(pose["state"], STATES)
            self.assertIsInstance(pose["t_ns"], int)
            self.assertIsInstance(pose["sent_ns"], int)
            if pose["state"] not in ("waiting", "lost"):
                self.assertEqual((len(pose[pose_name]["p_m"]), len(pose[pose_name]["q_wxyz"])), (3, 4))
                self.assertEqual([len(row) for row in pose["covariance"]], [6] * 6)
        sent = [message["sent_ns"] for message in [*poses, end]]
        self.assertEqual(sent, sorted(sent))
        return poses

    def assert_are_the_written_poses(self, poses, pose_name, path):
        written = self.trajectory(path)
        told = [pose for pose in poses if pose["state"] == "tracked"]
        self.assertGreater(len(told), 0)
        for pose in told:
            w, *v = pose[pose_name]["q_wxyz"]
            values = [*pose[pose_name]["p_m"], *v, w]
            for a, b in zip(values, written[pose["t_ns"]], strict=True):
                self.assertAlmostEqual(abs(a), abs(b), delta=2e-9)

    def lines_of(self, reader):
        with reader.makefile(encoding="utf-8") as lines:
            return [json.loads(line) for line in lines]


class BodyStream(Stream):
    FRAMES = 100

    def setUp(self):
        super().setUp()
        self.assert_succeeds("simulate", "body", "--frames", self.FRAMES, "-o", "sim")
        self.words = ["track", "body", "sim/body.csv", "sim/detectors.yaml", "-o", "out", "--lag-s", 0]

    def test_goes_to_standard_output_alone(self):
        done = self.assert_succeeds(*self.words, "sim/observations.csv", "--stream", "-")
        messages = [json.loads(line) for line in done.stdout.splitlines()]
        poses = self.assert_is_schema(messages, "T_world_body")
        self.assertEqual((len(poses), messages[-1]["frames"]), (self.FRAMES, self.FRAMES))
        self.assertEqual({pose["body"] for pose in poses}, set(messages[0]["bodies"]))
        self.assert_are_the_written_poses(poses, "T_world_body", "out/trajectory.tum")

    def test_goes_to_several_readers_that_come_and_go(self):
        rows = (self.directory / "sim" / "observations.csv").read_text(encoding="utf-8").splitlines(keepends=True)
        half = 1 + 48 * self.FRAMES // 2
        with contextlib.ExitStack() as stack:
            process = stack.enter_context(subprocess.Popen(
                [PROGRAM, *map(str, self.words), "-", "--stream", "tcp://:0"], cwd=self.directory, text=True,
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL))
            port = int(re.fullmatch(r"live output at tcp://127.0.0.1:(\d+)\n", process.stdout.readline()).group(1))
            stays, goes, never_reads = (stack.enter_context(socket.create_connection(("127.0.0.1", port), timeout=60))
                                        for _ in range(3))
            for reader in (stays, goes):
                self.assertIn(b'"hello"', reader.recv(4096))
            process.stdin.write("".join(rows[:half]))
            process.stdin.flush()
            goes.recv(4096)
            goes.close()
            process.stdin.write("".join(rows[half:]))
            process.stdin.close()
            poses = self.lines_of(stays)[:-1]
            self.assertEqual(len(poses), self.FRAMES)
            process.stdout.read()
            self.assertEqual(process.wait(60), 0)
            never_reads.close()
        self.assert_are_the_written_poses(poses, "T_world_body", "out/trajectory.tum")

    def test_a_reader_of_standard_output_may_leave(self):
        with subprocess.Popen([PROGRAM, *map(str, self.words), "sim/observations.csv", "--stream", "-"],
                              cwd=self.directory, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
            process.stdout.close()
            self.assertEqual(process.wait(60), 0)
        self.assertEqual(len(self.trajectory("out/trajectory.tum")), self.FRAMES)

    def test_refuses_addresses_that_cannot_be_had(self):
        words = [*self.words, "sim/observations.csv", "--quiet", "--stream"]
        self.assert_refuses([*words, "localhost"], "^localhost: is no address for live output: .*tcp://ADDR:PORT")
        self.assert_refuses([*words, "tcp://:99999"], "the port must be 0..65535, got '99999'")
        self.assert_refuses([*words, "tcp://no-such-host.invalid:1"], "resolve the name", 3)
        self.assert_refuses([word if word != "--quiet" else "--json" for word in words] + ["-"], "^--stream -: --json wants standard output too")
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
            self.assert_refuses([*words, f"tcp://:{port}"],
                                f"^tcp://127.0.0.1:{port}: listen: Address already in use; give another port", 3)
        self.assertFalse((self.directory / "out").exists())


class CameraStream(Stream):
    FRAMES = 40

    def setUp(self):
        super().setUp()
        self.assert_succeeds("simulate", "camera", "--width", 320, "--height", 240, "--frames", self.FRAMES, "-o",
                             "scene")
        self.words = ["track", "camera", "scene", "--camera", "scene/camera.yaml", "--no-overlay", "--refine", "none",
                      "-o", "out"]

    def test_tells_every_frame_on_standard_output(self):
        done = self.assert_succeeds(*self.words, "--stream", "-")
        messages = [json.loads(line) for line in done.stdout.splitlines()]
        poses = self.assert_is_schema(messages, "T_world_camera")
        self.assertEqual([pose["frame"] for pose in poses], list(range(self.FRAMES)))
        self.assertEqual(messages[0]["unit_of_length"], "free")
        self.assertTrue(all("reason" in pose for pose in poses if pose["state"] == "waiting"))
        self.assert_are_the_written_poses(poses, "T_world_camera", "out/trajectory.tum")

    def test_sends_datagrams(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as reader:
            reader.bind(("127.0.0.1", 0))
            reader.settimeout(60)
            with subprocess.Popen(
                    [PROGRAM, *map(str, self.words), "--stream", f"udp://127.0.0.1:{reader.getsockname()[1]}"],
                    cwd=self.directory, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                messages = [json.loads(reader.recv(65536))]
                while messages[-1]["type"] != "end":
                    messages.append(json.loads(reader.recv(65536)))
                self.assertEqual(process.wait(60), 0)
        self.assertEqual(messages[0]["type"], "hello")
        self.assertEqual(sum(message["type"] == "pose" for message in messages), self.FRAMES)


if __name__ == "__main__":
    unittest.main()
