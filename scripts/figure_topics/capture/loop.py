# SPDX-License-Identifier: Apache-2.0
"""A rendered walk through a real /dev/video: shown at the virtual camera's input, recorded in the machine, tracked here."""

from figure_topics.bench import ROOT, last_line
from figure_topics.capture.programs import program
from figure_topics.capture.walk import error_of, poses_by_frame, walk
from figure_topics.figure import Figure, Section, Skipped
from figure_topics.tables import rows_of

SHOWN = 300
FIRST = "000[0-2]*.png"  # 300 images


def measure(bench):
    scene, out = walk(bench), bench.fresh("capture/loop/machine")
    images = scene / "images" / FIRST
    raw = bench.folder / "capture" / "loop" / "walk.grey"
    bench.run(program("faults/v4l2/raw_frames"), images, raw)
    run = bench.run(ROOT / "scripts" / "test-v4l2-vm", "--run", f"v4l2_loop {raw} 640 480 GREY rec slow", "--output", out,
                    code=None)  # fmt: skip
    if run.code == 77:
        raise Skipped(last_line(run.stdout))
    raw.unlink()
    recording = out / "rec"
    shown = {int(row["index"]): int(row["shown"]) for row in rows_of(recording / "shown.csv")}
    looped, files = bench.fresh("capture/loop/looped"), bench.fresh("capture/loop/files")
    for source, result in [(recording, looped), (images, files)]:
        bench.alidade("track", "camera", source, "--camera", scene / "camera.yaml", "--fps", 30, "-o", result, "--quiet")
    there = error_of(bench, scene, "loop", {shown[frame]: pose for frame, pose in poses_by_frame(looped).items()})
    here = error_of(bench, scene, "loop-files", poses_by_frame(files))
    yield "loop/frames-recorded", len(shown)
    yield "loop/frames-of-the-walk", len(set(shown.values()))
    yield "loop/error", 1e3 * there
    yield "loop/error-to-files", there / here


SECTIONS = [Section("loop", [
    Figure("loop/frames-recorded"),
    Figure("loop/frames-of-the-walk", at_least=SHOWN // 2),
    Figure("loop/error", "mm"),
    Figure("loop/error-to-files", at_most=1.1),
], measure)]  # fmt: skip
