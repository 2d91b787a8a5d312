# SPDX-License-Identifier: Apache-2.0
"""uav: input that cannot work is named by file and line; what cannot be located is not answered, or says how unsure it is."""

import math
import re
import shutil

from figure_topics.bench import summary
from figure_topics.figure import Fact, Figure, Section
from figure_topics.tables import rows_of, write_rows

BAD_INPUT, DEVICE, NO_ANSWER = 2, 3, 4

# Exit code, and what the one line must say after the folder's name.
EXPECTED = {
    "receiver-without-clock": (BAD_INPUT, r"receivers\.yaml:5: receiver 'receiver1' has no clock; write 'clock: "),
    "one-receiver": (BAD_INPUT, r"receivers\.yaml: holds 1 receiver, wanted are 2; .*add a receiver"),
    "unknown-receiver": (BAD_INPUT, r"observations\.csv:3: unknown receiver 9; known are: 0, 1, 2"),
    "degrees-as-radians": (BAD_INPUT, r"observations\.csv:\d+: azimuth .* is no direction; are these degrees\? "),
    "another-resolution": (BAD_INPUT, r"observations\.csv:2: pixel \(1900, 1000\) lies outside the image of 640x480 "
                                      r"px; are the receivers those of this recording, at its resolution\?"),
    "nan": (BAD_INPUT, r"observations\.csv:3: column 'azimuth_rad': 'nan' is not a finite number; "),
    "unsorted-times": (BAD_INPUT, r"observations\.csv:\d+: time of receiver 0 goes back from .*; sort the readings by time"),
    "empty-table": (BAD_INPUT, r"observations\.csv: is empty; its first line must name the columns"),
    "missing-table": (BAD_INPUT, r"observations\.csv: cannot be opened: No such file or directory; check the name"),
    "no-rows": (NO_ANSWER, r"holds no bearing"),
    "too-few-videos": (BAD_INPUT, r"one\.mp4: 1 video for 3 receivers; give one for each receiver"),
    "on-one-line": (NO_ANSWER, r"no target was found: do lines of sight of two receivers cross at an angle, "),
}  # fmt: skip

CAMERA = """  - id: {0}
    model: pinhole
    resolution_px: [640, 480]
    intrinsics_px: {{fx: 500, fy: 500, cx: 320, cy: 240}}
    T_world_receiver: {{translation_m: [{0}, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}}
    clock: common
"""
FINDER = """  - id: {0}
    model: direction_finder
    sigma_rad: 0.001
    T_world_receiver: {{translation_m: [{1}, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}}
    clock: common
"""


def with_cell(rows, place, **cells):
    return [{**row, **cells} if i == place else row for i, row in enumerate(rows)]


def in_degrees(row):
    return {**row, **{name: math.degrees(float(row[name])) for name in ("azimuth_rad", "elevation_rad")}}


def on_the_receivers_line():
    """What two receivers on the x axis see of a target that flies along it: angles of noise alone."""
    return [{"t_s": i + 0.1 * k, "receiver": k, "azimuth_rad": math.pi / 2 + 1e-3 * math.sin(7 * i + k),
             "elevation_rad": 1e-3 * math.cos(5 * i + 3 * k)} for i in range(20) for k in (0, 1)]


def bad_tables(rows):
    """{name: rows} of the cases whose receivers are good."""
    return {"unknown-receiver": with_cell(rows, 1, receiver=9), "degrees-as-radians": [in_degrees(row) for row in rows],
            "nan": with_cell(rows, 1, azimuth_rad="nan"), "unsorted-times": [*rows[-3:], *rows[:-3]]}


def write_cases(work, sim):
    """A folder of receivers.yaml and observations.csv for each case but the videos'."""
    receivers, rows = (sim / "receivers.yaml").read_text(encoding="utf-8"), rows_of(sim / "observations.csv")
    for name in EXPECTED:
        (work / name).mkdir(parents=True)
        shutil.copy(sim / "receivers.yaml", work / name)
        shutil.copy(sim / "observations.csv", work / name)
    for name, changed in bad_tables(rows).items():
        write_rows(work / name / "observations.csv", changed)
    clockless = "".join(line for line in receivers.splitlines(True) if "clock:" not in line)
    for name, text in (("receiver-without-clock", clockless), ("one-receiver", receivers[:receivers.index("  - id: 1")]),
                       ("another-resolution", "receivers:\n" + CAMERA.format(0) + CAMERA.format(1)),
                       ("on-one-line", "receivers:\n" + FINDER.format(0, 0) + FINDER.format(1, 100))):
        (work / name / "receivers.yaml").write_text(text, encoding="utf-8")
    write_rows(work / "another-resolution" / "observations.csv", [{"t_s": 0, "receiver": 0, "u_px": 1900, "v_px": 1000}])
    write_rows(work / "on-one-line" / "observations.csv", on_the_receivers_line())
    write_rows(work / "no-rows" / "observations.csv", [], list(rows[0]))
    (work / "empty-table" / "observations.csv").write_text("", encoding="utf-8")
    (work / "missing-table" / "observations.csv").unlink()


