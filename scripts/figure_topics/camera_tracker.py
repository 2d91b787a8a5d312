# SPDX-License-Identifier: Apache-2.0
"""camera-tracker: the paper's experiments re-created, and our filter beside its opponents, by `alidade experiment`."""

import math

from figure_topics.bench import summary
from figure_topics.benchmark import least_times
from figure_topics.figure import Fact, Figure, Section, Skipped

RUNS = 100
OURS = {"causal": "ours, causal", "lag-3": "ours, lag 3", "smoothed": "ours, smoothed"}
NEES_WITH_MAP = "refitted, shared error considered"


def experiment(bench, part, runs=RUNS):
    """The summary of one part of the experiment, with the paper's bunny where it is at hand."""
    try:
        points = ["--points", bench.data("bunny") / "bun_zipper_res4.ply"]
    except Skipped:
        points = []
    out = bench.fresh(f"camera-tracker/{part}")
    bench.alidade("experiment", "camera", "--only", part, "--runs", runs, *points, "-o", out, "--quiet")
    return summary(out)[part]


def with_interval(ratio, at_most):
    return Fact(f"{ratio['value']:.3f} ({ratio['low']:.3f}-{ratio['high']:.3f})", ratio["value"] <= at_most)


def ratio_figure(name, at_most, goal=None):
    """A ratio that is printed with its 95 % interval; judged by with_interval."""
    return Figure(name, expected=f"<= {at_most}" + (f" (goal {goal})" if goal else ""))


def in_range(value, low, high):
    return Fact(f"{value:.3f}", low <= value <= high)


# Position and rotation RMSE over EPnP + LM: path, estimate, bound, goal.
ACCURACY = [("smooth", "causal", 0.88, 0.86), ("turn", "causal", 0.80, 0.77),
            ("smooth", "lag-3", 0.52, 0.50), ("turn", "lag-3", 0.48, 0.45),
            ("smooth", "smoothed", 0.47, 0.45), ("turn", "smoothed", 0.46, 0.42)]


def measure_accuracy(bench):
    paths = experiment(bench, "accuracy")
    for path, estimate, at_most, _ in ACCURACY:
        result = paths[path][OURS[estimate]]
        for kind in ("position", "rotation"):
            yield f"{path}/{estimate}/{kind}-to-epnp-lm", with_interval(result[f"{kind}_ratio"], at_most)
    for path in ("smooth", "turn"):
        for estimate in ("causal", "lag-3"):
            yield (f"{path}/{estimate}/frames-not-worse-than-epnp",
                   paths[path][OURS[estimate]]["frames_not_worse_than_epnp_percent"])
        yield f"{path}/causal/nees-per-dof", in_range(paths[path][OURS["causal"]]["nees_per_dof"], 0.9, 1.15)
    for method in ("EPnP", "SQPnP", "paper's filter"):
        for path in ("smooth", "turn"):
            name = method.lower().replace("'s", "").replace(" ", "-")
            yield f"{path}/{name}/position-to-epnp-lm", paths[path][method]["position_ratio"]["value"]
    yield "stop-and-go/worst-frame-to-epnp-lm", paths["stop-and-go"][OURS["causal"]]["worst_frame_ratio"]


ACCURACY_SECTION = Section("accuracy", [
    *(ratio_figure(f"{path}/{estimate}/{kind}-to-epnp-lm", at_most, goal)
      for path, estimate, at_most, goal in ACCURACY for kind in ("position", "rotation")),
    *(Figure(f"{path}/{estimate}/frames-not-worse-than-epnp", "%", at_least=99 if estimate == "causal" else 100)
      for path in ("smooth", "turn") for estimate in ("causal", "lag-3")),
    *(Figure(f"{path}/causal/nees-per-dof", expected="0.9 to 1.15") for path in ("smooth", "turn")),
    *(Figure(f"{path}/{name}/position-to-epnp-lm")
      for name in ("epnp", "sqpnp", "paper-filter") for path in ("smooth", "turn")),
    Figure("stop-and-go/worst-frame-to-epnp-lm", at_most=1.1),
    Figure("pictures", manual="alidade experiment camera --only accuracy -o OUT; look at OUT/report.html"),
], measure_accuracy)


def measure_noise(bench):
    levels = experiment(bench, "noise")
    noisy = [level for level in levels if level["sigma_px"] > 0]
    yield "noise/worst-ratio-to-epnp-lm", max(level[kind]["value"] for level in noisy
                                              for kind in ("position_ratio", "rotation_ratio"))
    yield "noise/error-at-0-px", next(level["of_path_percent"] for level in levels if level["sigma_px"] == 0)


NOISE = Section("noise", [
    Figure("noise/worst-ratio-to-epnp-lm", at_most=0.97),
    Figure("noise/error-at-0-px", "% of path", at_most=1e-6),
], measure_noise)


