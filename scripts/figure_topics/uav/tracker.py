# SPDX-License-Identifier: Apache-2.0
"""uav: the recursive tracker beside the same filter with true association and beside the bound; `alidade experiment
targets --only tracker` and the tracker's benchmark."""

from figure_topics.bench import summary
from figure_topics.benchmark import least_times
from figure_topics.figure import Fact, Figure, Section

RUNS = 200
STANDARD = {"2-targets": "2 targets", "5-targets": "5 targets"}
RECEIVERS = {f"{count}-receivers{suffix}": f"{count} receivers{words}"
             for suffix, words in (("", ""), ("-gusts", ", gusts")) for count in (3, 4, 6)}
SPACINGS = {"scatter-1": "scatter 1 m/s", "scatter-0.1": "scatter 0.1 m/s"}
SWEEPS = ("0 false bearings", "1 false bearings", "3 false bearings", "detection 1", "detection 0.9", "detection 0.8",
          "rotating receivers", "cued receivers")


def word(condition):
    return condition.replace(" ", "-")


def consistent(cell):
    nees = cell["nees_per_dof"]
    return Fact(f"{nees:.3f}", cell["nees_lower"] <= nees <= cell["nees_upper"])


def measure_tracker(bench):
    out = bench.fresh("uav/experiment-tracker")
    bench.alidade("experiment", "targets", "--only", "tracker", "--runs", RUNS, "-o", out, "--quiet")
    result = summary(out)["tracker"]
    for name, cell in STANDARD.items():
        score, shuffled = result["standard"][cell], result["standard"][f"{cell}, shuffled within 1 s"]
        yield f"tracker/{name}/rms-to-true-association", score["to_true_association"]
        yield f"tracker/{name}/switches", score["switches_per_run"]
        for event in ("found", "given-up"):
            for share in ("99", "worst"):
                yield f"tracker/{name}/{event}-{share}", score[f"{event.replace('-', '_')}_{share}_periods"]
        yield f"tracker/{name}/false-ids", score["false_ids_per_run"]
        yield f"tracker/{name}/gospa", score["gospa_m"]
        yield f"tracker/{name}/ospa", score["ospa_m"]
        yield f"tracker/{name}/shuffled-moves", shuffled["moved_by_shuffling_m"]
    for name, cell in SPACINGS.items():
        joint, nearest = (result["spacing"][f"{cell}, {method}"]["gospa_m"] for method in ("JPDA", "nearest neighbour"))
        yield f"tracker/1-m-apart/{name}/gospa-jpda-to-nearest", joint / nearest
    for name, cell in RECEIVERS.items():
        score = result["receivers"][cell]
        yield f"tracker/{name}/rms-to-bound", score["to_bound"]
        yield f"tracker/{name}/nees-per-degree", consistent(score)
    for condition in SWEEPS:
        score = result["sweeps"][condition]
        yield f"tracker/sweep/{word(condition)}/rms-to-true-association", score["to_true_association"]
        yield f"tracker/sweep/{word(condition)}/switches", score["switches_per_run"]
        yield f"tracker/sweep/{word(condition)}/gospa", score["gospa_m"]


def standard_figures(name):
    return [Figure(f"tracker/{name}/rms-to-true-association", at_most=1.1, goal=1.05),
            Figure(f"tracker/{name}/switches", "per run", at_most=0.02),
            *(Figure(f"tracker/{name}/{event}-{share}", "periods", at_most=3)
              for event in ("found", "given-up") for share in ("99", "worst")),
            Figure(f"tracker/{name}/false-ids", "per run"),
            Figure(f"tracker/{name}/gospa", "m"),
            Figure(f"tracker/{name}/ospa", "m"),
            Figure(f"tracker/{name}/shuffled-moves", "m", at_most=1e-9)]


TRACKER = Section("tracker", [
    *(figure for name in STANDARD for figure in standard_figures(name)),
    *(Figure(f"tracker/1-m-apart/{name}/gospa-jpda-to-nearest", below=1) for name in SPACINGS),
    *(figure for name in RECEIVERS for figure in (
        Figure(f"tracker/{name}/rms-to-bound", at_most=1.1, goal=1.05),
        Figure(f"tracker/{name}/nees-per-degree", expected="within its 95 % bounds"))),
    *(figure for condition in SWEEPS for figure in (
        Figure(f"tracker/sweep/{word(condition)}/rms-to-true-association"),
        Figure(f"tracker/sweep/{word(condition)}/switches", "per run"),
        Figure(f"tracker/sweep/{word(condition)}/gospa", "m"))),
], measure_tracker)


def measure_speed(bench):
    least = least_times(bench, "tracker_benchmark")
    yield "tracker/speed/filter-update", 1e-3 * least["filter_update"]
    for method in ("nearest", "joint"):
        for targets in (2, 5, 10):
            yield (f"tracker/speed/{method}/{targets}-targets",
                   1e-3 * least[f"scan_update/{method}/{targets}"] / targets)


SPEED = Section("tracker-speed", [
    Figure("tracker/speed/filter-update", "us"),
    *(Figure(f"tracker/speed/{method}/{targets}-targets", "us per scan and target", at_most=20, goal=5)
      for method in ("nearest", "joint") for targets in (2, 5, 10)),
], measure_speed)

SECTIONS = [TRACKER, SPEED]
