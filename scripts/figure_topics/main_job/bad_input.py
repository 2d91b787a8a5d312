# SPDX-License-Identifier: Apache-2.0
"""Input that cannot work: one clear line, the right exit code, and nothing that looks like a result."""

import re

from figure_topics.figure import Fact, Figure, Section
from figure_topics.images import BlobTexture, write_png

WIDTH, HEIGHT, FOCAL = 640, 480, 500.0
BAD_INPUT, NO_ANSWER = 2, 4


def write_camera(path, fx=FOCAL, width=WIDTH, height=HEIGHT):
    path.write_text(f"{fx} 0 {width / 2}\n0 {FOCAL} {height / 2}\n0 0 1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n"
                    f"{width} {height}\n", encoding="utf-8")
    return path


def write_case(folder, textures):
    folder.mkdir(parents=True)
    for number, texture in enumerate(textures):
        write_png(folder / f"{number:04}.png", WIDTH, HEIGHT, (row[:WIDTH] for row in texture.rows[:HEIGHT]))
    return folder


def make_turning(folder):
    """Images of a camera that turns and does not move."""
    folder.mkdir(parents=True)
    texture = BlobTexture(2000, 1000, seed=1, blobs=12000)
    for number in range(12):
        texture.view(folder / f"{number:04}.png", WIDTH, HEIGHT, FOCAL, 0.03 * number)
    return folder


def damage(image):
    image.write_bytes(image.read_bytes()[:image.stat().st_size // 2])


def cases(work):
    """{name: (source, camera)} of every case, made in the folder `work`."""
    work.mkdir(parents=True)
    good = write_camera(work / "good.camera")
    turning = make_turning(work / "turning")
    damaged = write_case(work / "damaged", [BlobTexture(WIDTH, HEIGHT, seed) for seed in (6, 7)])
    damage(damaged / "0001.png")
    (work / "empty").mkdir()
    return {
        "missing-source": (work / "nowhere", good),
        "empty-folder": (work / "empty", good),
        "damaged-image": (damaged, good),
        "missing-camera": (turning, work / "no.camera"),
        "impossible-camera": (turning, write_camera(work / "impossible.camera", fx=-500.0)),
        "camera-of-another-size": (turning, write_camera(work / "other.camera", width=1280, height=960)),
        "one-image": (write_case(work / "single", [BlobTexture(WIDTH, HEIGHT, 5)]), good),
        "no-overlap": (write_case(work / "unrelated", [BlobTexture(WIDTH, HEIGHT, seed) for seed in (2, 3, 4)]), good),
        "pure-rotation": (turning, good),
    }


# Exit code, and what the line must speak of.
EXPECTED = {
    "missing-source": (BAD_INPUT, "nowhere"),
    "empty-folder": (BAD_INPUT, "empty"),
    "damaged-image": (BAD_INPUT, "0001.png"),
    "missing-camera": (BAD_INPUT, "no.camera"),
    "impossible-camera": (BAD_INPUT, "impossible.camera.*-500"),
    "camera-of-another-size": (BAD_INPUT, "1280"),
    "one-image": (NO_ANSWER, "image"),
    "no-overlap": (NO_ANSWER, "overlap|match"),
    "pure-rotation": (NO_ANSWER, "rotat|turn|parallax"),
}


def measure_refusals(bench):
    work = bench.fresh("bad-input")
    for name, (source, camera) in cases(work).items():
        code, speaks_of = EXPECTED[name]
        out = work / f"out-{name}"
        run = bench.alidade("track", "camera", source, "--camera", camera, "-o", out, "--quiet", code=None)
        lines = run.stderr.strip().splitlines() or [""]
        left = code == BAD_INPUT and (out / "summary.json").exists()
        good = run.code == code and len(lines) == 1 and re.search(speaks_of, lines[0]) and not left
        text = f"exit {run.code}, {len(lines)} line{', and a result' if left else ''}: {lines[0]}"
        yield f"bad-input/{name}", Fact(text, bool(good))


REFUSALS = Section("bad-input", [
    Figure(f"bad-input/{name}", expected=f"exit {code}, 1 line") for name, (code, _) in EXPECTED.items()
], measure_refusals)


def scaled_camera(source, target, factor):
    """A copy of a `fx F fy F cx C cy C` file with the focal lengths multiplied; returns the true fx."""
    text = source.read_text(encoding="utf-8")
    numbers = {}

    def scale(match):
        numbers[match.group(1)] = float(match.group(2))
        return f"{match.group(1)} {factor * float(match.group(2))}"

    target.write_text(re.sub(r"\b(fx|fy) ([\d.]+)", scale, text), encoding="utf-8")
    return numbers["fx"]


def measure_focal_length(bench):
    data = bench.data("seven-scenes")
    work = bench.fresh("wrong-focal-length")
    work.mkdir(parents=True)
    true_fx = scaled_camera(data / "camera.txt", work / "camera.txt", 1.2)
    run = bench.alidade("track", "camera", data, "--camera", work / "camera.txt", "-o", work / "out", "--quiet", code=None)
    told = re.search(r"^warning: .*focal length of [\d.]+ px; ([\d.]+) px fits.*$", run.stderr, re.MULTILINE)
    yield "wrong-focal-length/is-told", Fact(told.group(0) if told else "no warning", bool(told))
    fits = float(told.group(1)) if told else 0.0
    yield "wrong-focal-length/error-of-the-one-that-fits", 100 * abs(fits - true_fx) / true_fx


FOCAL_LENGTH = Section("wrong-focal-length", [
    Figure("wrong-focal-length/is-told", expected="a warning"),
    Figure("wrong-focal-length/error-of-the-one-that-fits", "%", at_most=5),
], measure_focal_length)

SECTIONS = [REFUSALS, FOCAL_LENGTH]
