# SPDX-License-Identifier: Apache-2.0
"""The rendered walk that cameras are shown, and how far poses are from its truth."""

from figure_topics.tables import rows_of

FRAMES = 1800  # a minute


def walk(bench):
    return bench.scene("capture/walk", "--frames", FRAMES + 60)


def poses_by_frame(result):
    """{frame: (px, py, pz, qx, qy, qz, qw)} of the frames that were tracked."""
    frames = {int(row["t_ns"]): int(row["index"]) for row in rows_of(result / "frames.csv") if row["state"] == "tracked"}
    poses = {}
    for line in (result / "trajectory.tum").read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            continue
        seconds, nanoseconds = line.split()[0].split(".")
        frame = frames.get(int(seconds) * 10**9 + int(nanoseconds.ljust(9, "0")))
        if frame is not None:
            poses[frame] = line.split()[1:]
    return poses


def error_of(bench, scene, name, poses):
    """RMS of the centres after Sim(3), m, of {picture: (px, py, pz, qx, qy, qz, qw)}."""
    times = [line.split()[0] for line in (scene / "truth.tum").read_text().splitlines() if not line.startswith("#")]
    estimate = bench.folder / "capture" / f"{name}.tum"
    lines = (" ".join(map(str, [times[picture], *pose])) for picture, pose in sorted(poses.items()))
    estimate.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return bench.evaluate(estimate, scene / "truth.tum", "--align", "sim3")["ape_translation_m"]["rmse"]
