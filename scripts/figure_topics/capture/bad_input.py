# SPDX-License-Identifier: Apache-2.0
"""Cameras and files that cannot be captured from: one clear line, the right exit code."""

import contextlib
import os
import re
import stat
import subprocess
import time

from figure_topics.capture.programs import test_camera
from figure_topics.figure import Fact, Figure, Section
from figure_topics.images import BlobTexture, write_png
from figure_topics.main_job.bad_input import write_camera

BAD_INPUT, DEVICE = 2, 3
ADDRESS = "127.0.0.41"

# Exit code, and what the line must speak of.
EXPECTED = {
    "no-such-device": (DEVICE, "video99: open: no such device; "),
    "no-permission": (DEVICE, "denied|permission"),
    "device-busy": (DEVICE, "another program|controls"),
    "unsupported-size": (DEVICE, "Width=5000: is out of range; it takes 1 to"),
    "not-a-camera": (DEVICE, "/dev/null: open: this is no camera; "),
    "unreachable-address": (DEVICE, r"127\.0\.0\.77: open: .*answers.*; check"),
    "full-disk": (DEVICE, "disk full; [1-9][0-9]* frames are safe in "),
    "truncated-video": (BAD_INPUT, "cut.mp4"),
    "damaged-recording": (BAD_INPUT, "frames.csv:[0-9]+: its frame is not in the video"),
    "empty-directory": (BAD_INPUT, "empty.*no image"),
    "mixed-image-sizes": (BAD_INPUT, "0001.png.*320x240"),
}


def judge(name, run):
    code, speaks_of = EXPECTED[name]
    lines = [line for line in run.stderr.strip().splitlines() if not line.startswith("recording ")] or [""]
    good = run.code == code and len(lines) == 1 and bool(re.search(speaks_of, lines[0]))
    return f"bad-input/{name}", Fact(f"exit {run.code}, {len(lines)} line: {lines[0]}", good)


def record(bench, name, source, *words, by=()):
    out = bench.fresh(f"capture/bad-input/{name}-out")
    return bench.run(*by, bench.program, "record", source, "-o", out, "--frames", 5, *words, code=None)


@contextlib.contextmanager
def forbidden_device(folder):
    node = folder / "forbidden"
    os.mknod(node, 0o600 | stat.S_IFCHR, os.makedev(81, 0))
    try:
        yield node
    finally:
        node.unlink()


@contextlib.contextmanager
def small_disk(bench, folder):
    folder.mkdir(parents=True)
    bench.run("mount", "-t", "tmpfs", "-o", "size=20m", "tmpfs", folder)
    try:
        yield folder
    finally:
        bench.run("umount", folder)


def record_to_the_last_byte(bench, folder):
    """A recording that fills its disk, judged with what is left of it."""
    with test_camera(ADDRESS), small_disk(bench, folder) as disk:
        run = bench.alidade("record", f"genicam:{ADDRESS}", "-o", disk / "out", "--keep-free-mb", 0, code=None)
        bench.alidade("verify", disk / "out", "--quiet")
    return run


def measure_cameras(bench):
    work = bench.fresh("capture/bad-input/cameras")
    work.mkdir(parents=True)
    yield judge("no-such-device", record(bench, "absent", "v4l2:/dev/video99"))
    yield judge("not-a-camera", record(bench, "null", "v4l2:/dev/null"))
    yield judge("unreachable-address", record(bench, "unreachable", "genicam:127.0.0.77"))
    with test_camera(ADDRESS):
        yield judge("unsupported-size", record(bench, "size", f"genicam:{ADDRESS}", "--camera-size", "5000x10"))
        words = [bench.program, "record", f"genicam:{ADDRESS}", "-o", bench.fresh("capture/bad-input/first"), "--quiet"]
        with subprocess.Popen([str(word) for word in words]) as first:
            time.sleep(2)
            yield judge("device-busy", record(bench, "busy", f"genicam:{ADDRESS}"))
            first.terminate()
    if os.geteuid() == 0:
        with forbidden_device(work) as node:
            nobody = ["setpriv", "--reuid", "65534", "--clear-groups"]
            yield judge("no-permission", record(bench, "forbidden", f"v4l2:{node}", by=nobody))
        yield judge("full-disk", record_to_the_last_byte(bench, work / "disk"))


CAMERAS = ["no-such-device", "not-a-camera", "unreachable-address", "unsupported-size", "device-busy", "no-permission",
           "full-disk"]  # fmt: skip


def halve(path):
    path.write_bytes(path.read_bytes()[:path.stat().st_size // 2])


def measure_files(bench):
    work = bench.fresh("capture/bad-input/files")
    (work / "empty").mkdir(parents=True)
    (work / "mixed").mkdir()
    texture = BlobTexture(640, 480, 1)
    for number, (width, height) in enumerate([(640, 480), (320, 240)]):
        rows = (row[:width] for row in texture.rows[:height])
        write_png(work / "mixed" / f"{number:04}.png", width, height, rows)
    camera = write_camera(work / "camera.txt")
    bench.run("ffmpeg", "-v", "error", "-f", "lavfi", "-i", "testsrc=size=640x480:rate=25:duration=4", work / "cut.mp4")
    halve(work / "cut.mp4")
    for name, source in [("truncated-video", "cut.mp4"), ("empty-directory", "empty"), ("mixed-image-sizes", "mixed")]:
        out = work / f"{name}-out"
        yield judge(name, bench.alidade("track", "camera", work / source, "--camera", camera, "-o", out, "--quiet", code=None))
    with test_camera(ADDRESS):
        bench.alidade("record", f"genicam:{ADDRESS}", "-o", work / "recording", "--frames", 20, "--quiet")
    halve(work / "recording" / "video.mkv")
    yield judge("damaged-recording", bench.alidade("verify", work / "recording", "--quiet", code=None))


FILES = ["truncated-video", "empty-directory", "mixed-image-sizes", "damaged-recording"]


def figures(names):
    return [Figure(f"bad-input/{name}", expected=f"exit {EXPECTED[name][0]}, 1 line") for name in names]


SECTIONS = [Section("bad-input", figures(CAMERAS), measure_cameras),
            Section("bad-input", figures(FILES), measure_files)]  # fmt: skip
