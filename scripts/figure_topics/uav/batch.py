# SPDX-License-Identifier: Apache-2.0
"""uav: the stamped batch against its bound; the placement map's bound; what both, and a window, cost."""

from figure_topics.bench import summary
from figure_topics.benchmark import least_times
from figure_topics.figure import Fact, Figure, Section

RUNS = 5000
PLACEMENT_RUNS = 500
STRAIGHT = ("2 receivers", "3 receivers", "4 receivers", "6 receivers", "3 receivers, .3/.4")
ACCELERATING = tuple(f"{count} receivers, accelerating" for count in (2, 3, 4, 6))


def experiment(bench, part, runs):
    """The summary of one part of the experiment."""
    out = bench.fresh(f"uav/experiment-{part}")
    bench.alidade("experiment", "targets", "--only", part, "--runs", runs, "-o", out, "--quiet")
    return summary(out)[part]


def word(cell):
    return cell.replace(",", "").replace(".", "").replace("/", "-").replace(" ", "-").lower()


def measure_batch(bench):
    result = experiment(bench, "batch", RUNS)
    for cell in (*STRAIGHT, *ACCELERATING):
        values, nees = result[cell], result[cell]["nees"]
        ratio = values["to_bound"]
        yield f"batch/{word(cell)}/to-bound", Fact(f"{ratio['value']:.3f}", 0.97 <= ratio["value"] <= 1.03)
        yield f"batch/{word(cell)}/nees-per-degree", Fact(
            f"{nees['mean_per_degree']:.4f} in [{nees['lower']:.4f}, {nees['upper']:.4f}]",
            nees["lower"] <= nees["mean_per_degree"] <= nees["upper"])
        yield f"batch/{word(cell)}/determined", 100 * values["determined"] / RUNS


BATCH = Section("batch", [figure for cell in (*STRAIGHT, *ACCELERATING) for figure in (
    Figure(f"batch/{word(cell)}/to-bound", expected="0.97 to 1.03"),
    Figure(f"batch/{word(cell)}/nees-per-degree", expected="within its 95 % bounds"),
    Figure(f"batch/{word(cell)}/determined", "%", at_least=99.9))], measure_batch)


def measure_placement(bench):
    result = experiment(bench, "placement", PLACEMENT_RUNS)
    yield "placement/bound-off-monte-carlo", 100 * result["farthest_from_one"]
    yield "placement/answered", 100 * min(result["answered"]) / PLACEMENT_RUNS


PLACEMENT = Section("placement", [Figure("placement/bound-off-monte-carlo", "%", at_most=5),
                                  Figure("placement/answered", "%", at_least=100)], measure_placement)


def measure_speed(bench):
    least = least_times(bench, "target_benchmark")
    yield "batch/fit-time", 1e-3 * least["batch_fit/6"]
    yield "batch/fit-time-accelerating", 1e-3 * least["batch_fit/9"]
    yield "window/time/m-10", 1e-6 * least["twenty_windows/10"] / 20
    for fewer, more in ((5, 10), (10, 20)):
        yield f"window/{more}-to-{fewer}", least[f"twenty_windows/{more}"] / least[f"twenty_windows/{fewer}"]


SPEED = Section("target-speed", [
    Figure("batch/fit-time", "us"),
    Figure("batch/fit-time-accelerating", "us"),
    Figure("window/time/m-10", "ms", at_most=50),
    Figure("window/10-to-5", at_most=4.5),
    Figure("window/20-to-10", at_most=4.5),
], measure_speed)

SECTIONS = [BATCH, PLACEMENT, SPEED]
