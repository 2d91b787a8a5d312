# SPDX-License-Identifier: Apache-2.0
"""Recordings with ground truth, and COLMAP on the same images in the same run."""

import math
import re

from figure_topics import colmap
from figure_topics.bench import frames, pose_count
from figure_topics.figure import Fact, Failed, Figure, Section

MILLI = 1000.0


def centre_error_mm(bench, estimate, truth, alignment, statistic="mean"):
    result = bench.evaluate(estimate, truth, "--align", alignment)
    return MILLI * result["ape_translation_m"][statistic]


def measure_fountain(bench):
    truth = bench.data("fountain")
    camera = truth / "0000.jpg.camera"
    out, ours = bench.track(truth, camera, "fountain/global", "--refine", "global")
    yield "fountain/global/cameras", pose_count(out / "trajectory.tum")
    error = centre_error_mm(bench, out / "trajectory.tum", truth, "sim3")
    yield "fountain/global/mean-centre-error-sim3", error

    given = ["--refine", "none", "--init-poses", truth]
    ekf, _ = bench.track(truth, camera, "fountain/ekf", *given, "--pose", "ekf")
    epnp, _ = bench.track(truth, camera, "fountain/epnp", *given, "--pose", "epnp")
    yield "fountain/ekf/cameras", pose_count(ekf / "trajectory.tum")
    yield "fountain/ekf/mean-centre-error-sim3", centre_error_mm(bench, ekf / "trajectory.tum", truth, "sim3")
    ekf_in_truth = centre_error_mm(bench, ekf / "trajectory.tum", truth, "none")
    epnp_in_truth = centre_error_mm(bench, epnp / "trajectory.tum", truth, "none")
    yield "fountain/ekf/mean-centre-error-given-frame", ekf_in_truth
    yield "fountain/epnp/mean-centre-error-given-frame", epnp_in_truth
    yield "fountain/ekf-to-epnp/mean-centre-error", ekf_in_truth / epnp_in_truth

    images = sorted(truth.glob("*.jpg"))
    errors, walls = [], []
    for matcher in ("sequential", "exhaustive"):
        trajectory, seconds = colmap.reconstruct(bench, images, colmap.strecha_intrinsics(camera), matcher,
                                                 f"fountain/colmap-{matcher}")
        errors.append(centre_error_mm(bench, trajectory, truth, "sim3"))
        walls.append(seconds)
        yield f"fountain/colmap-{matcher}/mean-centre-error-sim3", errors[-1]
        yield f"fountain/colmap-{matcher}/wall-time", seconds
    yield "fountain/global/wall-time", ours.seconds
    yield "fountain/to-better-colmap/mean-centre-error", error / min(errors)
    yield "fountain/to-faster-colmap/wall-time", ours.seconds / min(walls)


FOUNTAIN = Section("fountain", [
    Figure("fountain/global/cameras", at_least=11),
    Figure("fountain/global/mean-centre-error-sim3", "mm", at_most=2.5),
    Figure("fountain/ekf/cameras", at_least=11),
    Figure("fountain/ekf/mean-centre-error-sim3", "mm", at_most=3.0),
    Figure("fountain/ekf/mean-centre-error-given-frame", "mm"),
    Figure("fountain/epnp/mean-centre-error-given-frame", "mm"),
    Figure("fountain/ekf-to-epnp/mean-centre-error", at_most=0.35),
    Figure("fountain/colmap-sequential/mean-centre-error-sim3", "mm"),
    Figure("fountain/colmap-sequential/wall-time", "s"),
    Figure("fountain/colmap-exhaustive/mean-centre-error-sim3", "mm"),
    Figure("fountain/colmap-exhaustive/wall-time", "s"),
    Figure("fountain/global/wall-time", "s"),
    Figure("fountain/to-better-colmap/mean-centre-error", at_most=1.0, goal=0.9),
    Figure("fountain/to-faster-colmap/wall-time", at_most=0.4, goal=0.25),
], measure_fountain)


def states_after_start(result):
    """The states of the frames from the first that has a pose on."""
    states = [row["state"] for row in frames(result)]
    started = next((i for i, state in enumerate(states) if state in ("tracked", "predicted")), len(states))
    return states[started:]


def measure_seven_scenes(bench):
    data = bench.data("seven-scenes")
    out, _ = bench.track(data, data / "camera.txt", "seven-scenes")
    after_start = states_after_start(out)
    yield "seven-scenes/frames-before-start", len(frames(out)) - len(after_start)
    yield "seven-scenes/frames-without-pose-after-start", sum(s not in ("tracked", "predicted") for s in after_start)
    yield "seven-scenes/ate-rmse-sim3", MILLI / 10 * bench.evaluate(out / "trajectory.tum", data, "--align", "sim3")[
        "ape_translation_m"]["rmse"]


SEVEN_SCENES = Section("seven-scenes", [
    Figure("seven-scenes/frames-before-start"),
    Figure("seven-scenes/frames-without-pose-after-start", at_most=0),
    Figure("seven-scenes/ate-rmse-sim3", "cm", at_most=3.5, goal=3.2),
], measure_seven_scenes)


