# SPDX-License-Identifier: Apache-2.0
"""marker1d: bodies of the paper page's scene, simulated and tracked by the program, by the seed paper's method and ours;
`alidade experiment body` in part after part, and the solvers' benchmark."""

import shutil

from figure_topics.bench import summary
from figure_topics.benchmark import least_times
from figure_topics.figure import Fact, Figure, Section
from figure_topics.tables import rows_of, write_rows

FRAMES = 10000


def scene(bench, name, *words):
    """A simulated recording with truth."""
    out = bench.fresh(f"marker1d/{name}/scene")
    bench.alidade("simulate", "body", "--frames", FRAMES, *words, "-o", out, "--quiet")
    return out


def track(bench, recording, name, *words):
    """What a method makes of it: its summary and its errors against the truth."""
    out = bench.fresh(f"marker1d/{name}")
    bench.alidade("track", "body", recording / "body.csv", recording / "detectors.yaml", recording / "observations.csv",
                  "-o", out, "--quiet", *words)
    return summary(out), bench.evaluate(out / "trajectory.tum", recording / "truth.tum", "--align", "none")


def tracks(bench, name, *words):
    """Forward, smoothed and the paper's method on one recording."""
    recording = scene(bench, name, *words)
    return (track(bench, recording, f"{name}/forward", "--lag-s", 0), track(bench, recording, f"{name}/smoothed"),
            track(bench, recording, f"{name}/paper", "--method", "paper"))


def rms(tracked):
    return tracked[1]["ape_translation_m"]["rmse"]


def nees_fact(value):
    return Fact(f"{value:.3f}", 0.8 <= value <= 1.25)


def nees(tracked):
    return nees_fact(tracked[1]["nees"]["mean_per_degree_of_freedom"])


def share(tracked):
    return 100 * tracked[0]["bodies"][0]["tracked"] / FRAMES


# Name and words of each recording.
RECORDINGS = [("clean", ()), ("wrong-ids-30", ("--wrong-ids", 0.3)), ("occluded-60", ("--occluded", 0.6))]


def measure(name, words):
    def run(bench):
        forward, smoothed, paper = tracks(bench, name, *words)
        yield f"{name}/rms", 1e3 * rms(forward)
        yield f"{name}/paper-to-ours", rms(paper) / rms(forward)
        yield f"{name}/smoothed-to-forward", rms(smoothed) / rms(forward)
        yield f"{name}/worst", 1e3 * forward[1]["ape_translation_m"]["max"]
        yield f"{name}/answered", share(forward)
        yield f"{name}/nees-per-degree", nees(forward)
    return run


def figures(name):
    occluded, wrong = name.startswith("occluded"), name == "wrong-ids-30"
    return [Figure(f"{name}/rms", "mm"),
            Figure(f"{name}/paper-to-ours", at_least=90 if occluded else None, goal=100 if occluded else None),
            Figure(f"{name}/smoothed-to-forward", at_most=0.7 if occluded else None, goal=0.6 if occluded else None),
            Figure(f"{name}/worst", "mm", at_most=5 if wrong else None),
            Figure(f"{name}/answered", "%"),
            Figure(f"{name}/nees-per-degree", expected="0.8 to 1.25")]


def alone(bench, recording, body):
    """The part of a recording that is of one body."""
    out = bench.fresh(f"marker1d/several/{body}-scene")
    out.mkdir(parents=True)
    markers = [row for row in rows_of(recording / "body.csv") if row["body"] == body]
    names = {row["marker"] for row in markers}
    write_rows(out / "body.csv", markers)
    write_rows(out / "observations.csv",
               [row for row in rows_of(recording / "observations.csv") if row["marker"] in names])
    shutil.copy(recording / "detectors.yaml", out)
    return out


def follow(bench, recording, name):
    out = bench.fresh(f"marker1d/several/{name}")
    bench.alidade("track", "body", recording / "body.csv", recording / "detectors.yaml", recording / "observations.csv",
                  "--lag-s", 0, "-o", out, "--quiet")
    return out


def measure_several(bench):
    recording = scene(bench, "several", "--bodies", 2)
    together = follow(bench, recording, "together")
    for body in ("body1", "body2"):
        errors = [bench.evaluate(track, recording / f"truth_{body}.tum", "--align", "none")["ape_translation_m"]["rmse"]
                  for track in (together / f"{body}.tum",
                                follow(bench, alone(bench, recording, body), f"{body}-alone") / "trajectory.tum")]
        yield f"several/{body}/together-to-alone", errors[0] / errors[1]


SEVERAL = Section("several", [Figure(f"several/{body}/together-to-alone", at_most=1.001)
                              for body in ("body1", "body2")], measure_several)


def experiment(bench, part):
    """The summary of one part of the experiment."""
    out = bench.fresh(f"marker1d/experiment-{part}")
    bench.alidade("experiment", "body", "--only", part, "--frames", FRAMES, "-o", out, "--quiet")
    return summary(out)[part]


