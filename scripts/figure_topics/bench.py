# SPDX-License-Identifier: Apache-2.0
"""Where figures are measured: runs the program, keeps what it leaves, finds recordings and other programs."""

import dataclasses
import json
import os
import pathlib
import shutil
import subprocess
import time

from figure_topics.figure import Failed, Skipped
from figure_topics.tables import rows_of

ROOT = pathlib.Path(__file__).resolve().parents[2]


@dataclasses.dataclass(frozen=True)
class Run:
    code: int
    stdout: str
    stderr: str
    seconds: float


def last_line(text):
    lines = text.strip().splitlines()
    return lines[-1] if lines else ""


class Bench:
    def __init__(self):
        self.program = ROOT / "build" / "release" / "bin" / "alidade"
        self.folder = ROOT / "build" / "figures"
        self.folder.mkdir(parents=True, exist_ok=True)
        self._kept = {}

    def data(self, name):
        """The folder of a recording; Skipped where it is absent."""
        place = pathlib.Path(os.environ.get("ALIDADE_DATA") or ROOT.parent / "shared" / "data") / name
        if not place.exists():
            raise Skipped(f"no {name} in $ALIDADE_DATA or ../shared/data")
        return place

    def fresh(self, name):
        """An empty folder for the results of one run."""
        place = self.folder / name
        shutil.rmtree(place, ignore_errors=True)
        place.parent.mkdir(parents=True, exist_ok=True)
        return place

    def run(self, *words, code=0, **keywords):
        """A finished process; Failed where it ends with another exit code (None: any)."""
        start = time.monotonic()
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, errors="replace",
                              check=False, stdin=subprocess.DEVNULL, **keywords)
        if code is not None and done.returncode != code:
            asked = " ".join([pathlib.Path(words[0]).name, *map(str, words[1:4])])
            raise Failed(f"'{asked} ...' exits {done.returncode}: {last_line(done.stderr)}")
        return Run(done.returncode, done.stdout, done.stderr, time.monotonic() - start)

    def alidade(self, *words, code=0):
        if not self.program.exists():
            raise Failed("build/release/bin/alidade is missing; run ./scripts/build release alidade")
        return self.run(self.program, *words, code=code)

    def track(self, source, camera, name, *words, code=0):
        """Result folder and run of `alidade track camera`; a run of the same name is made once."""
        if name not in self._kept:
            out = self.fresh(name)
            run = self.alidade("track", "camera", source, "--camera", camera, "-o", out, *words, code=code)
            self._kept[name] = (out, run)
        return self._kept[name]

    def evaluate(self, estimate, truth, *words):
        """The summary of `alidade evaluate` (--align none|se3|sim3)."""
        run = self.alidade("evaluate", estimate, truth, "--json", *words)
        events = [json.loads(line) for line in run.stdout.splitlines()]
        return next(event for event in events if event["event"] == "result")

    def scene(self, name="scene", *words):
        """A rendered scene with truth; the same name is rendered once."""
        if name not in self._kept:
            out = self.fresh(name)
            self._kept[name] = (out, self.alidade("simulate", "camera", "-o", out, *words))
        return self._kept[name][0]


def summary(result):
    return json.loads((result / "summary.json").read_text(encoding="utf-8"))


def frames(result):
    """The rows of frames.csv: one per image, with index, state (waiting, tracked, predicted, lost) and reason."""
    return rows_of(result / "frames.csv")


def pose_count(trajectory):
    with open(trajectory, encoding="utf-8") as file:
        return sum(1 for line in file if line.strip() and not line.startswith("#"))
