"""The root bone of a file under hips whose way it carries, or has left, and what stays on it."""

from __future__ import annotations

import numpy as np

from ...solver.arrays import FloatArray
from .skeleton import Outline

_AT_REST = 1e-3  # rad, and of the figure's size, by which a bone that rests may be off


def with_root(
    poses: FloatArray, found: Outline, rest: FloatArray, pelvis: str, root: FloatArray
) -> FloatArray:
    """The same poses (T, B, 4, 4) with the root bone at `root` (T, 4, 4). rest: (B, 4, 4).

    What hangs on it, is not of the body and rests on it keeps its place on it, as Unreal's
    `ik_foot_root` and `interaction` do; what moves by itself, as `ik_foot_l`, stays where it was.
    """
    top = found.root
    assert top is not None
    size = _size(rest)
    placed, on_root, body = poses.copy(), {top}, {pelvis}
    placed[:, top] = root
    for i, (name, parent) in enumerate(zip(found.names, found.parents, strict=True)):
        if name in body or (parent >= 0 and found.names[parent] in body):
            body.add(name)
        elif parent in on_root and _rests(poses[:, [top, i]], rest[[top, i]], size):
            on_root.add(i)
            placed[:, i] = root @ np.linalg.solve(rest[top], rest[i])
    return placed


def is_still(poses: FloatArray, rest: FloatArray) -> bool:
    """Whether a bone (T, 4, 4) keeps one pose, in a figure of bones at rest (B, 4, 4)."""
    moved = np.ptp(poses, axis=0)
    moved[:3, 3] /= _size(rest)
    return bool(moved.max() < _AT_REST)


def _size(rest: FloatArray) -> float:
    return float(np.ptp(rest[:, :3, 3], axis=0).max())


def _rests(poses: FloatArray, rest: FloatArray, size: float) -> bool:
    """Whether the second of two bones (T, 2, 4, 4) is on the first as at rest (2, 4, 4)."""
    apart = np.linalg.solve(poses[:, 0], poses[:, 1]) - np.linalg.solve(rest[0], rest[1])
    apart[:, :3, 3] /= size
    return bool(np.abs(apart).max() < _AT_REST)
