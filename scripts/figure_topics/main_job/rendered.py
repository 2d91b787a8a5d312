# SPDX-License-Identifier: Apache-2.0
"""Rendered scenes with exact truth: the demo, speed, repeatability, relocalisation, scale, interruption."""

import csv
import json
import math
import re
import signal
import subprocess

from figure_topics.bench import ROOT, frames, pose_count, summary
from figure_topics.figure import Fact, Failed, Figure, Section

BLACK_FRAMES = 40
PERCENT = 100.0
MARKER_M = 0.2
FRAME_A, FRAME_B = 0, 60  # whose distance is told


def track_scene(bench, scene, name, *words):
    return bench.track(scene, scene / "camera.yaml", name, *words)[0]


def measure_demo(bench):
    out = bench.fresh("demo")
    last = bench.run(ROOT / "scripts" / "demo", out).stdout.strip().splitlines()[-1]
    told = re.search(r"([\d.]+) % of the path.*picture: (.*)$", last)
    if not told:
        raise Failed(f"the demo's last line has no error and no picture: {last}")
    yield "demo/ate-rmse-sim3", float(told.group(1))
    yield "demo/picture", Fact(told.group(2), (ROOT / told.group(2)).is_file())


DEMO = Section("demo", [
    Figure("demo/ate-rmse-sim3", "% of path", at_most=0.3),
    Figure("demo/picture", expected="is there"),
    Figure("demo/look", manual="./scripts/demo; look at demo/track/report.html"),
], measure_demo)


def measure_speed(bench):
    movie = bench.scene("scene-movie", "--form", "movie")
    sequential = [movie / "video.mp4", movie / "camera.yaml"]
    guided, _ = bench.track(*sequential, "speed/guided", "--refine", "none")
    brute, _ = bench.track(*sequential, "speed/sift-per-frame", "--refine", "none", "--features", "sift")
    rates = [summary(result)["frames_per_s"] for result in (guided, brute)]
    yield "speed/guided", rates[0]
    yield "speed/sift-per-frame", rates[1]
    yield "speed/to-sift-per-frame", rates[0] / rates[1]


SPEED = Section("speed", [
    Figure("speed/guided", "frames/s", at_least=15),
    Figure("speed/sift-per-frame", "frames/s"),
    Figure("speed/to-sift-per-frame", at_least=3),
], measure_speed)


def measure_repeat(bench):
    scene = bench.scene()
    results = [track_scene(bench, scene, f"repeat/{i}", "--seed", 7) for i in (1, 2)]
    files = [(result / "trajectory.tum").read_bytes() for result in results]
    yield "repeat/same-seed-same-trajectory", Fact("equal" if files[0] == files[1] else "differs", files[0] == files[1])


REPEAT = Section("repeat", [Figure("repeat/same-seed-same-trajectory", expected="bit-equal")], measure_repeat)


def rms(values):
    return math.sqrt(sum(value * value for value in values) / len(values)) if values else math.inf


def measure_relocalisation(bench):
    first_black = 130
    back = first_black + BLACK_FRAMES
    scene = bench.scene("scene-black", "--black-from", first_black, "--black-count", BLACK_FRAMES)
    out = track_scene(bench, scene, "relocalisation/track", "--refine", "none")
    states = [row["state"] for row in frames(out)]
    posed = next((i for i, state in enumerate(states[back:]) if state == "tracked"), len(states))
    yield "relocalisation/frames-until-pose", posed + 1
    yield "relocalisation/black-frames-called-tracked", states[first_black:back].count("tracked")

    compared = bench.fresh("relocalisation/evaluation")
    bench.alidade("evaluate", out / "trajectory.tum", scene / "truth.tum", "--align", "sim3", "-o", compared)
    with open(scene / "truth.tum", encoding="utf-8") as file:
        times_ns = [round(float(line.split()[0]) * 1e9) for line in file if not line.startswith("#")]
    with open(compared / "errors.csv", newline="", encoding="utf-8") as file:
        errors = [(int(row["t_ns"]), float(row["translation_m"])) for row in csv.DictReader(file)]
    before = rms([error for time, error in errors if time < times_ns[first_black]])
    after = rms([error for time, error in errors if time >= times_ns[back]])
    yield "relocalisation/rmse-after-to-before", after / before


RELOCALISATION = Section("relocalisation", [
    Figure("relocalisation/frames-until-pose", at_most=5),
    Figure("relocalisation/black-frames-called-tracked", at_most=0),
    Figure("relocalisation/rmse-after-to-before", at_most=2),
], measure_relocalisation)


def scale_error_percent(bench, scene, name, *words):
    out = track_scene(bench, scene, name, *words)
    return PERCENT * abs(bench.evaluate(out / "trajectory.tum", scene / "truth.tum", "--align", "sim3")["scale"] - 1)


def distance_m(trajectory, a, b):
    """Between the camera centres of two frames of a TUM file."""
    with open(trajectory, encoding="utf-8") as file:
        centres = [[float(word) for word in line.split()[1:4]] for line in file if not line.startswith("#")]
    return math.dist(centres[a], centres[b])


def measure_scale(bench):
    scene = bench.scene()
    yield "scale/init-poses", scale_error_percent(bench, scene, "scale/init-poses", "--init-poses", scene / "truth.tum")
    distance = f"distance:{FRAME_A}:{FRAME_B}:{distance_m(scene / 'truth.tum', FRAME_A, FRAME_B):.9g}"
    yield "scale/distance", scale_error_percent(bench, scene, "scale/distance", "--scale", distance)
    marked = bench.scene("scene-marker", "--marker-m", MARKER_M)
    yield "scale/marker", scale_error_percent(bench, marked, "scale/marker", "--scale", f"marker:{MARKER_M}")


SCALE = Section("scale", [
    Figure("scale/init-poses", "%", at_most=0.5),
    Figure("scale/distance", "%", at_most=0.5),
    Figure("scale/marker", "%", at_most=0.5),
], measure_scale)


def measure_interruption(bench):
    scene = bench.scene()
    out = bench.fresh("interruption")
    words = [bench.program, "track", "camera", scene, "--camera", scene / "camera.yaml", "-o", out, "--json"]
    seen = 0
    with subprocess.Popen(list(map(str, words)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        for line in process.stdout:
            event = json.loads(line)
            if event["event"] == "progress" and 0 < event["total"] <= 2 * event["done"]:
                seen = event["done"]
                process.send_signal(signal.SIGINT)
                break
        process.stdout.read()
        code = process.wait(timeout=120)
    yield "interruption/exit-code", Fact(str(code), code == 130)
    waiting = [row["state"] for row in frames(out)].count("waiting")
    yield "interruption/poses-kept-of-frames-seen", (pose_count(out / "trajectory.tum") + waiting) / max(seen, 1)


INTERRUPTION = Section("interruption", [
    Figure("interruption/exit-code", expected="130"),
    Figure("interruption/poses-kept-of-frames-seen", at_least=1),
], measure_interruption)

SECTIONS = [DEMO, SPEED, REPEAT, RELOCALISATION, SCALE, INTERRUPTION]
