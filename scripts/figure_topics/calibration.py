# SPDX-License-Identifier: Apache-2.0
"""calibration: cameras and rigs from images of boards, beside OpenCV's tutorial, mrcal and published parameters."""

import json
import pathlib
import re
import shutil

from figure_topics.bench import summary
from figure_topics.figure import Fact, Failed, Figure, Section, Skipped

REFERENCES = pathlib.Path(__file__).with_name("calibration_references.py")
SYSTEM_PYTHON = "/usr/bin/python3"  # which sees Debian's packages, whatever else is installed
SCENES = 5  # tracked with either camera: a single one differs by as much by chance
STEREO = ("chessboard-stereo", "chessboard:9x6:25mm", (9, 6))
SONY = ("chessboard-sony", "chessboard:7x6:30mm", (7, 6))
SONY_PUBLISHED = (1545.425401191011, 1545.96703364831, 971.158336917263, 535.682080735544, -0.011232359677,
                  0.045931232417, 0.000263868094, -0.001253638454, -0.151703077572)


def reference(bench, module, *words):
    """What calibration_references.py prints; Skipped where the system's Python lacks the module."""
    if bench.run(SYSTEM_PYTHON, "-c", f"import {module}", code=None).code != 0:
        raise Skipped(f"no python3 module {module}")
    return json.loads(bench.run(SYSTEM_PYTHON, REFERENCES, *words).stdout)


def calibrate(bench, name, source, board, *words):
    out = bench.fresh(f"calibration/{name}")
    bench.alidade("calibrate", "camera", source, "--board", board, *words, "-o", out, "--quiet")
    return out


def measure_tutorial(bench):
    folder, board, size = bench.data(STEREO[0]), *STEREO[1:]
    for side in ("left", "right"):
        pattern = folder / f"{side}??.jpg"
        theirs = reference(bench, "cv2", "tutorial", pattern, *size)
        ours = summary(calibrate(bench, side, pattern, board))
        images = {path.name for path in folder.glob(f"{side}??.jpg")}
        told = {view["image"] for view in ours["views"] if view["verdict"]}
        yield f"{side}/every-view-used-or-rejected-with-reason", Fact(f"{len(told)} of {len(images)}", told == images)
        yield f"{side}/rms", ours["rms_px"]
        yield f"{side}/held-out", ours["held_out_rms_px"]
        yield f"{side}/tutorial-held-out", theirs["held_out_rms_px"]
        yield f"{side}/held-out-to-tutorial", ours["held_out_rms_px"] / theirs["held_out_rms_px"]


def stereo(bench, name, *words):
    folder, board = bench.data(STEREO[0]), STEREO[1]
    out = bench.fresh(f"calibration/{name}")
    bench.alidade("calibrate", "stereo", folder / "left??.jpg", folder / "right??.jpg", "--board", board, *words, "-o",
                  out, "--quiet")
    return out


def measure_mrcal(bench):
    """The same lens, board and weights as mrcal's; and then our own setting."""
    out, alike = stereo(bench, "stereo-alike", "--lens", "rational", "--corners", "printed", "--no-weigh-views",
                        "--least-sigma-px", 2), []
    ours = summary(out)
    theirs = reference(bench, "mrcal", "mrcal", out / "left-corners.csv", out / "right-corners.csv", *STEREO[2], 0.025,
                       640, 480)
    alike = [summary(stereo(bench, "stereo-alike", "--lens", "rational", "--corners", "printed", "--no-weigh-views",
                            "--least-sigma-px", 2))["joint_solve_s"] for _ in range(4)]
    baseline = ours["pairs"][0]
    apart = abs(baseline["baseline_m"] - theirs["baseline_m"])
    yield "stereo/mrcal-rms", theirs["rms_px"]
    yield "stereo/rms", ours["rms_px"]
    yield "stereo/rms-to-mrcal", ours["rms_px"] / theirs["rms_px"]
    yield "stereo/solve", 1e3 * min([ours["joint_solve_s"], *alike])
    yield "stereo/solve-to-mrcal", min([ours["joint_solve_s"], *alike]) / theirs["solve_s"]
    yield "stereo/baseline", Fact(
        f"{1e3 * baseline['baseline_m']:.3f} ± {1e3 * baseline['baseline_sigma_m']:.3f}, mrcal "
        f"{1e3 * theirs['baseline_m']:.3f} ± {1e3 * theirs['baseline_sigma_m']:.3f} mm",
        apart <= 2 * baseline["baseline_sigma_m"] and apart <= 2 * theirs["baseline_sigma_m"])
    automatic = summary(stereo(bench, "stereo"))
    yield "stereo/automatic/rms", automatic["rms_px"]
    yield "stereo/automatic/epipolar-rms", automatic["pairs"][0]["epipolar_rms_px"]