def measure_frames(bench):
    result = experiment(bench, "frames")["220"]
    yield "220-frames/causal/position-to-epnp-lm", with_interval(result[OURS["causal"]]["position_ratio"], 0.60)
    yield "220-frames/lag-3/position-to-epnp-lm", with_interval(result[OURS["lag-3"]]["position_ratio"], 0.30)
    yield "220-frames/lag-12/position-to-epnp-lm", result["ours, lag 12"]["position_ratio"]["value"]


FRAMES = Section("frames", [
    ratio_figure("220-frames/causal/position-to-epnp-lm", 0.60, 0.58),
    ratio_figure("220-frames/lag-3/position-to-epnp-lm", 0.30, 0.29),
    Figure("220-frames/lag-12/position-to-epnp-lm"),
], measure_frames)


def measure_uncertain_map(bench):
    result = experiment(bench, "uncertain-map")
    yield "uncertain-map/position-to-epnp-lm", with_interval(result[NEES_WITH_MAP]["position_ratio"], 0.17)
    yield "uncertain-map/nees-per-dof", in_range(result[NEES_WITH_MAP]["nees_per_dof"], 0.8, 1.3)
    yield "uncertain-map/inflation-only/position-to-epnp-lm", result["R inflated"]["position_ratio"]["value"]
    yield "uncertain-map/inflation-only/nees-per-dof", result["R inflated"]["nees_per_dof"]


UNCERTAIN_MAP = Section("uncertain-map", [
    ratio_figure("uncertain-map/position-to-epnp-lm", 0.17, 0.15),
    Figure("uncertain-map/nees-per-dof", expected="0.8 to 1.3"),
    Figure("uncertain-map/inflation-only/position-to-epnp-lm"),
    Figure("uncertain-map/inflation-only/nees-per-dof"),
], measure_uncertain_map)


def measure_outliers(bench):
    shares = experiment(bench, "outliers")
    for share in ("30", "50"):
        ours = shares[share][OURS["causal"]]
        for kind in ("position", "rotation"):
            yield f"outliers-{share}/{kind}-to-ransac", with_interval(ours[f"{kind}_ratio"], 0.92)
    yield "outliers-50/time-to-ransac", shares["50"]["time_ratio"]


OUTLIERS = Section("outliers", [
    *(ratio_figure(f"outliers-{share}/{kind}-to-ransac", 0.92, 0.90)
      for share in (30, 50) for kind in ("position", "rotation")),
    Figure("outliers-50/time-to-ransac", at_most=0.05, goal=0.02),
], measure_outliers)


CLAIMS = {"map_in_state_costs_more": "map-in-state-costs-more",
          "map_in_state_is_less_accurate": "map-in-state-is-less-accurate",
          "unscented_gains_nothing": "unscented-gains-nothing",
          "smaller_state_cures_nonlinearity": "smaller-state-cures-nonlinearity",
          "paper_start_helps_bundle_adjustment": "paper-start-helps-bundle-adjustment",
          "better_start_helps_bundle_adjustment": "better-start-helps-bundle-adjustment"}
MAP_SIZES = (25, 50, 100, 200, 400)


def unjudged(ratio):
    return with_interval(ratio, float("inf"))


def measure_claims(bench):
    """What else the paper says: the experiment judges; either verdict is a result."""
    claims = experiment(bench, "claims", runs=20)
    for key, name in CLAIMS.items():
        yield f"claims/{name}", Fact(claims[key]["verdict"], True)
    for row in claims["map_in_state_costs_more"]["figures"]:
        if row["map"] == "known":
            yield f"claims/{row['points']}-points/time-in-state-to-paper", row["time_ratio"]
    for row in claims["map_in_state_is_less_accurate"]["figures"]:
        if row["map"] == "known":
            yield f"claims/{row['points']}-points/position-in-state-to-paper", unjudged(row["position_ratio"])
    for key, name in (("unscented_gains_nothing", "unscented"), ("smaller_state_cures_nonlinearity", "iterated")):
        for row in claims[key]["figures"]:
            if row["filter"] == name:
                start = f"{row['sigma_px']}-px-{row['start']}-start"
                yield f"claims/{start}/{name}-to-paper", unjudged(row["position_ratio"])
    for start in ("paper", "better"):
        figures = claims[f"{start}_start_helps_bundle_adjustment"]["figures"]
        for figure in ("iterations", "residuals"):
            yield f"claims/bundle-from-{start}-start/{figure}-to-epnp", unjudged(figures[f"{figure}_to_epnp"])


CLAIMS_SECTION = Section("claims", [
    *(Figure(f"claims/{name}", expected="confirmed or not") for name in CLAIMS.values()),
    *(Figure(f"claims/{points}-points/{figure}-in-state-to-paper")
      for figure in ("time", "position") for points in MAP_SIZES),
    *(Figure(f"claims/{sigma_px}-px-{start}-start/{name}-to-paper")
      for name in ("unscented", "iterated") for sigma_px in (0.5, 3.0) for start in ("good", "poor")),
    *(Figure(f"claims/bundle-from-{start}-start/{figure}-to-epnp")
      for start in ("paper", "better") for figure in ("iterations", "residuals")),
], measure_claims)


