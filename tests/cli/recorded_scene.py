# SPDX-License-Identifier: Apache-2.0
"""A tiny recording in the format of the TUM RGB-D benchmark: a camera moves before two textured walls."""

import math
import random
import struct
import zlib

WIDTH, HEIGHT, FOCAL = 240, 180, 200.0
WALLS_M = (2.0, 2.6)  # the left half of the scene is nearer


def png(width, height, rows, bits, kind):
    """A PNG of one channel (kind 0); `rows` are bytes."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    raw = b"".join(b"\0" + row for row in rows)
    header = struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")


def texture(size, rng):
    """Smoothed noise, so that there are blobs to find; wraps round."""
    grey = [[rng.random() for _ in range(size)] for _ in range(size)]
    return [[sum(grey[(y + dy) % size][(x + dx) % size] for dy in (0, 1, 2) for dx in (0, 1, 2)) / 9
             for x in range(size)] for y in range(size)]


def view(pattern, centre):
    """Grey and depth rows (bytes) from `centre` (m), looking along z."""
    size, per_m = len(pattern), 60.0
    grey, depth = [], []
    for v in range(HEIGHT):
        line, far = bytearray(), []
        for u in range(WIDTH):
            dx, dy = (u - WIDTH / 2) / FOCAL, (v - HEIGHT / 2) / FOCAL
            z = WALLS_M[0] - centre[2]
            if centre[0] + dx * z > 0:
                z = WALLS_M[1] - centre[2]
            x, y = (centre[0] + dx * z) * per_m, (centre[1] + dy * z) * per_m
            x0, y0 = math.floor(x), math.floor(y)
            a, b = x - x0, y - y0
            low, high = pattern[y0 % size], pattern[(y0 + 1) % size]
            value = ((1 - b) * ((1 - a) * low[x0 % size] + a * low[(x0 + 1) % size]) +
                     b * ((1 - a) * high[x0 % size] + a * high[(x0 + 1) % size]))
            line.append(max(0, min(255, round(255 * (2.2 * value - 0.6)))))
            far.append(round(5000 * z))
        grey.append(bytes(line))
        depth.append(struct.pack(f">{WIDTH}H", *far))
    return grey, depth


def write(folder, frames=24, depth_every=4):
    """Images, depth of every `depth_every`-th, true poses, camera.txt."""
    pattern = texture(256, random.Random(1))
    for name in ("rgb", "depth"):
        (folder / name).mkdir(parents=True)
    lists = {"rgb": [], "depth": [], "groundtruth": []}
    for k in range(frames):
        t = f"{1000 + k / 30:.6f}"
        centre = (0.3 * math.sin(0.12 * k), 0.1 * math.sin(0.2 * k), 0.1 * math.cos(0.15 * k))
        grey, depth = view(pattern, centre)
        (folder / "rgb" / f"{t}.png").write_bytes(png(WIDTH, HEIGHT, grey, 8, 0))
        lists["rgb"].append(f"{t} rgb/{t}.png")
        if k % depth_every == 0:
            (folder / "depth" / f"{t}.png").write_bytes(png(WIDTH, HEIGHT, depth, 16, 0))
            lists["depth"].append(f"{t} depth/{t}.png")
        lists["groundtruth"].append(f"{t} {centre[0]:.6f} {centre[1]:.6f} {centre[2]:.6f} 0 0 0 1")
    for name, lines in lists.items():
        (folder / f"{name}.txt").write_text("# made up\n" + "\n".join(lines) + "\n", encoding="utf-8")
    camera = f"fx {FOCAL} fy {FOCAL} cx {WIDTH / 2} cy {HEIGHT / 2}\nk1 0 k2 0 p1 0 p2 0 k3 0\n"
    (folder / "camera.txt").write_text(camera, encoding="utf-8")
