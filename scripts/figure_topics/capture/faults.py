# SPDX-License-Identifier: Apache-2.0
"""What cameras that fail cost: V4L2 in an emulated machine, GenICam on loopback, recordings that are cut short."""

import json

from figure_topics.bench import ROOT, last_line
from figure_topics.capture.programs import json_lines, program
from figure_topics.figure import Fact, Failed, Figure, Section, Skipped

UNPLUGGED, DROPS = 50, 2000
KILLED, LOST_FRAMES, CLOCKS_S = 20, 4000, 30
CUT_SHORT, FULL_DISKS = 50, 5


def of(count, all_of):
    return Fact(f"{count:g} of {all_of:g}", count == all_of and all_of > 0)


def measure_v4l2(bench):
    out = bench.fresh("capture/v4l2")
    run = bench.run(ROOT / "scripts" / "test-v4l2-vm", "--figures", "--cycles", UNPLUGGED, "--drops", DROPS,
                    "--timeout", 900, "--output", out, code=None)  # fmt: skip
    if run.code == 77:
        raise Skipped(last_line(run.stdout))
    results = json.loads((out / "results.json").read_text(encoding="utf-8"))
    told = results["figures"]
    yield "v4l2/tests-passed", of(sum(test["outcome"] == "passed" for test in results["tests"].values()),
                                  len(results["tests"]))
    yield "v4l2/unplug/streaming-again", of(told["v4l2_unplug_recovered"], UNPLUGGED)
    yield "v4l2/unplug/in-time", of(told["v4l2_unplug_in_time"], UNPLUGGED)
    yield "v4l2/unplug/slowest-event", told["v4l2_unplug_event_periods"]
    yield "v4l2/unplug/slowest-return", told["v4l2_unplug_streaming_again_s"]
    yield "v4l2/unplug/descriptors-gained", told["v4l2_unplug_more_descriptors"]
    yield "v4l2/unplug/memory-gained", told["v4l2_unplug_more_memory_kb"]
    event_s, bound_s = told["v4l2_stall_event_s"], told["v4l2_stall_bound_s"]
    yield "v4l2/stall/event", Fact(f"{event_s:.3f} s, bound {bound_s:.3f} s", event_s <= bound_s)
    yield "v4l2/stall/opencv-blocks", told["opencv_stall_blocked_s"]
    yield "v4l2/drops/frames", told["v4l2_drop_frames"]
    yield "v4l2/drops/manifest-less-driver", abs(told["v4l2_drop_reported"] - told["v4l2_drop_sequence_gaps"])
    yield "v4l2/buffer-errors/flagged", of(told["v4l2_buffer_errors_flagged"], told["v4l2_buffer_errors_injected"])


V4L2 = Section("v4l2", [
    Figure("v4l2/tests-passed", expected="all"),
    Figure("v4l2/unplug/streaming-again", expected="all", goal=500),
    Figure("v4l2/unplug/in-time", expected="all", goal=500),
    Figure("v4l2/unplug/slowest-event", "periods", at_most=2),
    Figure("v4l2/unplug/slowest-return", "s", at_most=1),
    Figure("v4l2/unplug/descriptors-gained", at_most=0),
    Figure("v4l2/unplug/memory-gained", "kB", at_most=1024),
    Figure("v4l2/stall/event", expected="<= 5 periods, 0.25 s"),
    Figure("v4l2/stall/opencv-blocks", "s"),
    Figure("v4l2/drops/frames", at_least=DROPS),
    Figure("v4l2/drops/manifest-less-driver", at_most=0),
    Figure("v4l2/buffer-errors/flagged", expected="all"),
], measure_v4l2)

