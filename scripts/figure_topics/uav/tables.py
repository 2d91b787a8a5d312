# SPDX-License-Identifier: Apache-2.0
"""uav: the paper's Tables 1 and 2 and its formulas; `alidade experiment targets --only tables` and `--only formulas`."""

import math

from figure_topics.bench import summary
from figure_topics.figure import Fact, Figure, Section

# Enough for d, and not so many that the spread of the page's figures is forgotten: it does not tell its number of runs,
# and is taken to have as many.
RUNS = 300

# Name of the figure, of the cell in summary.json, and whether the page re-creates it.
CELLS = {"table-1/one/0.1": ("alternative m=1 .1", True), "table-1/one/0.25": ("alternative m=1 .25", True),
         "table-1/two/0.1": ("alternative m=2 .1", True), "table-1/two/0.25": ("alternative m=2 .25", True),
         "table-2/one/0.1-0.2": ("proposed m=1 .1/.2", True), "table-2/one/0.3-0.4": ("proposed m=1 .3/.4", True),
         "table-2/two/0.1-0.2": ("proposed m=2 .1/.2", False), "table-2/two/0.3-0.4": ("proposed m=2 .3/.4", False)}
READINGS = ("bearings", "vectors")
MEASURES = {"d-mean": "d_mean_m", "d-sd": "d_sd_m", "found": "all_found"}
BATCH = {"table-2/one/0.1-0.2": 0.33, "table-2/one/0.3-0.4": 0.17}
ORTHOGONAL_BOUND_M = {"table-2/one/0.1-0.2": 0.265, "table-2/one/0.3-0.4": 0.520}


def experiment(bench, part):
    """The summary of one part of the experiment."""
    out = bench.fresh(f"uav/experiment-{part}")
    bench.alidade("experiment", "targets", "--only", part, "--runs", RUNS, "-o", out, "--quiet")
    return summary(out)[part]


def off_page(measured, printed):
    """How far the page's figures are from ours, at most, in standard errors of the difference of two such runs."""
    return max(abs(measured[key]["value"] - value) / (math.sqrt(2) * measured[key]["standard_error"])
               for key, value in printed.items() if measured[key]["standard_error"] > 0)


def page_readings(name):
    """The readings of the noise in which the page re-creates a cell."""
    if not CELLS[name][1]:
        return ()
    return READINGS if name.startswith("table-2") else ("bearings",)


def measure_tables(bench):
    cells = experiment(bench, "tables")
    for name, (cell, _) in CELLS.items():
        result = cells[cell]
        for reading in READINGS:
            for measure, key in MEASURES.items():
                yield f"{name}/noise-on-{reading}/{measure}", result[f"on_{reading}"][key]["value"]
        for reading in page_readings(name):
            yield (f"{name}/noise-on-{reading}/off-page",
                   off_page(result[f"on_{reading}"], result[f"page_on_{reading}"]))
        yield f"{name}/batch-to-paper", result["batch_to_paper"]
        if name in ORTHOGONAL_BOUND_M:
            ratio = result["orthogonal_bound_m"] / ORTHOGONAL_BOUND_M[name]
            yield f"{name}/bound-to-page", Fact(f"{ratio:.4f}", 0.995 <= ratio <= 1.005)


def table_figures(name):
    for reading in READINGS:
        for measure in MEASURES:
            yield Figure(f"{name}/noise-on-{reading}/{measure}", "" if measure == "found" else "m")
    for reading in page_readings(name):
        yield Figure(f"{name}/noise-on-{reading}/off-page", "sigma", at_most=3, goal=2)
    yield Figure(f"{name}/batch-to-paper", at_most=BATCH.get(name))
    if name in ORTHOGONAL_BOUND_M:
        yield Figure(f"{name}/bound-to-page", expected="0.995 to 1.005")


TABLES = Section("tables", [figure for name in CELLS for figure in table_figures(name)], measure_tables)


def extremes(values):
    return f"{min(values):.3f} to {max(values):.3f}"


def measure_formulas(bench):
    result = experiment(bench, "formulas")
    of_pairs = {key: [value for pair in result["pair"].values() for value in pair[key]]
                for key in ("white", "bearings", "bearings_to_derived")}
    of_several = {key: [one[key] for one in result["several"].values()] for key in ("white", "bearings")}

    def near_one(values):
        return Fact(extremes(values), 0.97 <= min(values) and max(values) <= 1.03)

    yield "formulas/12/own-noise", near_one(of_pairs["white"])
    yield "formulas/12/true-noise", Fact(extremes(of_pairs["bearings"]), True)
    yield "formulas/12/true-noise-derived", near_one(of_pairs["bearings_to_derived"])
    yield "formulas/13/own-noise", near_one(of_several["white"])
    yield "formulas/13/true-noise", Fact(extremes(of_several["bearings"]), True)


FORMULAS = Section("formulas", [
    Figure("formulas/12/own-noise", expected="0.97 to 1.03"),
    Figure("formulas/12/true-noise", expected="beside it"),
    Figure("formulas/12/true-noise-derived", expected="0.97 to 1.03"),
    Figure("formulas/13/own-noise", expected="0.97 to 1.03"),
    Figure("formulas/13/true-noise", expected="beside it"),
], measure_formulas)

SECTIONS = [TABLES, FORMULAS]