def measure_coverage(bench):
    out = bench.fresh("calibration/coverage")
    bench.alidade("experiment", "calibration", "--sets", 300, "-o", out, "--quiet")
    result = summary(out)["coverage"]
    for place in ("centre", "edge", "corner"):
        share = 100 * result["places"][place]["covered"]
        yield f"simulated/{place}-within-90", Fact(f"{share:.1f} %", 85 <= share <= 95 and result["failed"] == 0)
    yield "simulated/focal-bias", 100 * abs(result["focal_bias"])


def measure_sony(bench):
    folder, board, size = bench.data(SONY[0]), *SONY[1:]
    out = calibrate(bench, "sony", folder / "*.jpg", board)
    ours = summary(out)
    # RMS against RMS: by least squares of all corners alike, as whoever published did, not by what errs least elsewhere.
    squares = summary(calibrate(bench, "sony-least-squares", folder / "*.jpg", board, "--outlier-sigmas", 1e6,
                                "--no-weigh-views", "--least-sigma-px", 2))
    theirs = reference(bench, "cv2", "published", out / "corners.csv", *size, *SONY_PUBLISHED)
    yield "sony/published-rms", theirs["rms_px"]
    yield "sony/robust-rms", ours["rms_all_px"]
    yield "sony/least-squares-rms", squares["rms_all_px"]
    yield "sony/least-squares-to-published", squares["rms_all_px"] / theirs["rms_px"]
    yield "sony/fx-off", 100 * abs(ours["intrinsics"]["fx"]["value"] / SONY_PUBLISHED[0] - 1)
    halves = bench.fresh("calibration/halves")
    bench.alidade("experiment", "calibration", "--images", folder / "*.jpg", "--board", board, "-o", halves, "--quiet")
    result = summary(halves)["halves"]
    yield "sony/halves-gap", result["gap_rms_px"]
    yield "sony/halves-within-stated", 100 * result["share_within"]


def measure_misfit(bench):
    """A fisheye's images calibrated as a lens that it is not: the report has to say so."""
    scene = bench.fresh("calibration/fisheye/scene")
    scene.parent.mkdir(parents=True, exist_ok=True)
    camera = scene.parent / "camera.yaml"
    camera.write_text("camera:\n  model: fisheye\n  resolution_px: [640, 480]\n  intrinsics_px: {fx: 260, fy: 260, "
                      "cx: 320, cy: 240}\n  distortion: {k1: 0.05, k2: -0.02, k3: 0.01, k4: 0}\n", encoding="utf-8")
    bench.alidade("simulate", "board", "--camera", camera, "--board", "chessboard:9x6:25mm", "--images", 40,
                  "--least-fill", 0.5, "--most-fill", 1.0, "-o", scene, "--quiet")
    for lens, fits in (("radial", False), ("auto", True)):
        ours = summary(calibrate(bench, f"fisheye/{lens}", scene / "images", "chessboard:9x6:25mm", "--lens", lens))
        yield f"misfit/{lens}", Fact("fits" if ours["lens_fits"] else "does not fit", ours["lens_fits"] == fits)


def copy(folder, images):
    """A folder of images: (file, name) pairs."""
    folder.mkdir(parents=True)
    for source, name in images:
        shutil.copy(source, folder / name)
    return folder


def degenerate_sets(bench):
    """Name, folder, board, and what the message must say."""
    root = bench.fresh("calibration/bad")
    board, charuco = "chessboard:9x6:25mm", "charuco:8x6:30mm:22mm:5X5_100"

    def simulate(name, *words, of=board):
        bench.alidade("simulate", "board", "--board", of, "-o", root / name, "--quiet", *words)
        return sorted((root / name / "images").glob("*.png"))

    good = simulate("good", "--images", 8)
    frontal = simulate("frontal", "--images", 8, "--tilt-deg", 0)
    half = simulate("half", "--images", 6, "--partial", "--least-fill", 1.2, "--most-fill", 1.6)
    marked = simulate("marked", "--images", 3, of=charuco)
    yield "one-view", copy(root / "1", [(good[0], "a.png")]), board, r"1 image, three are the least; take 10 to 20"
    yield "frontal", frontal[0].parent, board, r"faces the camera alike in all 8 images .*; tilt it"
    yield ("duplicates", copy(root / "3", [(good[0], f"{i}.png") for i in range(6)]), board,
           r"6 images, but only 1 of them differs?; move and tilt the board")
    yield "wrong-size", good[0].parent, "chessboard:8x5:25mm", r"no chessboard of 8x5 .*give --board chessboard:9x6"
    mirrored = root / "5"
    mirrored.mkdir()
    for image in marked:
        reference(bench, "cv2", "flip", image, mirrored / image.name)
    yield "mirrored", mirrored, charuco, r"the images show a mirrored ChArUco .*; switch off the mirroring"
    yield "half-a-board", half[0].parent, board, r"no chessboard of 9x6 .*whole board"
    broken = copy(root / "7", [(image, image.name) for image in good[:4]])
    (broken / good[1].name).write_bytes(good[1].read_bytes()[:2000])
    yield "unreadable", broken, board, re.escape(good[1].name) + r".*(cut off|damaged|not an image|no image)"
    blank = root / "8"
    blank.mkdir()
    bench.scene("calibration/no-board", "--frames", 4, "--quiet")
    images = sorted(pathlib.Path(bench.folder / "calibration/no-board").rglob("*.png"))[:4]
    copy(root / "8b", [(image, image.name) for image in images])
    yield "no-board", root / "8b", board, r"no chessboard of 9x6 .* in any of \d images; "
    mixed = copy(root / "9", [(image, image.name) for image in good[:4]])
    reference(bench, "cv2", "resize", good[4], mixed / good[4].name, 320, 240)
    yield "mixed-sizes", mixed, board, re.escape(good[4].name) + r".*320x240"


