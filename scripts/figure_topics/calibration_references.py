# SPDX-License-Identifier: Apache-2.0
"""What others make of the same images and corners: OpenCV's tutorial, published parameters, mrcal.

Run by the system's Python, which has Debian's python3-opencv and mrcal: COMMAND ARGUMENTS..., prints JSON.
"""

import csv
import glob
import json
import sys
import time

import numpy as np

FOLDS = 4  # view i is held out in fold i mod FOLDS, as `alidade calibrate camera` does


def board_points(columns, rows):
    points = np.zeros((columns * rows, 3), np.float32)
    points[:, :2] = np.mgrid[:columns, :rows].T.reshape(-1, 2)
    return points


def squares_left(board, pixels, K, distortion):
    """The sum of squared residuals of a view whose board is placed by it alone."""
    import cv2

    _, rotation, translation = cv2.solvePnP(board, pixels, K, distortion)
    found, _ = cv2.projectPoints(board, rotation, translation, K, distortion)
    return float(np.sum((found.reshape(-1, 2) - pixels.reshape(-1, 2)) ** 2))


def tutorial(pattern, columns, rows):
    """The recipe of OpenCV's tutorial: RMS of its own views, and of views that were held out."""
    import cv2

    board, views, size = board_points(columns, rows), [], None
    for name in sorted(glob.glob(pattern)):
        grey = cv2.imread(name, cv2.IMREAD_GRAYSCALE)
        size = grey.shape[::-1]
        found, corners = cv2.findChessboardCorners(grey, (columns, rows))
        if found:
            criteria = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 30, 0.001)
            views.append(cv2.cornerSubPix(grey, corners, (11, 11), (-1, -1), criteria))
    rms = cv2.calibrateCamera([board] * len(views), views, size, None, None)[0]
    squares = count = 0
    for fold in range(FOLDS):
        training = [view for i, view in enumerate(views) if i % FOLDS != fold]
        _, K, distortion, _, _ = cv2.calibrateCamera([board] * len(training), training, size, None, None)
        for view in views[fold::FOLDS]:
            squares += squares_left(board, view, K, distortion)
            count += len(board)
    return {"views": len(views), "rms_px": rms, "held_out_rms_px": (squares / count) ** 0.5}


def read_corners(path):
    """{image: (ids, pixels)} of a corners.csv."""
    views = {}
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            ids, pixels = views.setdefault(row["image"], ([], []))
            ids.append(int(row["corner"]))
            pixels.append((float(row["x_px"]), float(row["y_px"])))
    return views


def published(corners, columns, rows, *parameters):
    """The RMS that given parameters (fx fy cx cy k1 k2 p1 p2 k3) leave on corners."""
    fx, fy, cx, cy, *distortion = map(float, parameters)
    K, board = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]), board_points(columns, rows)
    squares = count = 0
    for ids, pixels in read_corners(corners).values():
        squares += squares_left(board[ids], np.array(pixels), K, np.array(distortion))
        count += len(ids)
    return {"rms_px": (squares / count) ** 0.5}


def flip(source, target):
    """A mirrored image."""
    import cv2

    cv2.imwrite(target, cv2.imread(source)[:, ::-1])
    return {}


def resize(source, target, width, height):
    import cv2

    cv2.imwrite(target, cv2.resize(cv2.imread(source), (width, height)))
    return {}


def number_of(image):
    return "".join(c for c in image.rsplit(".", 1)[0] if c.isdigit())


