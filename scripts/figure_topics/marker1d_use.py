# SPDX-License-Identifier: Apache-2.0
"""marker1d, as it is used: a body file that is off, an hour of stream, and input that is wrong."""

import itertools
import math
import random
import re

from figure_topics.figure import Fact, Figure, Section
from figure_topics.tables import rows_of, write_rows


def places(body_file):
    return {row["marker"]: [float(row[axis]) for axis in ("x_m", "y_m", "z_m")] for row in rows_of(body_file)}


def largest_error_mm(body_file, truth_file):
    """Of the distances between markers, which is what a body's shape and size are whatever its frame."""
    body, truth = places(body_file), places(truth_file)
    return 1e3 * max(abs(math.dist(body[a], body[b]) - math.dist(truth[a], truth[b]))
                     for a, b in itertools.combinations(truth, 2))


def measure_body(bench):
    """Every coordinate of the body file is off by a millimetre (standard deviation); of the rig one station is known."""
    scene, out = bench.fresh("marker1d/body/scene"), bench.fresh("marker1d/body/refined")
    bench.alidade("simulate", "body", "--frames", 2500, "--markers", 8, "-o", scene, "--quiet")
    chance = random.Random(1)
    rows = rows_of(scene / "body.csv")
    for row in rows:
        row.update({axis: float(row[axis]) + chance.gauss(0, 1e-3) for axis in ("x_m", "y_m", "z_m")})
    write_rows(scene / "rough.csv", rows)
    bench.alidade("calibrate", "detectors", scene / "rough.csv", scene / "detectors.yaml", scene / "observations.csv",
                  "--marker-sigma-m", 1e-3, "-o", out, "--quiet")
    yield "body/given", largest_error_mm(scene / "rough.csv", scene / "body.csv")
    yield "body/refined", largest_error_mm(out / "body.csv", scene / "body.csv")


def peak_mb(bench, name, seconds):
    """The most memory that a track of so long a recording takes, and what it tracked."""
    rate = 100
    scene, out = bench.fresh(f"marker1d/hour/{name}-scene"), bench.fresh(f"marker1d/hour/{name}")
    bench.alidade("simulate", "body", "--frames", rate * seconds, "--rate-hz", rate, "--markers", 3, "--blocks", 2,
                  "--occluded", 0.3, "-o", scene, "--quiet")
    peak = bench.folder / "marker1d" / "hour" / f"{name}.peak"
    measure = ("import pathlib, resource, subprocess, sys; code = subprocess.call(sys.argv[2:]); "
               "pathlib.Path(sys.argv[1]).write_text(str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)); "
               "sys.exit(code)")
    bench.run("python3", "-c", measure, peak, bench.program, "track", "body", scene / "body.csv",
              scene / "detectors.yaml", scene / "observations.csv", "--batch-s", 0.01, "-o", out, "--quiet")
    return int(peak.read_text(encoding="utf-8")) / 1e3


def measure_hour(bench):
    minute, hour = peak_mb(bench, "six-minutes", 360), peak_mb(bench, "hour", 3600)
    yield "hour/memory", hour
    yield "hour/memory-to-six-minutes", hour / minute


def with_cell(row, column, value):
    return {**row, column: value}


# What is wrong, the file it is in, how it comes in, and what the message must say after the file's name.
def wrong_inputs(observations, body):
    first, last = observations[:-1], observations[-1]
    plane = {"t_ns": 0, "detector": 0, "marker": 0, "nx": 0.5, "ny": 0.5, "nz": 0.5, "d_m": 1}
    return {
        "unknown-marker": ({"observations.csv": [*first, with_cell(last, "marker", 77)]},
                           r"observations.csv:%d: marker 77 belongs to no body; known are: " % (len(observations) + 1)),
        "normal": ({"observations.csv": [plane]},
                   r"observations.csv:2: the plane's normal must be of length 1, got 0.866\d*; divide "),
        "nan": ({"observations.csv": [*first, with_cell(last, "value_rad", "nan")]},
                r"observations.csv:%d: column 'value_rad': 'nan' is not a finite number; correct it "
                % (len(observations) + 1)),
        "time-back": ({"observations.csv": [*first, with_cell(last, "t_ns", -1)]},
                      r"observations.csv:%d: time goes back from .* s to .* s; sort " % (len(observations) + 1)),
        "missing-column": ({"observations.csv": [{key: row[key] for key in ("t_ns", "detector", "marker")}
                                                 for row in observations]},
                           r"observations.csv:1: has no column with readings; 'angle_raw_rad', "),
        "empty-body": ({"body.csv": []}, r"body.csv: holds no markers; give each marker a row"),
        "body-nan": ({"body.csv": [*body[:-1], with_cell(body[-1], "y_m", "nan")]},
                     r"body.csv:5: column 'y_m': 'nan' is not a finite number; correct it "),
    }


def measure_bad_input(bench):
    scene = bench.fresh("marker1d/bad/scene")
    bench.alidade("simulate", "body", "--frames", 20, "-o", scene, "--quiet")
    tables = {name: rows_of(scene / name) for name in ("observations.csv", "body.csv")}
    for name, (changes, pattern) in wrong_inputs(tables["observations.csv"], tables["body.csv"]).items():
        folder = bench.fresh(f"marker1d/bad/{name}")
        folder.mkdir(parents=True)
        for table, rows in tables.items():
            changed = changes.get(table, rows)
            write_rows(folder / table, changed, list(changed[0] if changed else rows[0]))
        done = bench.alidade("track", "body", folder / "body.csv", scene / "detectors.yaml",
                             folder / "observations.csv", "-o", folder / "out", "--quiet", code=None)
        lines = done.stderr.splitlines()
        holds = done.code == 2 and len(lines) == 1 and re.match(re.escape(f"{folder}/") + pattern, lines[0])
        yield f"bad-input/{name}", Fact("named" if holds else f"exit {done.code}: {done.stderr.strip()}", bool(holds))


WRONG_INPUTS = ("unknown-marker", "normal", "nan", "time-back", "missing-column", "empty-body", "body-nan")

SECTIONS = [
    Section("body", [Figure("body/given", "mm"), Figure("body/refined", "mm", at_most=0.1)], measure_body),
    Section("hour", [Figure("hour/memory", "MB"), Figure("hour/memory-to-six-minutes", at_most=1.1)], measure_hour),
    Section("bad-input", [Figure(f"bad-input/{name}", expected="file:line, remedy") for name in WRONG_INPUTS],
            measure_bad_input),
]
