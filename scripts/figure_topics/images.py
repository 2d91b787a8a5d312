# SPDX-License-Identifier: Apache-2.0
"""Images made for a measurement, on the standard library alone: a texture seen by a turning camera."""

import math
import random
import struct
import zlib


def write_png(path, width, height, rows):
    """An 8-bit grey PNG; `rows` yields `height` byte strings of `width` pixels."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    pixels = b"".join(b"\0" + bytes(row) for row in rows)
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(pixels, 1)) +
                     chunk(b"IEND", b""))


class BlobTexture:
    """Grey squares of many sizes at random places: as many features as a detector could wish for."""

    def __init__(self, width, height, seed, blobs=4000):
        choose = random.Random(seed)
        self.width, self.height = width, height
        self.rows = [bytearray([128]) * width for _ in range(height)]
        for _ in range(blobs):
            size, grey = choose.randint(2, 14), choose.randint(0, 255)
            x, y = choose.randrange(width - size), choose.randrange(height - size)
            for row in self.rows[y:y + size]:
                row[x:x + size] = bytes([grey]) * size

    def view(self, path, width, height, focal_px, yaw_rad):
        """The texture on a sphere about a camera that only turns: what it sees at this yaw (x right)."""
        columns = []
        for x in range(width):
            across = (x - (width - 1) / 2) / focal_px
            columns.append((math.atan(across) + yaw_rad, 1 / math.hypot(1, across)))

        def row(y):
            down = (y - (height - 1) / 2) / focal_px
            return bytes(
                self.rows[int(self.height / 2 + focal_px * math.atan(down * shorter)) % self.height]
                [int(self.width / 2 + focal_px * angle) % self.width] for angle, shorter in columns)

        write_png(path, width, height, map(row, range(height)))
