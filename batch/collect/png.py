"""PNG files of 8 bits a channel, by numpy and zlib: what Blender writes, and what we make of it."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]  # (height, width, 3), sRGB
SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # by colour type: grey, RGB, grey and alpha, RGB and alpha
LARGEST = 100_000_000  # pixels
NONE, SUB, UP, AVERAGE, PAETH = range(5)  # filters of a line


class UnreadablePicture(Exception):
    """A file that is no PNG of 8 bits a channel, or is damaged."""


def read_png(path: Path) -> Pixels:
    """The picture without its alpha channel. Raises UnreadablePicture."""
    try:
        content = path.read_bytes()
        width, height, channels, packed = _chunks(content)
        lines = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, -1)
        filters, bytes_ = lines[:, 0], lines[:, 1:].reshape(height, width, channels)
        pixels = unfiltered(filters, bytes_)
    except (OSError, ValueError, struct.error, zlib.error) as error:
        raise UnreadablePicture(f"{path}: {error}") from error
    return np.repeat(pixels[..., :1], 3, axis=2) if channels < 3 else pixels[..., :3]


def _chunks(content: bytes) -> tuple[int, int, int, bytes]:
    """Width, height, channels, and the compressed lines. Raises ValueError, struct.error."""
    if not content.startswith(SIGNATURE):
        raise ValueError("no PNG")
    width, height, bits, colours, _, _, interlaced = struct.unpack_from(">IIBBBBB", content, 16)
    if bits != 8 or colours not in CHANNELS or interlaced or not 0 < width * height < LARGEST:
        raise ValueError("a PNG of another kind than 8 bits a channel, line after line")
    packed, at = [], len(SIGNATURE)
    while at < len(content):
        length, name = struct.unpack_from(">I4s", content, at)
        if name == b"IDAT":
            packed.append(content[at + 8 : at + 8 + length])
        at += length + 12
    return width, height, CHANNELS[colours], b"".join(packed)


def unfiltered(filters: Pixels, differences: Pixels) -> Pixels:
    """Lines as they were before each pixel became its difference from a prediction.

    filters: (H,) of each line. differences: (H, W, C). PNG specification, 9.2: a pixel is predicted
    from those to the left, above, and above left. So all pixels of an anti-diagonal are known once
    those of the two before are; the lines are skewed so that an anti-diagonal lies in one row.
    """
    height, width, channels = differences.shape
    if filters.max() > PAETH:
        raise ValueError("an unknown filter")
    if filters.max() == NONE:
        return differences
    skewed = np.zeros((width + height + 1, height + 1, channels), np.int16)  # two rows, one column
    rows, line = np.arange(height), np.arange(width)
    skewed[rows[:, None] + line + 2, rows[:, None] + 1] = differences
    kind = filters[:, None]
    sub, up, average = kind == SUB, kind == UP, kind == AVERAGE
    paeth = kind == PAETH
    for d in range(2, len(skewed)):
        left, above, corner = skewed[d - 1, 1:], skewed[d - 1, :-1], skewed[d - 2, :-1]
        to_left, to_above = np.abs(above - corner), np.abs(left - corner)
        to_corner = np.abs(left + above - 2 * corner)
        nearest = np.where(to_above <= to_corner, above, corner)
        nearest = np.where((to_left <= to_above) & (to_left <= to_corner), left, nearest)
        guess = left * sub + above * up + ((left + above) >> 1) * average + nearest * paeth
        # what lies beyond the picture's edges stays zero, as the predictions have it
        inside = slice(max(0, d - 1 - width), min(height, d - 1))
        row = skewed[d, 1:]
        row[inside] = (row[inside] + guess[inside]) & 255
    return np.asarray(skewed[rows[:, None] + line + 2, rows[:, None] + 1], np.uint8)


def write_png(path: Path, pixels: Pixels) -> None:
    """Raises OSError."""
    height, width, _ = pixels.shape
    # each line's difference from the one above, which packs flat areas well
    above = np.concatenate([np.zeros_like(pixels[:1]), pixels[:-1]])
    lines = np.empty((height, 1 + 3 * width), np.uint8)
    lines[:, 0] = UP
    lines[:, 1:] = (pixels - above).reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(lines.tobytes(), 6)), (b"IEND", b"")]
    packed = (
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )
    path.write_bytes(SIGNATURE + b"".join(packed))


def shrunk(pixels: Pixels, width: int, height: int) -> Pixels:
    """The whole picture in its proportions, as large as fits in width by height: each new pixel is
    the mean of those it covers. A picture that is smaller already stays as it is."""
    factor = max(pixels.shape[1] / width, pixels.shape[0] / height)
    if factor <= 1.0:
        return pixels
    sums = np.asarray(pixels, np.float32)
    for axis in (0, 1):
        old = sums.shape[axis]
        edges = np.linspace(0, old, max(round(old / factor), 1) + 1).astype(int)
        sums = np.add.reduceat(sums, edges[:-1], axis=axis)
        shape = [1, 1, 1]
        shape[axis] = -1
        sums /= np.diff(edges).reshape(shape)
    return np.asarray(np.rint(sums), np.uint8)
