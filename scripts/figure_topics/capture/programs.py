# SPDX-License-Identifier: Apache-2.0
"""The test programs that figures of capture run, and the camera on loopback."""

import contextlib
import json
import subprocess

from figure_topics.bench import ROOT
from figure_topics.figure import Failed

TESTS = ROOT / "build" / "release" / "tests"
CAMERA = TESTS / "support" / "gige_camera" / "gige_test_camera"


def program(path):
    """A test program below build/release/tests; Failed where it is not built."""
    whole = TESTS / path
    if not whole.exists():
        raise Failed(f"{whole.relative_to(ROOT)} is missing; run ./scripts/build release {whole.name}")
    return whole


def json_lines(text):
    return [json.loads(line) for line in text.splitlines() if line.startswith("{")]


@contextlib.contextmanager
def test_camera(address, *words):
    """A GigE Vision camera on loopback while the block runs; yields its process, whose standard input takes commands."""
    command = [program(CAMERA), "--address", address, *map(str, words)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as camera:
        try:
            if not camera.stdout.readline().startswith("ready"):
                raise Failed(f"no test camera at {address}: is another one there?")
            yield camera
        finally:
            camera.kill()
