# SPDX-License-Identifier: Apache-2.0
"""What the project's benchmarks measure."""

import json

from figure_topics.bench import ROOT
from figure_topics.figure import Failed


class Times(dict):
    """CPU time of each benchmark, ns, by its name."""

    def __missing__(self, name):
        raise Failed(f"the benchmark has no {name}: {', '.join(self)}")


def least_times(bench, target):
    """The least CPU time of five repetitions of each benchmark of a target that is built for it."""
    bench.run(ROOT / "scripts" / "build", "release", target)
    run = bench.run(ROOT / "build" / "release" / "tests" / "benchmark" / target, "--benchmark_format=json",
                    "--benchmark_repetitions=5")
    nanoseconds = {"ns": 1.0, "us": 1e3, "ms": 1e6}
    least = Times()
    for row in json.loads(run.stdout)["benchmarks"]:
        if row["run_type"] == "iteration":
            time = row["cpu_time"] * nanoseconds[row["time_unit"]]
            least[row["run_name"]] = min(time, least.get(row["run_name"], float("inf")))
    return least
