"""What cannot be written to a rig, found before a solve."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import NoControls, PulledFromOutside
from ..armature.incremental import Incremental
from ..armature.played import leaders_of
from ..armature.poses import sample
from .control_rig import found_controls
from .driven import chain_of, constraints_of, driven_of
from .followed import acting
from .needed import LEVER
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

    bodies: the pelvis first. Returns whether controls pose them. Raises PulledFromOutside,
    NoControls.
    """
    with showing():
        driven = driven_of(armature, bodies)
    if not driven:
        return False
    yield from _require_inside(armature, bodies, frames, showing)
    rig = yield from found_controls(armature, bodies, frames, showing)
    with showing():
        poses = sample(armature, frames[:1])
    parents = parents_of(armature, poses, bodies)
    fixed = {body for each in rig.effects for body in unled(each.done, bodies, parents)}
    if fixed:
        raise NoControls(tuple(body for body in bodies if body in fixed))
    return True


def _require_inside(
    armature: bpy.types.Object,
    bodies: tuple[str, ...],
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]],
) -> Incremental[None]:
    """Refuse bodies that inverse kinematics pulls or turns towards what the armature's bones do
    not move: a hip that shifts turns such a leg, too, so that trying alone would not tell. Raises
    PulledFromOutside."""
    with showing():
        outside = [
            (index, bone.name, each.name, thing.name)
            for index, (bone, each) in enumerate(constraints_of(armature))
            if not set(bodies).isdisjoint(chain_of(bone, each))
            for thing in _pulling(each)
            if thing != armature and not _moves(armature, thing)
        ]
    if not outside:
        return
    acts = yield from acting(armature, frames, showing)
    pulls = [names for index, *names in outside if acts[:, index].any()]
    if pulls:
        named = zip(*pulls, strict=True)
        raise PulledFromOutside(*(tuple(dict.fromkeys(names)) for names in named))


def _pulling(constraint: bpy.types.Constraint) -> list[bpy.types.Object]:
    """What a constraint of inverse kinematics pulls towards, and turns the chain's bend to."""
    if not isinstance(constraint, bpy.types.KinematicConstraint):
        return []
    things = (constraint.target, constraint.pole_target)
    return [thing for thing in things if thing is not None]


def _moves(
    armature: bpy.types.Object, thing: bpy.types.Object, seen: tuple[bpy.types.Object, ...] = ()
) -> bool:
    """Whether bones of an armature may move an object that hangs on others or follows them."""
    return any(
        bool(bone) if other == armature else _moves(armature, other, (*seen, thing))
        for other, bone in _led_by(thing)
        if other is not None and other not in seen
    )


def _led_by(thing: bpy.types.Object) -> Iterator[tuple[bpy.types.Object | None, str]]:
    """Objects that one hangs on or follows, with the bone where it is one's."""
    yield thing.parent, thing.parent_bone if thing.parent_type == "BONE" else ""
    for constraint in thing.constraints:
        yield from leaders_of(constraint)


def unled(done: FloatArray, bodies: tuple[str, ...], parents: list[int]) -> list[str]:
    """Bodies that what dofs do (D, 6 B), as of `Effects`, cannot turn about any axis while their
    head and all but those below them stay: who turns a thigh by moving the hip joint tears it out.

    What is missing of a turn of 1 rad, as a share, by least squares.
    """
    shifts, turns = done.reshape(len(done), 2, len(bodies), 3).swapaxes(0, 1)
    found = []
    for b, body in enumerate(bodies):
        stays = [o for o in range(len(bodies)) if b not in _line(o, parents)] + [b]
        rows = np.concatenate([shifts[:, stays], turns[:, stays]], axis=1).reshape(len(done), -1)
        wanted = np.zeros((3, rows.shape[1]))
        wanted[:, -3:] = LEVER * np.eye(3)
        weights = np.linalg.lstsq(rows.T, wanted.T, rcond=SMALL)[0]
        # An elbow's axis is none of the armature's: the least of all axes, not of three.
        missing = np.linalg.svd(wanted - weights.T @ rows, compute_uv=False)
        if missing[-1] > MISSING * LEVER:
            found.append(body)
    return found


def _line(body: int, parents: list[int]) -> list[int]:
    """The body and those above it."""
    return [] if body < 0 else [body, *_line(parents[body], parents)]