def measure_degenerate(bench):
    for name, folder, board, pattern in degenerate_sets(bench):
        out = bench.fresh(f"calibration/bad-out/{name}")
        done = bench.alidade("calibrate", "camera", folder, "--board", board, "-o", out, "--quiet", code=None)
        lines = [line for line in done.stderr.splitlines() if not line.startswith("warning: ")]
        holds = done.code == 2 and len(lines) == 1 and re.search(pattern, lines[0]) and not (out / "camera.yaml").exists()
        yield f"degenerate/{name}", Fact("named" if holds else f"exit {done.code}: {done.stderr.strip()}", bool(holds))


def measure_use(bench):
    """A scene tracked with the true camera, and with the one calibrated from rendered boards."""
    boards = bench.fresh("calibration/use/boards")
    bench.alidade("simulate", "board", "--board", "chessboard:9x6:25mm", "-o", boards, "--quiet")
    truth = boards / "camera.yaml"
    ours = calibrate(bench, "use/camera", boards / "images", "chessboard:9x6:25mm") / "camera.yaml"
    squares = {"true": 0.0, "calibrated": 0.0}
    for seed in range(1, 1 + SCENES):
        scene = bench.scene(f"calibration/use/scene-{seed}", "--camera", truth, "--frames", 120, "--seed", seed, "--quiet")
        for name, camera in (("true", truth), ("calibrated", ours)):
            out, _ = bench.track(scene, camera, f"calibration/use/{name}-{seed}", "--quiet")
            squares[name] += bench.evaluate(out, scene, "--align", "sim3")["ape_translation_m"]["rmse"] ** 2
    yield "use/error-true-camera", 1e3 * (squares["true"] / SCENES) ** 0.5
    yield "use/error-to-true-camera", (squares["calibrated"] / squares["true"]) ** 0.5


DEGENERATE = ("one-view", "frontal", "duplicates", "wrong-size", "mirrored", "half-a-board", "unreadable", "no-board",
              "mixed-sizes")

SECTIONS = [
    Section("held-out", [figure for side in ("left", "right") for figure in (
        Figure(f"{side}/every-view-used-or-rejected-with-reason", expected="all"), Figure(f"{side}/rms", "px"),
        Figure(f"{side}/held-out", "px"), Figure(f"{side}/tutorial-held-out", "px"),
        Figure(f"{side}/held-out-to-tutorial", at_most=0.5, goal=0.45))], measure_tutorial),
    Section("stereo", [Figure("stereo/mrcal-rms", "px"), Figure("stereo/rms", "px"),
                       Figure("stereo/rms-to-mrcal", at_most=1.02), Figure("stereo/solve", "ms"),
                       Figure("stereo/solve-to-mrcal", at_most=0.5, goal=0.2),
                       Figure("stereo/baseline", expected="within both"), Figure("stereo/automatic/rms", "px"),
                       Figure("stereo/automatic/epipolar-rms", "px")], measure_mrcal),
    Section("simulated", [*(Figure(f"simulated/{place}-within-90", expected="85 to 95 %")
                            for place in ("centre", "edge", "corner")),
                          Figure("simulated/focal-bias", "%", below=0.02)], measure_coverage),
    Section("sony", [Figure("sony/published-rms", "px"), Figure("sony/robust-rms", "px"),
                     Figure("sony/least-squares-rms", "px"),
                     Figure("sony/least-squares-to-published", at_most=1.0), Figure("sony/fx-off", "%", at_most=0.5),
                     Figure("sony/halves-gap", "px"), Figure("sony/halves-within-stated", "%", at_least=85)],
            measure_sony),
    Section("misfit", [Figure("misfit/radial", expected="does not fit"), Figure("misfit/auto", expected="fits")],
            measure_misfit),
    Section("degenerate", [Figure(f"degenerate/{name}", expected="trouble, remedy") for name in DEGENERATE],
            measure_degenerate),
    Section("use", [Figure("use/error-true-camera", "mm"), Figure("use/error-to-true-camera", at_most=1.05)], measure_use),
]