def measure_solvers(bench):
    result = experiment(bench, "solvers")
    for name, value in result["derivatives"].items():
        yield f"derivatives/{name.replace('_', '-')}", value
    for name, value in result["exact"].items():
        yield f"exact/{name}", value
    yield "agreement/paper-ours", result["agreement"]["paper_ours"]
    yield "agreement/ours-ceres", result["agreement"]["ours_ceres"]


SOLVERS = Section("solvers", [
    *(Figure(f"derivatives/{name}", at_most=1e-9)
      for name in ("rotation", "rotation-second", "equations", "readings")),
    *(Figure(f"exact/{name}", "m", at_most=1e-12) for name in ("paper", "ours")),
    *(Figure(f"agreement/{pair}", "m", at_most=1e-8) for pair in ("paper-ours", "ours-ceres")),
], measure_solvers)


def to_bound(name, cell):
    yield f"{name}/ours-to-bound", cell["ours"]["position_to_bound"]
    yield f"{name}/ours-rotation-to-bound", cell["ours"]["rotation_to_bound"]
    yield f"{name}/paper-to-bound", cell["paper"]["position_to_bound"]


def bound_figures(name, at_most=None, goal=None):
    return [*(Figure(f"{name}/{figure}-to-bound", at_most=at_most, goal=goal) for figure in ("ours", "ours-rotation")),
            Figure(f"{name}/paper-to-bound")]


DETECTORS = (8, 12, 16, 24, 32)


def measure_accuracy(bench):
    result = experiment(bench, "accuracy")
    for name, cell in result["clean"].items():
        yield from to_bound(f"bound/{name.replace(' ', '-')}", cell)
    by_markers = result["detectors"]
    for markers, cells in by_markers.items():
        for count in DETECTORS:
            for method in ("paper", "ours"):
                yield (f"fig-2/{markers}-markers/{count}-detectors/{method}",
                       1e3 * cells[str(count)][method]["position_rms_m"])
    for method in ("paper", "ours"):
        rms_of = {m: [cells[str(n)][method]["position_rms_m"] for n in DETECTORS] for m, cells in by_markers.items()}
        falls = all(b < a for errors in rms_of.values() for a, b in zip(errors, errors[1:]))
        four_better = all(four < three for three, four in zip(rms_of["3"], rms_of["4"]))
        yield f"fig-2/claim/{method}", Fact("confirmed" if falls and four_better else "not confirmed", True)


ACCURACY = Section("accuracy", [
    *(figure for markers in (3, 4, 8) for figure in bound_figures(f"bound/{markers}-markers", 1.02, 1.01)),
    *(Figure(f"fig-2/{markers}-markers/{count}-detectors/{method}", "mm")
      for markers in (3, 4) for count in DETECTORS for method in ("paper", "ours")),
    *(Figure(f"fig-2/claim/{method}", expected="confirmed or not") for method in ("paper", "ours")),
], measure_accuracy)


def measure_wrong_ids(bench):
    result = experiment(bench, "wrong-ids")
    for percent in WRONG_IDS:
        yield from to_bound(f"bound/wrong-ids-{percent}", result[str(percent)])
        yield f"bound/wrong-ids-{percent}/nees-per-degree", nees_fact(result[str(percent)]["ours"]["nees_per_dof"])
    yield "bound/wrong-ids-30/worst", 1e3 * result["30"]["ours"]["worst_m"]


WRONG_IDS = {2: (None, None), 5: (None, None), 10: (None, None), 20: (None, None), 30: (1.05, 1.02), 45: (1.10, None)}
WRONG = Section("wrong-ids", [
    *(figure for percent, bounds in WRONG_IDS.items() for figure in (
        *bound_figures(f"bound/wrong-ids-{percent}", *bounds),
        Figure(f"bound/wrong-ids-{percent}/nees-per-degree", expected="0.8 to 1.25"))),
    Figure("bound/wrong-ids-30/worst", "mm", at_most=5),
], measure_wrong_ids)


def measure_occlusion(bench):
    result = experiment(bench, "occlusion")
    for percent in OCCLUDED:
        cell = result[str(percent)]
        forward = cell["ours"]["position_rms_m"]
        yield f"hidden/{percent}/padding-to-ours", cell["paper"]["position_rms_m"] / forward
        yield f"hidden/{percent}/paper-backward-to-forward", (cell["paper, backward"]["position_rms_m"]
                                                              / cell["paper"]["position_rms_m"])
        yield f"hidden/{percent}/smoothed-to-forward", cell["ours, smoothed"]["position_rms_m"] / forward
        yield f"hidden/{percent}/nees-per-degree", nees_fact(cell["ours"]["nees_per_dof"])
        yield f"hidden/{percent}/smoothed-nees-per-degree", nees_fact(cell["ours, smoothed"]["nees_per_dof"])


