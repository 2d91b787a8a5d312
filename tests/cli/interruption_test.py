# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and SIGTERM in the middle of a long run: all so far is kept, and the exit code says so."""

import csv
import pathlib
import signal
import sys
import unittest

from program import ROOT, ProgramTest

sys.path.insert(0, str(ROOT / "scripts"))
from figure_topics.images import BlobTexture  # noqa: E402

FRAMES = 400  # far more than are read before the signal comes


class Interruption(ProgramTest):
    def make_sequence(self):
        """A camera that turns to and fro over a handful of images, which are repeated."""
        texture = BlobTexture(700, 400, seed=1, blobs=1500)
        folder = self.directory / "images"
        folder.mkdir()
        for i in range(4):
            texture.view(self.directory / f"{i}.png", 320, 240, 300.0, 0.01 * i)
        for i in range(FRAMES):
            (folder / f"{i:04}.png").symlink_to(self.directory / f"{min(i % 6, 6 - i % 6)}.png")
        self.write("camera.txt", "fx 300 fy 300 cx 160 cy 120\n")

    def interrupted_run(self, signal_number):
        self.make_sequence()
        code, printed = self.interrupt(["track", "camera", "images", "--camera", "camera.txt", "-o", "out"],
                                       once_seen="tracking", signal_number=signal_number)
        self.assertEqual(code, 130, printed)
        self.assertTrue(self.summary("out")["interrupted"])
        self.assertFalse(pathlib.Path(self.directory, "out", ".part").exists())
        with open(self.directory / "out" / "frames.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), self.summary("out")["frames"])
        self.assertGreater(len(rows), 0)
        self.assertLess(len(rows), FRAMES)

    def test_ctrl_c_keeps_what_there_is(self):
        self.interrupted_run(signal.SIGINT)

    def test_sigterm_keeps_what_there_is(self):
        self.interrupted_run(signal.SIGTERM)


if __name__ == "__main__":
    unittest.main()
