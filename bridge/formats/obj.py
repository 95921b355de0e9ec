"""Reads and writes the faces of an OBJ file (Wavefront's text format), as triangles.

Places are taken as they are written: metres, Z up (in Blender's exporter: forward Y, up Z).
Polygons become fans; materials, normals and all else are left aside.
"""

from itertools import pairwise
from math import isfinite
from pathlib import Path

import numpy as np

from ...solver.arrays import FloatArray, IntArray


def read_obj(path: Path) -> tuple[FloatArray, IntArray]:
    """Vertices (V, 3) m and triangles (F, 3). Raises OSError, UnreadableMesh."""
    vertices: list[list[float]] = []
    triangles: list[tuple[int, int, int]] = []
    for number, line in enumerate(path.read_text(encoding="utf-8-sig").splitlines(), start=1):
        kind, *words = line.split() or [""]
        try:
            if kind == "v":
                x, y, z = map(float, words[:3])
                if not isfinite(x + y + z):
                    raise ValueError(line)
                vertices.append([x, y, z])
            elif kind == "f":
                corners = [_index(word, len(vertices)) for word in words]
                triangles += [(corners[0], b, c) for b, c in pairwise(corners[1:])]
        except ValueError as error:
            raise UnreadableMesh(number, line.strip()) from error
    return np.array(vertices).reshape(-1, 3), np.array(triangles, dtype=int).reshape(-1, 3)


def obj_text(vertices: FloatArray, triangles: IntArray) -> str:
    """The text that is read as vertices (V, 3) m and triangles (F, 3), to the last digit."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (triangles + 1).tolist()]
    return "\n".join([*lines, ""])


class UnreadableMesh(Exception):
    """A line (1-based) of an OBJ file that is no vertex or face; text: what it says."""

    def __init__(self, line: int, text: str) -> None:
        super().__init__(line, text)
        self.line, self.text = line, text


def _index(word: str, count: int) -> int:
    """From 0, of a corner such as "3/1/2"; negative ones count from the last vertex read."""
    index = int(word.split("/")[0])
    index = index - 1 if index > 0 else count + index
    if not 0 <= index < count:
        raise ValueError(word)
    return index