def straight_line_rmse(positions):
    """RMSE to the best straight line at constant speed: a linear regression of each coordinate over the frames."""
    count = len(positions)
    middle = (count - 1) / 2
    spread = sum((i - middle) ** 2 for i in range(count))
    squares = 0.0
    for axis in zip(*positions):
        mean = sum(axis) / count
        slope = sum((i - middle) * value for i, value in enumerate(axis)) / spread
        squares += sum((value - mean - slope * (i - middle)) ** 2 for i, value in enumerate(axis))
    return math.sqrt(squares / count)


def measure_kitti(bench):
    data = bench.data("kitti-clip")
    out, _ = bench.track(data, data / "calib.txt", "kitti-clip")
    result = bench.evaluate(out / "trajectory.tum", data, "--align", "sim3")
    rows = [[float(word) for word in line.split()] for line in (data / "poses.txt").read_text().splitlines() if line]
    line = 100 * straight_line_rmse([(row[3], row[7], row[11]) for row in rows]) / result["path_length_m"]
    ate = 100 * result["ape_translation_m"]["rmse"] / result["path_length_m"]
    yield "kitti-clip/ate-rmse-sim3", ate
    yield "kitti-clip/straight-line/ate-rmse-sim3", line
    yield "kitti-clip/to-straight-line", ate / line
    yield "kitti-clip/frame-to-frame-rotation-error-mean", result["rpe_rotation_deg"]["mean"]


KITTI = Section("kitti-clip", [
    Figure("kitti-clip/ate-rmse-sim3", "% of path", at_most=0.07),
    Figure("kitti-clip/straight-line/ate-rmse-sim3", "% of path"),
    Figure("kitti-clip/to-straight-line", below=1.0),
    Figure("kitti-clip/frame-to-frame-rotation-error-mean", "deg", at_most=0.06),
], measure_kitti)


def measure_tum(bench):
    data = bench.data("tum-fr1-rpy")
    out, run = bench.track(data, data / "camera.txt", "tum-fr1-rpy/free", code=None)
    if run.code not in (0, 4):
        raise Failed(f"tracking without a map exits {run.code}: {run.stderr.strip()[-200:]}")
    untold = [row for row in frames(out) if row["state"] != "tracked" and not row["reason"]]
    yield "tum-fr1-rpy/free/frames-without-pose-and-reason", len(untold)

    known_map = bench.fresh("tum-fr1-rpy/map")
    bench.alidade("map", data, "-o", known_map)
    out, _ = bench.track(data, data / "camera.txt", "tum-fr1-rpy/in-map", "--map", known_map)
    states = [row["state"] for row in frames(out)]
    yield "tum-fr1-rpy/in-map/frames-lost-or-waiting", sum(s not in ("tracked", "predicted") for s in states)
    yield "tum-fr1-rpy/in-map/frames-predicted", states.count("predicted")
    yield "tum-fr1-rpy/in-map/position-rmse", centre_error_mm(bench, out / "trajectory.tum", data, "none", "rmse")


TUM = Section("tum-fr1-rpy", [
    Figure("tum-fr1-rpy/free/frames-without-pose-and-reason", at_most=0),
    Figure("tum-fr1-rpy/in-map/frames-lost-or-waiting", at_most=0),
    Figure("tum-fr1-rpy/in-map/frames-predicted", at_most=1, goal=0),
    Figure("tum-fr1-rpy/in-map/position-rmse", "mm", at_most=15),
], measure_tum)


def reference_cases(text):
    """(words of the evo command, {statistic: printed digits}) of every block of reference-results.txt."""
    for block in text.split("## ")[1:]:
        command, *lines = block.strip().splitlines()
        yield command.split(), dict(line.split() for line in lines if len(line.split()) == 2)


def our_value(bench, data, words):
    """The statistics that `alidade evaluate` gives for an evo command."""
    alignment = "sim3" if "-as" in words else "se3" if "-a" in words else "none"
    result = bench.evaluate(data / words[3], data / words[2], "--align", alignment)
    kind = "rotation_deg" if "angle_deg" in words else "translation_m"
    return result[f"{'rpe' if words[0] == 'evo_rpe' else 'ape'}_{kind}"]


def measure_evaluation(bench):
    data = bench.data("trajectories")
    differing, total = [], 0
    for words, expected in reference_cases((data / "reference-results.txt").read_text(encoding="utf-8")):
        ours = our_value(bench, data, words)
        for statistic, digits in expected.items():
            decimals = len(re.sub(r"^[^.]*\.?", "", digits))
            total += 1
            if f"{ours[statistic]:.{decimals}f}" != digits:
                differing.append(f"{' '.join(words)} {statistic}")
    text = f"{total - len(differing)} of {total}" + (f" (first: {differing[0]})" if differing else "")
    yield "evaluation/statistics-equal-to-evo", Fact(text, total > 0 and not differing)


EVALUATION = Section("evaluation", [
    Figure("evaluation/statistics-equal-to-evo", expected="all printed digits"),
], measure_evaluation)

SECTIONS = [FOUNTAIN, SEVEN_SCENES, KITTI, TUM, EVALUATION]
