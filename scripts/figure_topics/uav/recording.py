# SPDX-License-Identifier: Apache-2.0
"""uav: a real flight seen by six unsynchronised cameras; `alidade experiment targets --only recording`. Poses and clocks
are of its first half, scores of the second, which nothing was fitted to."""

from figure_topics.bench import summary
from figure_topics.figure import Fact, Figure, Section

# Bounds and goals are meant with all epochs of the truth, seven of which jump; without them it is printed beside.
ACCURACY = {"static": None, "clocks-given": None, "path": "bounds", "path-where-static": None, "static-focal": None,
            "path-focal": None}
STARTS = ("undisturbed", "disturbed_1", "disturbed_2", "disturbed_3")


def named(check):
    """Of the faults that were put in, how many are named and what is named besides."""
    text = f"{check['named']} of {check['put_in']}, besides {check['besides']}"
    return Fact(text, check["named"] == check["put_in"] and check["besides"] == 0)


def measure_accuracy(found):
    for name in ACCURACY:
        score = found[name.replace("-", "_")]
        yield f"recording/{name}/epochs", 100 * score["share"]
        yield f"recording/{name}/rmse", score["rmse_m"]
        yield f"recording/{name}/aligned", score["aligned_rmse_m"]
        yield f"recording/{name}/rmse-without-jumps", score["rmse_without_jumps_m"]
        yield f"recording/{name}/aligned-without-jumps", score["aligned_rmse_without_jumps_m"]
    yield "recording/path/error-to-stated", found["path"]["error_per_sigma_to_theory"]
    yield "recording/path-focal/error-to-stated", found["path_focal"]["error_per_sigma_to_theory"]


def accuracy_figures():
    for name, judged in ACCURACY.items():
        yield Figure(f"recording/{name}/epochs", "%", at_least=73 if judged else None)
        yield Figure(f"recording/{name}/rmse", "m", at_most=0.21 if judged else None)
        yield Figure(f"recording/{name}/aligned", "m", at_most=0.15 if judged else None)
        yield Figure(f"recording/{name}/rmse-without-jumps", "m")
        yield Figure(f"recording/{name}/aligned-without-jumps", "m")
    yield Figure("recording/path/error-to-stated", at_most=2, goal=1.5)
    yield Figure("recording/path-focal/error-to-stated", at_most=2, goal=1.5)


def measure(bench):
    out = bench.fresh("uav/experiment-recording")
    bench.alidade("experiment", "targets", "--only", "recording", "--recording", bench.data("uav"), "-o", out,
                  "--quiet")
    found = summary(out)["recording"]
    yield from measure_accuracy(found)
    delays = found["delays"]
    yield "recording/delays/static-ignored", delays["static_ignored_to_undelayed"]
    yield "recording/delays/path-ignored", delays["path_ignored_to_undelayed"]
    yield "recording/delays/path-stamped", delays["path_stamped_to_undelayed"]
    yield "recording/delays/path-stamped-answered", 100 * delays["path_stamped_answered"]
    bundle = found["bundle"]
    yield "recording/bundle/epochs", 100 * bundle["undisturbed"]["share"]
    yield "recording/bundle/aligned", bundle["undisturbed"]["aligned_rmse_m"]
    yield "recording/bundle/aligned-without-jumps", bundle["undisturbed"]["aligned_rmse_without_jumps_m"]
    yield "recording/bundle/cpu", max(bundle[start]["cpu_s"] for start in STARTS)
    yield "recording/bundle/disturbed-to-undisturbed", bundle["disturbed_to_undisturbed"]
    checks = found["checks"]
    yield "recording/checks/swapped-places", named(checks["places"])
    yield "recording/checks/focal-lengths", named(checks["focal"])
    yield "recording/checks/dropped-frames", named(checks["clocks"])
    untouched = checks["untouched"]
    yield ("recording/checks/untouched",
           Fact("; ".join(untouched) or "nothing", all("receiver 2: its clock" in finding for finding in untouched)))


SECTIONS = [Section("recording", [
    *accuracy_figures(),
    Figure("recording/delays/static-ignored", at_least=5),
    Figure("recording/delays/path-ignored", at_least=5),
    Figure("recording/delays/path-stamped", at_most=1.3),
    Figure("recording/delays/path-stamped-answered", "%", at_least=90),
    Figure("recording/bundle/epochs", "%", at_least=73),
    Figure("recording/bundle/aligned", "m", at_most=0.15, goal=0.125),
    Figure("recording/bundle/aligned-without-jumps", "m"),
    Figure("recording/bundle/cpu", "s", at_most=20, goal=10),
    Figure("recording/bundle/disturbed-to-undisturbed", at_most=1.15),
    Figure("recording/checks/swapped-places", expected="all named, no other"),
    Figure("recording/checks/focal-lengths", expected="all named, no other"),
    Figure("recording/checks/dropped-frames", expected="all named, no other"),
    Figure("recording/checks/untouched", expected="mate10_1's clock alone"),
], measure)]