def measure_speed(bench):
    least = least_times(bench, "alidade_benchmark")
    for name in ("EPnP", "SQPnP", "EPnP+LM"):
        yield f"speed/step-to-{name.lower().replace('+', '-')}", least["filter_step"] / least[name]


SPEED = Section("speed", [
    Figure("speed/step-to-epnp", at_most=0.5, goal=0.3),
    Figure("speed/step-to-sqpnp", at_most=1.2, goal=0.8),
    Figure("speed/step-to-epnp-lm", at_most=0.12),
], measure_speed)

def on_recording(bench, part, flag, data):
    """The summary of a part of the experiment that needs a recording; Skipped without it."""
    recording = bench.data(data)
    out = bench.fresh(f"camera-tracker/{part}")
    bench.alidade("experiment", "camera", "--only", part, flag, recording, "-o", out, "--quiet")
    return summary(out)[part]


STILLS_METHODS = {"epnp": "EPnP", "epnp-lm": "EPnP + LM", "paper-filter": "paper's filter", "ours": "ours",
                  "ours-local-refinement": "ours, local refinement", "ours-global-refinement": "ours, global refinement"}


def measure_stills(bench):
    result = on_recording(bench, "stills", "--stills", "fountain")
    for name, method in STILLS_METHODS.items():
        yield f"stills/{name}/mean-position-error", 1e3 * result[method]["position_mean_m"]
    yield "stills/ours/frames-not-worse-than-epnp", result["ours"]["frames_not_worse_than_epnp_percent"]


STILLS = Section("stills", [
    *(Figure(f"stills/{name}/mean-position-error", "mm") for name in STILLS_METHODS),
    Figure("stills/ours/frames-not-worse-than-epnp", "%"),
    Figure("stills/pictures", manual="alidade experiment camera --only stills --stills fountain -o OUT; "
                                     "look at OUT/report.html"),
], measure_stills)


def measure_known_map(bench):
    result = on_recording(bench, "known-map", "--video", "tum-fr1-rpy")
    ours = result["ours, causal"]
    yield "known-map/position-to-ransac", with_interval(ours["position_m"]["ratio"], 0.70)
    yield "known-map/frame-to-frame-to-ransac", with_interval(ours["frame_to_frame_m"]["ratio"], 0.50)
    for lag in ("lag 3", "smoothed"):
        for kind in ("position", "frame_to_frame"):
            yield (f"known-map/{lag.replace(' ', '-')}/{kind.replace('_', '-')}-to-ransac",
                   result[f"ours, {lag}"][f"{kind}_m"]["ratio"]["value"])
    lost = result["lost"]
    yield "known-map/frames-lost-that-pnp-keeps", len(set(lost["ours, causal"]) - set(lost["RANSAC-EPnP + LM"]))
    yield "known-map/nees-per-dof", in_range(ours["nees_per_dof"], 0.7, 1.5)
    yield "known-map/nees-per-dof-against-an-exact-truth", ours["nees_per_dof_against_exact_truth"]
    sigma = result["truth_sigma"]
    yield "known-map/truth-position-sigma", Fact("{:.1f}, {:.1f}, {:.1f} mm".format(*(1e3 * s for s in sigma[:3])), True)
    yield "known-map/truth-rotation-sigma", Fact("{:.2f}, {:.2f}, {:.2f} deg".format(*map(math.degrees, sigma[3:])),
                                                 True)
    yield "known-map/epnp-lm-on-our-inliers/position-to-ransac", (
        result["EPnP + LM, our inliers"]["position_m"]["ratio"]["value"])
    yield "known-map/paper-filter-on-our-inliers/position-to-ransac", (
        result["paper's filter, our inliers"]["position_m"]["ratio"]["value"])


KNOWN_MAP = Section("known-map", [
    ratio_figure("known-map/position-to-ransac", 0.70, 0.65),
    ratio_figure("known-map/frame-to-frame-to-ransac", 0.50, 0.45),
    *(Figure(f"known-map/{lag}/{kind}-to-ransac")
      for lag in ("lag-3", "smoothed") for kind in ("position", "frame-to-frame")),
    Figure("known-map/frames-lost-that-pnp-keeps", at_most=0),
    Figure("known-map/nees-per-dof", expected="0.7 to 1.5"),
    Figure("known-map/nees-per-dof-against-an-exact-truth"),
    Figure("known-map/truth-position-sigma"),
    Figure("known-map/truth-rotation-sigma"),
    Figure("known-map/epnp-lm-on-our-inliers/position-to-ransac"),
    Figure("known-map/paper-filter-on-our-inliers/position-to-ransac"),
], measure_known_map)

SECTIONS = [ACCURACY_SECTION, NOISE, FRAMES, UNCERTAIN_MAP, OUTLIERS, CLAIMS_SECTION, STILLS, KNOWN_MAP, SPEED]
