# SPDX-License-Identifier: Apache-2.0
"""uav: where a receiver that has to turn will see a target, against the stated covariance; `alidade experiment targets
--only cue`."""

from figure_topics.bench import summary
from figure_topics.figure import Fact, Figure, Section

RUNS = 800  # of two targets each
FLIGHTS = {"straight": "straight", "gusts-0.1": "gusts of 0.1 m2/s3", "gusts-1": "gusts of 1 m2/s3"}
LEADS = ("0.1", "0.2", "0.5", "1")


def measure_cue(bench):
    out = bench.fresh("uav/experiment-cue")
    bench.alidade("experiment", "targets", "--only", "cue", "--runs", RUNS, "-o", out, "--quiet")
    result = summary(out)["cue"]
    for name, flight in FLIGHTS.items():
        for lead in LEADS:
            cell = result[flight][lead]
            chi2 = cell["chi2_per_degree"]
            yield f"cue/{name}/{lead}-s/cues", cell["cues"]
            yield f"cue/{name}/{lead}-s/chi2-per-degree", Fact(f"{chi2:.3f}", cell["lower"] <= chi2 <= cell["upper"])
            yield f"cue/{name}/{lead}-s/rms", cell["rms_mrad"]


SECTIONS = [Section("cue", [figure for name in FLIGHTS for lead in LEADS for figure in (
    Figure(f"cue/{name}/{lead}-s/cues", at_least=1000),
    Figure(f"cue/{name}/{lead}-s/chi2-per-degree", expected="within its 95 % bounds"),
    Figure(f"cue/{name}/{lead}-s/rms", "mrad"))], measure_cue)]
