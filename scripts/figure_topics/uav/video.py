# SPDX-License-Identifier: Apache-2.0
"""uav: rendered videos of flying dots before clouds and ground; `alidade experiment targets --only video`."""

from figure_topics.bench import summary
from figure_topics.figure import Figure, Section

FRAMES = 600  # of each size and SNR, in four videos
CAMERAS = ("still", "swaying")
SIZES, SNRS = (2, 3, 4, 6), (3, 5, 8)
LEAST_SIZE, LEAST_SNR = 3, 5  # of what has to be found
EVIDENCES, THRESHOLDS = ("6.5", "7.5", "9", "14"), ("9", "16", "36", "64")


def cells():
    return [(camera, size, snr) for camera in CAMERAS for size in SIZES for snr in SNRS]


def name_of(camera, size, snr):
    return f"video/{camera}/{size}px-snr{snr}"


def contenders():
    return {**{f"ours, evidence {word}": f"ours-{word}" for word in EVIDENCES},
            **{f"MOG2, variance threshold {word}": f"mog2-{word}" for word in THRESHOLDS}}


def measure(bench):
    out = bench.fresh("uav/experiment-video")
    bench.alidade("experiment", "targets", "--only", "video", "--runs", FRAMES, "-o", out, "--quiet")
    result = summary(out)["video"]
    for camera, size, snr in cells():
        cell = result["cells"][camera][f"{size} px, SNR {snr}"]
        yield f"{name_of(camera, size, snr)}/found", cell["probability"]
        yield f"{name_of(camera, size, snr)}/centre", cell["rms_px"]
        yield f"{name_of(camera, size, snr)}/found-by-mog2", cell["mog2_probability"]
    for camera in CAMERAS:
        accepted, chain = result["accepted"][camera], result["chain"][camera]
        yield f"video/{camera}/found", accepted["probability"]
        yield f"video/{camera}/false-per-frame", accepted["false_per_frame"]
        yield f"video/{camera}/nees-per-degree", accepted["nees_per_dof"]
        for contender, short in contenders().items():
            cell = result["thresholds"][camera][contender]
            yield f"video/{camera}/{short}/found", cell["probability"]
            yield f"video/{camera}/{short}/false-per-frame", cell["false_per_frame"]
        yield f"video/{camera}/frames-per-second", result["speed"][camera]["frames_per_s"]
        yield f"video/{camera}/tracks/share-of-moments", 100 * chain["videos"]["completeness"]
        yield f"video/{camera}/tracks/false", chain["videos"]["false_tracks"]
        yield f"video/{camera}/tracks/rmse", 1e3 * chain["videos"]["rms_m"]
        yield f"video/{camera}/tracks/to-true-pixels", chain["rms_ratio"]


def cell_figures(camera, size, snr):
    plain = size >= LEAST_SIZE and snr >= LEAST_SNR
    return [Figure(f"{name_of(camera, size, snr)}/found", at_least=0.95 if plain else None),
            Figure(f"{name_of(camera, size, snr)}/centre", "px"),
            Figure(f"{name_of(camera, size, snr)}/found-by-mog2")]


def camera_figures(camera):
    return [Figure(f"video/{camera}/found", at_least=0.95),
            Figure(f"video/{camera}/false-per-frame", at_most=0.5),
            Figure(f"video/{camera}/nees-per-degree"),
            *(Figure(f"video/{camera}/{short}/{what}")
              for short in contenders().values() for what in ("found", "false-per-frame")),
            Figure(f"video/{camera}/frames-per-second", "frames/s", at_least=30),
            Figure(f"video/{camera}/tracks/share-of-moments", "%", at_least=95),
            Figure(f"video/{camera}/tracks/false", at_most=0),
            Figure(f"video/{camera}/tracks/rmse", "mm"),
            Figure(f"video/{camera}/tracks/to-true-pixels", at_most=1.5)]


SECTIONS = [Section("video", [*(figure for cell in cells() for figure in cell_figures(*cell)),
                              *(figure for camera in CAMERAS for figure in camera_figures(camera))], measure)]
