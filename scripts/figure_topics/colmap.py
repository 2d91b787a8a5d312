# SPDX-License-Identifier: Apache-2.0
"""COLMAP on the same images and intrinsics, to compare with: Debian's 3.8, on the CPU."""

import dataclasses
import os
import pathlib
import shutil
import subprocess

from figure_topics.bench import ROOT
from figure_topics.figure import Failed, Skipped


@dataclasses.dataclass(frozen=True)
class Intrinsics:
    fx: float
    fy: float
    cx: float  # pixel (0, 0) is the centre of the first pixel
    cy: float


def strecha_intrinsics(camera_file):
    """K from the first three lines of a NAME.jpg.camera."""
    rows = [line.split() for line in pathlib.Path(camera_file).read_text(encoding="utf-8").splitlines()[:3]]
    return Intrinsics(float(rows[0][0]), float(rows[1][1]), float(rows[0][2]), float(rows[1][2]))


def need_colmap():
    """Installs the package where we may; Skipped where it cannot be had."""
    if shutil.which("colmap"):
        return
    if os.geteuid() != 0:
        raise Skipped("colmap is not installed (apt-get install colmap)")
    done = subprocess.run([ROOT / "scripts" / "setup", "colmap"], capture_output=True, text=True, check=False)
    if done.returncode != 0 or not shutil.which("colmap"):
        raise Skipped(f"colmap cannot be installed: {done.stderr.strip().splitlines()[-1:]}")


def centre_of(quaternion, translation):
    """C = -Rᵀ t of a world-to-camera pose, and the camera-to-world quaternion (x, y, z, w)."""
    w, x, y, z = quaternion
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    centre = [-sum(rows[k][i] * translation[k] for k in range(3)) for i in range(3)]
    return centre, (-x, -y, -z, w)


def write_tum(images_txt, names, path):
    """The poses of a COLMAP text model as TUM lines; the time of an image is its place in `names`, in seconds."""
    lines = []
    for line in pathlib.Path(images_txt).read_text(encoding="utf-8").splitlines():
        words = line.split()
        if len(words) != 10 or words[9] not in names:
            continue  # a comment, or the points of an image
        numbers = [float(word) for word in words[1:8]]
        centre, quaternion = centre_of(numbers[:4], numbers[4:])
        lines.append((names.index(words[9]), " ".join(f"{v:.9g}" for v in (*centre, *quaternion))))
    path.write_text("".join(f"{time} {pose}\n" for time, pose in sorted(lines)), encoding="utf-8")
    return len(lines)


def reconstruct(bench, images, intrinsics, matcher, name):
    """Features, matching ("sequential" or "exhaustive") and mapping with K held. Returns the trajectory (TUM) and the
    wall time of the three steps together, in seconds."""
    need_colmap()
    work = bench.fresh(name)
    (work / "images").mkdir(parents=True)
    (work / "sparse").mkdir()
    for image in images:
        (work / "images" / image.name).symlink_to(image)
    database = ["--database_path", work / "db"]
    k = intrinsics
    half = 0.5  # COLMAP counts pixels from the corner of the first one
    parameters = f"{k.fx},{k.fy},{k.cx + half},{k.cy + half}"
    held = [f"--Mapper.ba_refine_{what}=0" for what in ("focal_length", "principal_point", "extra_params")]
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    steps = [
        ["feature_extractor", *database, "--image_path", work / "images", "--ImageReader.camera_model", "PINHOLE",
         "--ImageReader.single_camera", "1", "--ImageReader.camera_params", parameters, "--SiftExtraction.use_gpu", "0"],
        [f"{matcher}_matcher", *database, "--SiftMatching.use_gpu", "0"],
        ["mapper", *database, "--image_path", work / "images", "--output_path", work / "sparse", *held],
    ]
    seconds = sum(bench.run("colmap", *step, env=environment).seconds for step in steps)
    if not (work / "sparse" / "0").exists():
        raise Failed("colmap made no model")
    bench.run("colmap", "model_converter", "--input_path", work / "sparse" / "0", "--output_path", work,
              "--output_type", "TXT", env=environment)
    write_tum(work / "images.txt", [image.name for image in images], work / "trajectory.tum")
    return work / "trajectory.tum", seconds
