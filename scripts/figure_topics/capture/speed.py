# SPDX-License-Identifier: Apache-2.0
"""How fast frames come through: what the benchmark of the GigE client says, beside a bare loop on Aravis."""

import json

from figure_topics.capture.programs import program
from figure_topics.figure import Failed, Figure, Section

SIZES = ["512x512", "1280x720", "2048x2048"]
CAMERAS = ["test_camera", "aravis_camera"]


def measure(bench):
    out = bench.fresh("capture/speed.json")
    bench.run(program("benchmark/gige_benchmark"), f"--benchmark_out={out}", "--benchmark_out_format=json")
    told = {}
    for run in json.loads(out.read_text(encoding="utf-8"))["benchmarks"]:
        if run.get("error_occurred"):
            raise Failed(f"{run['name']}: {run['error_message']}")
        told["/".join(run["name"].split("/")[:3])] = run
    for camera in CAMERAS:
        for size in SIZES:
            ours, bare = told[f"{camera}/{size}/ours"], told[f"{camera}/{size}/bare_aravis"]
            yield f"throughput/{camera}/{size}/lost", ours["lost"] + ours["damaged"]
            yield f"throughput/{camera}/{size}/rate", ours["fps"]
            yield f"throughput/{camera}/{size}/bytes", ours["MB/s"]
            yield f"throughput/{camera}/{size}/processor", ours["CPU_%"]
            yield f"throughput/{camera}/{size}/bare-aravis-rate", bare["fps"]
            yield f"throughput/{camera}/{size}/bare-aravis-lost", bare["lost"] + bare["damaged"]


FIGURES = [figure for camera in CAMERAS for size in SIZES for figure in (
    Figure(f"throughput/{camera}/{size}/lost", "frames", at_most=0),
    Figure(f"throughput/{camera}/{size}/rate", "frames/s"),
    Figure(f"throughput/{camera}/{size}/bytes", "MB/s"),
    Figure(f"throughput/{camera}/{size}/processor", "% of a core"),
    Figure(f"throughput/{camera}/{size}/bare-aravis-rate", "frames/s"),
    Figure(f"throughput/{camera}/{size}/bare-aravis-lost", "frames"),
)]  # fmt: skip

SECTIONS = [Section("throughput", FIGURES, measure)]