def simulated(bench, name, *words):
    scene = bench.fresh(f"uav/bad-input/{name}")
    bench.alidade("simulate", "targets", "--periods", 20, *words, "-o", scene, "--quiet")
    return scene


def judge(name, run, folder, left):
    code, speaks_of = EXPECTED[name]
    lines = run.stderr.strip().splitlines() or [""]
    has_left = code == BAD_INPUT and left.exists()
    good = run.code == code and len(lines) == 1 and re.search(speaks_of, lines[0]) and not has_left
    text = lines[0].replace(f"{folder}/", "")
    return f"bad-input/{name}", Fact(f"exit {run.code}, {len(lines)} line{', and a result' if has_left else ''}: {text}",
                                     bool(good))


def measure_refusals(bench):
    sim, work = simulated(bench, "sim"), bench.fresh("uav/bad-input/cases")
    write_cases(work, sim)
    for name in EXPECTED:
        folder, out = work / name, work / f"{name}-out"
        sources = [folder / "one.mp4"] if name == "too-few-videos" else []
        run = bench.alidade("track", "targets", folder / "receivers.yaml", *(sources or [folder / "observations.csv"]),
                            "-o", out, "--quiet", code=None)
        yield judge(name, run, folder, out)


def measure_truncated(bench):
    """The last line is cut off: it is named, and what lies before it is tracked and kept."""
    sim = simulated(bench, "sim")
    text = (sim / "observations.csv").read_text(encoding="utf-8")
    (sim / "observations.csv").write_text(text[:-20], encoding="utf-8")
    out = bench.fresh("uav/bad-input/truncated")
    run = bench.alidade("track", "targets", sim, "-o", out, "--quiet", code=None)
    lines = run.stderr.strip().splitlines()
    named = run.code == BAD_INPUT and len(lines) == 1 and re.search(r"observations\.csv:\d+: the last line is cut off", lines[0])
    kept = len(summary(out)["targets"]) if (out / "summary.json").exists() else 0
    yield "bad-input/truncated-last-line", Fact(f"exit {run.code}, {kept} targets kept", bool(named) and kept == 2)


def measure_full_disk(bench):
    """No file may grow beyond 8 kB; the result that was there before stays as it is."""
    sim, out = simulated(bench, "sim"), bench.fresh("uav/bad-input/full")
    bench.alidade("track", "targets", sim, "-o", out, "--quiet")
    before = (out / "tracks.csv").read_bytes()
    limited = ("import os, resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN); "
               "resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192)); os.execv(sys.argv[1], sys.argv[1:])")
    run = bench.run("python3", "-c", limited, bench.program, "track", "targets", sim, "-o", out, "--quiet", code=None)
    lines = run.stderr.strip().splitlines()
    is_kept = (out / "tracks.csv").read_bytes() == before and not (out / ".part").exists()
    good = run.code == DEVICE and len(lines) == 1 and "File too large" in lines[0] and is_kept
    yield "bad-input/full-disk", Fact(f"exit {run.code}, {len(lines)} line, what was there {'stays' if is_kept else 'is lost'}",
                                      good)


def measure_coplanar(bench):
    """All lines of sight in one plane: the paper's system of three receivers is singular there."""
    scene, out = simulated(bench, "coplanar", "--elevation-rad", 0), bench.fresh("uav/bad-input/coplanar-out")
    bench.alidade("track", "targets", scene, "--method", "paper-proposed", "-o", out, "--quiet", code=None)
    truth = {}
    for row in rows_of(scene / "truth.csv"):
        truth.setdefault(row["t_ns"], []).append([float(row[f"{axis}_m"]) for axis in "xyz"])
    worst = 0.0
    for row in rows_of(out / "tracks.csv"):
        place = [float(row[f"{axis}_m"]) for axis in "xyz"]
        sigma = math.sqrt(sum(float(row[f"c_{axis}_{axis}"]) for axis in "xyz"))
        worst = max(worst, min(math.dist(place, other) for other in truth[row["t_ns"]]) / sigma)
    yield "bad-input/coplanar/worst-error-over-stated-sigma", worst


SECTIONS = [
    Section("bad-input", [Figure(f"bad-input/{name}", expected=f"exit {code}, 1 line") for name, (code, _) in EXPECTED.items()],
            measure_refusals),
    Section("bad-input", [Figure("bad-input/truncated-last-line", expected="named, the rest kept")], measure_truncated),
    Section("bad-input", [Figure("bad-input/full-disk", expected="named, nothing lost")], measure_full_disk),
    Section("bad-input", [Figure("bad-input/coplanar/worst-error-over-stated-sigma", at_most=5)], measure_coplanar),
]