def mrcal_joint(left, right, columns, rows, spacing, width, height):
    """mrcal's joint calibration of two cameras (LENSMODEL_OPENCV8, board warp, outliers) from corners.csv of each.

    The solve that is timed starts from the poses of the first one, without distortion and warp.
    """
    import mrcal

    cameras = [{number_of(image): view for image, view in read_corners(path).items()} for path in (left, right)]
    moments = sorted(set(cameras[0]) | set(cameras[1]))
    observations, indices = [], []
    for frame, moment in enumerate(moments):
        for camera, views in enumerate(cameras):
            if moment not in views:
                continue
            grid = np.full((columns * rows, 3), -1.0)
            ids, pixels = views[moment]
            grid[ids, :2], grid[ids, 2] = pixels, 1.0
            observations.append(grid.reshape(rows, columns, 3))
            indices.append((frame, camera))
    observations = np.array(observations)
    indices = np.array(indices, dtype=np.int32)
    imagersizes = np.array([[width, height]] * 2, dtype=np.int32)
    intrinsics, extrinsics, frames = mrcal.seed_stereographic(
        imagersizes=imagersizes, focal_estimate=np.array([float(width)] * 2), indices_frame_camera=indices,
        observations=observations, object_spacing=spacing)
    model = "LENSMODEL_STEREOGRAPHIC"
    arguments = dict(imagersizes=imagersizes, extrinsics_rt_fromref=extrinsics, frames_rt_toref=frames, points=None,
                     observations_point=None, indices_point_camintrinsics_camextrinsics=None,
                     observations_board=observations.copy(), calibration_object_spacing=spacing,
                     indices_frame_camintrinsics_camextrinsics=np.array(
                         [(f, c, c - 1) for f, c in indices], dtype=np.int32), verbose=False)
    mrcal.optimize(lensmodel=model, intrinsics=intrinsics, do_optimize_intrinsics_core=False,
                   do_optimize_intrinsics_distortions=False, do_optimize_calobject_warp=False, do_apply_outlier_rejection=False,
                   do_apply_regularization=False, **arguments)
    mrcal.optimize(lensmodel=model, intrinsics=intrinsics, do_optimize_intrinsics_core=True,
                   do_optimize_intrinsics_distortions=False, do_optimize_calobject_warp=False, do_apply_outlier_rejection=False,
                   do_apply_regularization=False, **arguments)
    lens = "LENSMODEL_OPENCV8"
    seconds, result = [], None
    for _ in range(5):
        start = {key: value.copy() if isinstance(value, np.ndarray) else value for key, value in arguments.items()}
        start["intrinsics"] = np.hstack((intrinsics[:, :4], np.zeros((2, 8))))
        start["calobject_warp"] = np.zeros(2)
        begin = time.process_time()
        mrcal.optimize(lensmodel=lens, do_optimize_intrinsics_core=True, do_optimize_intrinsics_distortions=True,
                       do_optimize_calobject_warp=True, do_apply_outlier_rejection=True, do_apply_regularization=True,
                       **start)
        seconds.append(time.process_time() - begin)
        result = start
    inputs = dict(result, lensmodel=lens, do_optimize_intrinsics_core=True, do_optimize_intrinsics_distortions=True,
                  do_optimize_calobject_warp=True, do_optimize_extrinsics=True, do_optimize_frames=True,
                  do_apply_outlier_rejection=False, do_apply_regularization=True)
    x = mrcal.optimizer_callback(no_jacobian=True, no_factorization=True, **inputs)[1]
    weights = inputs["observations_board"][..., 2]
    squares = np.sum(x[:2 * weights.size].reshape(*weights.shape, 2) ** 2, axis=-1)
    baseline = result["extrinsics_rt_fromref"][0, 3:]
    sigma = baseline_sigma(mrcal, inputs, baseline)
    return {"rms_px": float(np.sqrt(np.sum(squares[weights > 0]) / np.sum(weights > 0))),
            "outliers": int(np.sum((weights <= 0))), "solve_s": min(seconds),
            "baseline_m": float(np.linalg.norm(baseline)), "baseline_sigma_m": sigma}


def baseline_sigma(mrcal, inputs, baseline):
    """From the inverse of JᵀJ, scaled by the residuals."""
    x, J = mrcal.optimizer_callback(no_factorization=True, **inputs)[1:3]
    rows = 2 * inputs["observations_board"][..., 2].size
    at = mrcal.state_index_extrinsics(0, **inputs) + 3
    mrcal.pack_state(packed := np.zeros(J.shape[1]), **inputs)
    gradient = np.zeros(J.shape[1])
    gradient[at:at + 3] = baseline / np.linalg.norm(baseline)
    mrcal.unpack_state(gradient_scaled := gradient.copy(), **inputs)
    dense = J.toarray()
    used = np.any(dense[:rows] != 0, axis=1)
    variance = np.sum(x[:rows][used] ** 2) / (np.sum(used) - J.shape[1])
    return float(np.sqrt(variance * gradient_scaled @ np.linalg.solve(dense.T @ dense, gradient_scaled)))


COMMANDS = {"tutorial": tutorial, "published": published, "flip": flip, "resize": resize, "mrcal": mrcal_joint}


def number(word):
    try:
        return int(word)
    except ValueError:
        try:
            return float(word)
        except ValueError:
            return word


if __name__ == "__main__":
    print(json.dumps(COMMANDS[sys.argv[1]](*map(number, sys.argv[2:]))))
