"""What cannot be written to a rig, found before a solve."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import NoControls
from ..armature.incremental import Incremental
from ..armature.poses import sample
from .control_rig import found_controls
from .driven import driven_of
from .targets import parents_of

MISSING = 0.5  # share of a body's own turn that controls may lack about its best axis
SMALL = 1e-3  # of the largest response: below it there is none


def require_posable(
    armature: bpy.types.Object,
    bodies: tuple[str, ...],
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[bool]:
    """Refuse bodies whose poses a result could not be given, at frames (T,); in slices.

    bodies: the pelvis first. Returns whether controls pose them. Raises NoControls.
    """
    with showing():
        driven = driven_of(armature, bodies)
    if not driven:
        return False
    rig = yield from found_controls(armature, bodies, frames, showing)
    with showing():
        poses = sample(armature, frames[:1])
    parents = parents_of(armature, poses, bodies)
    fixed = {body for turns in rig.turns for body in unled(turns, bodies, parents)}
    if fixed:
        raise NoControls(tuple(body for body in bodies if body in fixed))
    return True


def unled(turns: FloatArray, bodies: tuple[str, ...], parents: list[int]) -> list[str]:
    """Bodies that turns (D, B, 3) cannot turn about any axis while all but those below them stay.

    What is missing of a turn of 1 rad, as a share, by least squares.
    """
    found = []
    for b, body in enumerate(bodies):
        stays = [o for o in range(len(bodies)) if b not in _line(o, parents)] + [b]
        rows = turns[:, stays].reshape(len(turns), -1)
        wanted = np.zeros((3, rows.shape[1]))
        wanted[:, -3:] = np.eye(3)
        weights = np.linalg.lstsq(rows.T, wanted.T, rcond=SMALL)[0]
        # An elbow's axis is none of the armature's: the least of all axes, not of three.
        missing = np.linalg.svd(wanted - weights.T @ rows, compute_uv=False)
        if missing[-1] > MISSING:
            found.append(body)
    return found


def _line(body: int, parents: list[int]) -> list[int]:
    """The body and those above it."""
    return [] if body < 0 else [body, *_line(parents[body], parents)]