# Our names of what genicam_faults measures: (its section, its name), the figure.
GENICAM_FIGURES = {
    ("kill", "cycles survived"): Figure("genicam/kill/streaming-again", at_least=KILLED, goal=100),
    ("kill", "slowest event after the last frame"): Figure("genicam/kill/slowest-event", "ms", at_most=266.7),
    ("kill", "slowest return after the camera is back"): Figure("genicam/kill/slowest-return", "ms", at_most=2000),
    ("kill", "descriptors gained"): Figure("genicam/kill/descriptors-gained", at_most=0),
    ("kill", "threads gained"): Figure("genicam/kill/threads-gained", at_most=0),
    ("kill", "memory gained since the first cycle"): Figure("genicam/kill/memory-gained", "MB", at_most=8),
    ("loss", "complete frames at 0.5 % of packets lost"): Figure("genicam/loss-0.5%/complete", "%", at_least=99.9),
    ("loss", "frames not told of at 0.5 % of packets lost"): Figure("genicam/loss-0.5%/not-told-of", at_most=0),
    ("loss", "wrong frames shown as good at 0.5 % of packets lost"): Figure("genicam/loss-0.5%/wrong", at_most=0),
    ("loss", "complete frames at 2 % of packets lost"): Figure("genicam/loss-2%/complete", "%", at_least=99),
    ("loss", "frames not told of at 2 % of packets lost"): Figure("genicam/loss-2%/not-told-of", at_most=0),
    ("loss", "wrong frames shown as good at 2 % of packets lost"): Figure("genicam/loss-2%/wrong", at_most=0),
    ("drop", "frames counted as dropped less those never sent"): Figure("genicam/drops/manifest-less-camera", at_most=0),
    ("clock", "largest error of the time of exposure, 40 ppm fast"): Figure("genicam/two/first-time-error", "ms", at_most=1),
    ("clock", "largest error of the time of exposure, 25 ppm slow"): Figure("genicam/two/second-time-error", "ms", at_most=1),
    ("clock", "troubles of a camera when the other is killed"): Figure("genicam/two/troubles-of-the-other", at_most=0),
}  # fmt: skip


def measure_genicam(bench):
    sections = ["kill", "loss", "drop", "clock"]
    words = [word for section in sections for word in ("--section", section)]
    run = bench.run(program("faults/genicam/genicam_faults"), *words, "--cycles", KILLED, "--frames", LOST_FRAMES,
                    "--loss", 0.005, "--loss", 0.02, "--clocks", CLOCKS_S, "--json", code=None)  # fmt: skip
    for told in json_lines(run.stdout):
        figure = GENICAM_FIGURES.get((told["section"], told["name"]))
        if figure:
            yield figure.name, told["value"]


GENICAM = Section("genicam", list(GENICAM_FIGURES.values()), measure_genicam)


def measure_recordings(bench):
    run = bench.run(program("faults/recording/recording_faults"), "--count", CUT_SHORT, "--json", code=None)
    told = {line["section"]: line for line in json_lines(run.stdout)}
    if not told:
        raise Failed(f"recording_faults: {last_line(run.stderr)}")
    kill, disk, exact = told["kill"], told["full-disk"], told["exact"]
    yield "recording/kill/kills", kill["kills"]
    yield "recording/kill/confirmed-lost", kill["confirmed_lost"]
    yield "recording/kill/confirmed-lost-by-ffprobe", kill["confirmed_lost_by_ffprobe"]
    yield "recording/kill/wrong", kill["wrong"]
    yield "recording/kill/most-unconfirmed", kill["most_unconfirmed"]
    yield "recording/exact/wrong-or-missing", exact["wrong"] + exact["missing"]
    if "skipped" in disk:
        raise Skipped(disk["skipped"])
    yield "recording/full-disk/slowest-report", disk["slowest_report_s"]
    yield "recording/full-disk/claimed-lost", disk["claimed_lost"] + disk["half_rows"] + disk["wrong"]
    yield "recording/full-disk/claimed-lost-by-ffprobe", disk["claimed_lost_by_ffprobe"]


RECORDINGS = Section("recording", [
    Figure("recording/kill/kills", at_least=CUT_SHORT, goal=100),
    Figure("recording/kill/confirmed-lost", "frames", at_most=0),
    Figure("recording/kill/confirmed-lost-by-ffprobe", "frames", at_most=0),
    Figure("recording/kill/wrong", "frames", at_most=0),
    Figure("recording/kill/most-unconfirmed", "frames", at_most=3),
    Figure("recording/exact/wrong-or-missing", "frames", at_most=0),
    Figure("recording/full-disk/slowest-report", "s", at_most=1),
    Figure("recording/full-disk/claimed-lost", "frames", at_most=0),
    Figure("recording/full-disk/claimed-lost-by-ffprobe", "frames", at_most=0),
], measure_recordings)

SECTIONS = [V4L2, GENICAM, RECORDINGS]