OCCLUDED = (20, 40, 60)
OCCLUSION = Section("occlusion", [figure for percent in OCCLUDED for figure in (
    Figure(f"hidden/{percent}/padding-to-ours", at_least=90 if percent == 60 else None,
           goal=100 if percent == 60 else None),
    Figure(f"hidden/{percent}/paper-backward-to-forward"),
    Figure(f"hidden/{percent}/smoothed-to-forward", at_most=0.7, goal=0.6),
    Figure(f"hidden/{percent}/nees-per-degree", expected="0.8 to 1.25"),
    Figure(f"hidden/{percent}/smoothed-nees-per-degree", expected="0.8 to 1.25"))], measure_occlusion)


FULL = ("any readings, 4 markers", "any readings, 3 markers")
WITH_WRONG = ("20 % wrong ids", "30 % wrong ids")
FEW = ("2+2+2", "1+2+3", "3+2+2", "3+3+2", "3+3+3", "4+4+4")


def word(condition):
    return condition.replace(",", "").replace(" %", "").replace(" ", "-")


def measure_start(bench):
    result = experiment(bench, "start")
    for condition in (*FULL, *WITH_WRONG, *FEW):
        tally = result[condition]
        yield f"start/{word(condition)}/certain-and-wrong", tally["certain_wrong"]
        yield f"start/{word(condition)}/truth-among-candidates", 100 * tally["truth_among"]
        yield f"start/{word(condition)}/answered", 100 * (1 - tally["none"] / tally["trials"])
        yield f"start/{word(condition)}/time", tally["cpu_ms"]
    for condition in FEW:
        counts = result[condition]["exact_solutions"]
        shares = ", ".join(f"{n}: {100 * count / sum(counts):.1f}" for n, count in enumerate(counts) if count)
        yield f"start/{condition}/exact-poses", Fact(shares + " %", True)


START = Section("start", [
    *(figure for condition in (*FULL, *WITH_WRONG, *FEW) for figure in (
        Figure(f"start/{word(condition)}/certain-and-wrong", at_most=None if condition in WITH_WRONG else 0),
        Figure(f"start/{word(condition)}/truth-among-candidates", "%",
               at_least=None if condition in WITH_WRONG else 99.9),
        Figure(f"start/{word(condition)}/answered", "%"),
        Figure(f"start/{word(condition)}/time", "ms", at_most=1 if condition in FULL else None))),
    *(Figure(f"start/{condition}/exact-poses", expected="number: share") for condition in FEW),
], measure_start)


def measure_lines(bench):
    for snr, cell in experiment(bench, "lines").items():
        yield f"lines/snr-{snr}/ids-right", 100 * cell["ids_right_share"]
        yield f"lines/snr-{snr}/identified", 100 * cell["identified_share"]
        yield f"lines/snr-{snr}/position-to-bound", cell["position_to_bound"]
        yield f"lines/snr-{snr}/pose-to-exact", max(cell["pose_position_to_exact"], cell["pose_rotation_to_exact"])


def line_figures(snr):
    bounded = snr == 10
    return [Figure(f"lines/snr-{snr}/ids-right", "%", at_least=99.5 if bounded else None),
            Figure(f"lines/snr-{snr}/identified", "%"),
            Figure(f"lines/snr-{snr}/position-to-bound", at_most=1.3 if bounded else None),
            Figure(f"lines/snr-{snr}/pose-to-exact", at_most=1.2 if bounded else None)]


LINES = Section("lines", [figure for snr in (5, 10, 20, 100) for figure in line_figures(snr)], measure_lines)


def measure_loop(bench):
    result = experiment(bench, "speed")
    yield "loop/paper", result["paper"]["steps_per_s"]
    yield "loop/ours", result["ours"]["steps_per_s"]
    confirmed = result["paper"]["steps_per_s"] >= 10000
    yield "loop/claim", Fact("confirmed" if confirmed else "not confirmed", True)


LOOP = Section("loop", [Figure("loop/paper", "steps/s"), Figure("loop/ours", "steps/s"),
                        Figure("loop/claim", expected="confirmed or not")], measure_loop)


def measure_benchmark(bench):
    least = least_times(bench, "plane_pose_benchmark")
    yield "speed/robust-to-ceres", least["ceres_robust/32"] / least["robust_descent/32"]
    yield "speed/whole-robust-to-ceres", least["ceres_robust/32"] / least["robust/32"]
    yield "speed/newton-to-gauss-newton", least["gauss_newton/32"] / least["newton/32"]
    yield "speed/96-planes-to-12", least["newton/96"] / least["newton/12"]
    yield "speed/newton-solve", 1e6 / least["newton_solve"]


SPEED = Section("speed", [
    Figure("speed/robust-to-ceres", at_least=50, goal=80),
    Figure("speed/whole-robust-to-ceres"),
    Figure("speed/newton-to-gauss-newton", at_least=2.5, goal=4),
    Figure("speed/96-planes-to-12", at_most=1.5, goal=1.25),
    Figure("speed/newton-solve", "k/s", at_least=700, goal=1000),
], measure_benchmark)


SECTIONS = [*(Section(name, figures(name), measure(name, words)) for name, words in RECORDINGS),
            SEVERAL, SOLVERS, ACCURACY, WRONG, OCCLUSION, START, LINES, LOOP, SPEED]
