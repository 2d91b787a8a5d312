# SPDX-License-Identifier: Apache-2.0
"""marker1d: bodies of the paper page's scene, simulated and tracked by the program, by the seed paper's method and ours."""

from figure_topics.bench import summary
from figure_topics.figure import Fact, Figure, Section

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


def nees(tracked):
    value = tracked[1]["nees"]["mean_per_degree_of_freedom"]
    return Fact(f"{value:.3f}", 0.8 <= value <= 1.25)


def share(tracked):
    return 100 * tracked[0]["bodies"][0]["tracked"] / FRAMES


# Name and words of each recording.
RECORDINGS = [*((f"clean/{markers}-markers", ("--markers", markers)) for markers in (3, 4, 8)),
              *((f"wrong-ids-{percent}", ("--wrong-ids", percent / 100)) for percent in (5, 30, 45)),
              ("occluded-60", ("--occluded", 0.6))]


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


SECTIONS = [Section(name, figures(name), measure(name, words)) for name, words in RECORDINGS]
