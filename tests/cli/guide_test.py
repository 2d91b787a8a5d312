# SPDX-License-Identifier: Apache-2.0
"""alidade guide: a session before the camera in, the views that a calibration needs out."""

import csv
import json
import unittest

from program import ProgramTest

BOARD = "chessboard:9x6:25mm"


class Guide(ProgramTest):
    def setUp(self):
        super().setUp()
        self.assert_succeeds("simulate", "board", "--board", BOARD, "--images", 30, "-o", "boards")

    def film(self, out, frames_per_image, images):
        """Each image for some frames, 25 in a second."""
        rows = ["t_ns,image"]
        for frame in range(images * frames_per_image):
            rows.append(f"{frame * 40000000},{frame // frames_per_image:06}.png")
        folder = self.directory / out
        folder.mkdir()
        for image in range(images):
            (folder / f"{image:06}.png").symlink_to(self.directory / "boards" / "images" / f"{image:06}.png")
        self.write(f"{out}/frames.csv", "\n".join(rows) + "\n")

    def test_stops_when_it_is_enough_and_the_views_calibrate(self):
        done = self.assert_succeeds("guide", "boards/images", "--board", BOARD, "-o", "out")
        summary = self.summary("out")
        self.assertTrue(summary["is_enough"], summary["missing"])
        self.assertEqual(summary["missing"], [])
        self.assertLess(summary["frames"], 30)
        self.assertLess(summary["estimate"]["worst_px"], 0.2)
        self.assertRegex(done.stdout, r"view 1 taken \(000000.png\); hold the board at the \w+ \w+, its \w+ side 30 deg")
        self.assertIn("that is enough", done.stdout)
        with open(self.directory / "out" / "views.csv", newline="", encoding="utf-8") as file:
            views = list(csv.DictReader(file))
        self.assertEqual(len(views), summary["accepted"])
        for view in views:
            self.assertTrue((self.directory / "out" / view["image"]).is_file(), view)
        for name in ("options.yaml", "report.html"):
            self.assertTrue((self.directory / "out" / name).is_file(), name)
        self.assert_succeeds("calibrate", "camera", "out/images", "--board", BOARD, "-o", "calibration")

    def test_streams_an_object_for_every_frame(self):
        done = self.assert_succeeds("guide", "boards/images", "--board", BOARD, "--stream", "-o", "out")
        events = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([event["frame"] for event in events], list(range(self.summary("out")["frames"])))
        self.assertEqual({event["event"] for event in events}, {"guide"})
        self.assertEqual(len(events[0]["wish"]["outline_px"]), 4)
        self.assertNotIn("estimate", events[0])
        self.assertIn("estimate", events[-1])
        self.assertNotIn("wish", events[-1])
        self.assertTrue(events[-1]["is_enough"])

    def test_of_a_film_takes_each_view_where_the_board_rests(self):
        self.film("film", frames_per_image=12, images=2)
        done = self.assert_succeeds("guide", "film", "--board", BOARD, "--stream", "-o", "out")
        events = [json.loads(line) for line in done.stdout.splitlines()]
        states = [event["state"] for event in events]
        self.assertEqual(states[:12], ["moving"] + 7 * ["still"] + ["accepted"] + 3 * ["repeated"])
        self.assertEqual(states.count("accepted"), 2)
        summary = self.summary("out")
        self.assertFalse(summary["is_enough"])
        self.assertIn("the views do not tell the focal length", summary["missing"])
        self.assertIn("the views are not enough yet: ", done.stderr)

    def test_refuses_films_without_a_still_board(self):
        self.film("film", frames_per_image=1, images=2)
        self.assert_refuses(["guide", "film", "--board", BOARD, "-o", "no", "--quiet"],
                            "^film: the board never rests for 0.3 s; hold it still after each move; ")
        self.assert_refuses(["guide", "film", "--board", "chessboard:7x5:25mm", "-o", "no", "--quiet"],
                            "^film: no chessboard of 7x5 .* in any of 2 frames; check --board")
        self.assert_refuses(["guide", "film", "--board", BOARD, "--enough-px", 0, "-o", "no", "--quiet"],
                            "enough_px must be > 0 px, got 0")
        self.assertFalse((self.directory / "no").exists())


if __name__ == "__main__":
    unittest.main()
