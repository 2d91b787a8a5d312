# SPDX-License-Identifier: Apache-2.0
"""The live main job: a GigE Vision camera on loopback shows a rendered walk, and is tracked while it does."""

import collections
import json
import socket
import subprocess
import threading

from figure_topics.bench import summary
from figure_topics.capture.programs import test_camera
from figure_topics.capture.walk import FRAMES, error_of, walk
from figure_topics.figure import Failed, Figure, Section
from figure_topics.tables import rows_of

ADDRESS, PORT = "127.0.0.43", 5743
RATE_HZ = 30
PERIOD_MS = 1e3 / RATE_HZ
KNOWN_FRAMES = 450  # in a known map each frame takes a quarter of a second offline


def poses_of(lines):
    return [message for message in map(json.loads, lines) if message["type"] == "pose"]


def quantile(values, share):
    ordered = sorted(values)
    return ordered[round(share * (len(ordered) - 1))]


def pictures_of(log):
    """Which picture each frame id showed, in the acquisition of the most frames (others are probes of the client's)."""
    acquisitions = collections.defaultdict(dict)
    for row in rows_of(log):
        acquisitions[row["acquisition"]][int(row["frame_id"])] = int(row["picture"])
    return max(acquisitions.values(), key=len)


class Live:
    """What a live run told while it ran, and left."""

    def __init__(self, bench, scene, name, *words, deaf_reader=False):
        out = bench.fresh(f"capture/live/{name}")
        log = bench.folder / "capture" / "live" / f"{name}.csv"
        stream = f"tcp://:{PORT}" if deaf_reader else "-"
        command = [bench.program, "track", "camera", f"genicam:{ADDRESS}", "--camera", scene / "camera.yaml", "--frames",
                   FRAMES, "--stream", stream, "-o", out, "--quiet", *words]  # fmt: skip
        with test_camera(ADDRESS, "--pictures", scene / "images", "--fps", RATE_HZ, "--log", log) as camera:
            reader = threading.Timer(5, self.connect)
            if deaf_reader:
                reader.start()
            run = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
            reader.cancel()
            camera.communicate("quit\n", timeout=30)
        if run.returncode != 0:
            raise Failed(f"track camera exits {run.returncode}: {run.stderr.strip()}")
        self.messages = poses_of(run.stdout.splitlines())
        self.told = summary(out)["live"]
        self.pictures = pictures_of(log)

    def connect(self):
        self.deaf = socket.create_connection(("127.0.0.1", PORT))  # and never reads

    def latencies_ms(self):
        return [1e-6 * (message["sent_ns"] - message["t_ns"]) for message in self.messages]

    def poses(self):
        """The messages by the picture that was shown."""
        return {self.pictures[message["sequence"]]: message for message in self.messages}


def tracked(poses):
    """{picture: (px, py, pz, qx, qy, qz, qw)} of the messages that tell a measured pose."""
    found = {}
    for picture, message in poses.items():
        if message["state"] == "tracked":
            w, *xyz = message["T_world_camera"]["q_wxyz"]
            found[picture] = [*message["T_world_camera"]["p_m"], *xyz, w]
    return found


def offline(bench, scene, name, frames, *words):
    """The poses that the same walk gives from its files, told as they are found."""
    out = bench.fresh(f"capture/live/{name}")
    run = bench.alidade("track", "camera", scene, "--camera", scene / "camera.yaml", "--frames", frames, "--stream", "-",
                        "-o", out, "--quiet", *words)  # fmt: skip
    return out, {message["frame"]: message for message in poses_of(run.stdout.splitlines())}


def measure(bench):
    scene = walk(bench)
    own, own_poses = offline(bench, scene, "offline", FRAMES)
    _, known_poses = offline(bench, scene, "offline-known", KNOWN_FRAMES, "--map", own, "--lag", 0)
    for name, words, poses in [("own-map", [], own_poses), ("known-map", ["--map", own], known_poses)]:
        live = Live(bench, scene, name, *words)
        latencies = live.latencies_ms()
        yield f"live/{name}/frames", len(live.messages)
        yield f"live/{name}/lost", live.told["dropped_by_camera"] + live.told["discarded"]
        yield f"live/{name}/latency-p50", quantile(latencies, 0.5)
        yield f"live/{name}/latency-p99", quantile(latencies, 0.99)
        told, found = tracked(live.poses()), tracked(poses)
        both = told.keys() & found.keys()
        there, here = (error_of(bench, scene, f"{name}-{place}", {picture: poses[picture] for picture in both})
                       for place, poses in (("live", told), ("offline", found)))
        yield f"live/{name}/error", 1e3 * there
        yield f"live/{name}/error-to-offline", there / here
    deaf = Live(bench, scene, "deaf", "--map", own, deaf_reader=True)
    yield "live/deaf-reader/latency-p99", 1e3 * deaf.told["latency_p99_s"]
    yield "live/deaf-reader/lost", deaf.told["dropped_by_camera"] + deaf.told["discarded"]


FIGURES = [figure for name in ("own-map", "known-map") for figure in (
    Figure(f"live/{name}/frames", at_least=FRAMES),
    Figure(f"live/{name}/lost", "frames", at_most=0),
    Figure(f"live/{name}/latency-p50", "ms"),
    Figure(f"live/{name}/latency-p99", "ms", at_most=2 * PERIOD_MS, goal=PERIOD_MS),
    Figure(f"live/{name}/error", "mm"),
    Figure(f"live/{name}/error-to-offline", at_most=1.1),
)]  # fmt: skip
DEAF = [Figure("live/deaf-reader/latency-p99", "ms", at_most=2 * PERIOD_MS, goal=PERIOD_MS),
        Figure("live/deaf-reader/lost", "frames", at_most=0)]  # fmt: skip

SECTIONS = [Section("live", [*FIGURES, *DEAF], measure)]
