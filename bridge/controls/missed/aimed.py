"""Neck and head that constraints or drivers aim, as at what the figure looks at: a result leaves
that to them, for they weigh little and nothing stands on them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace

import bpy
import numpy as np

from ....solver.arrays import FloatArray
from ....solver.body.character import Body
from ....solver.data.recording import Bone, PoseTrack, Recording
from ....solver.numerics.rotations import angles_between
from ....solver.skeleton.parts import Part, Segment
from ...armature.incremental import Incremental
from ...armature.poses import sample
from ...armature.read import recording_of
from ..driven import acting_on, beside_keys, driven_of, is_driven, turned_by_drivers
from .held import LOOKS, held_bones

AIMABLE = (Part.NECK, Part.HEAD)


@dataclass(frozen=True)
class LedBones:
    """Bones of a body that something poses otherwise than their own keys do. aimed: those of neck
    and head, parents first, from the first on that is led: what hangs on one goes where that does.
    held: those of the rest that `held_bones` finds."""

    aimed: tuple[str, ...] = ()
    held: Mapping[str, float] = field(default_factory=dict)


def led_bones(
    armature: bpy.types.Object,
    bones: Sequence[Bone],
    segments: Sequence[Segment],
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[LedBones]:
    """Those at frames (T,) of what the armature shows, in slices; none where controls pose the body
    below the neck. showing: as of `in_slices`.

    bones: the recording's. segments: the body's, the pelvis first.
    """
    if not beside_keys(armature):
        return LedBones()
    bodies = [bones[segment.bone].name for segment in segments]
    above = [bones[s.bone].name for s in segments if s.part in AIMABLE]
    with showing():
        if is_driven(armature, set(bodies).difference(above)):
            return LedBones()
        led = {*driven_of(armature, above), *turned_by_drivers(armature, [bodies[0], *above])}
    held = yield from held_bones(armature, bodies, frames, showing)
    led |= held.keys()
    first = next((i for i, name in enumerate(above) if name in led), len(above))
    aimed = tuple(above[first:])
    return LedBones(aimed, {name: at for name, at in held.items() if name not in aimed})


def without(track: PoseTrack, bones: Sequence[str]) -> PoseTrack:
    """The track of all other bones."""
    kept = [i for i, name in enumerate(track.bones) if name not in bones]
    names = tuple(track.bones[i] for i in kept)
    return replace(track, bones=names, rotations=track.rotations[:, kept])


@dataclass(frozen=True)
class Aimed:
    """Bones that are still aimed, and by what (names of constraints; whether by drivers): how far
    they turn from the solution at most, in which frame, and how far that takes the centre of
    mass."""

    bones: tuple[str, ...]
    constraints: tuple[str, ...]
    drivers: bool
    degrees: float
    frame: float
    mm: float


def aimed_in(
    armature: bpy.types.Object, names: Sequence[str], track: PoseTrack, bodies: Sequence[Body]
) -> Aimed | None:
    """How a result that the armature shows differs from its solution by bones that are aimed; None
    where none of them is a body of its own, as of a neck that is one body with the bone below.

    track: the solution, its pelvis first. bodies: of the figure.
    """
    moved = [name for name in names if name in track.bones]
    if not moved:
        return None
    rows = np.unique(np.linspace(0, len(track.frames) - 1, LOOKS).round().astype(int))
    at = track.frames[rows]
    shown = recording_of(armature, at, sample(armature, at))
    turns = np.stack([track.rotations[rows, track.bones.index(name)] for name in moved], axis=1)
    now = shown.rotations[:, [shown.index(name) for name in moved]]
    angles = np.degrees(angles_between(now, turns)).max(axis=1)
    shift = np.linalg.norm(_shift(shown, moved, turns, bodies), axis=1)
    worst = int(angles.argmax())
    return Aimed(
        tuple(moved),
        acting_on(armature, names),
        not set(names).isdisjoint(turned_by_drivers(armature, [track.bones[0], *names])),
        float(angles[worst]),
        float(at[worst]),
        1e3 * float(shift.max()),
    )


def _shift(
    shown: Recording, names: Sequence[str], turns: FloatArray, bodies: Sequence[Body]
) -> FloatArray:
    """(T, 3) m, from the solution's centre of mass to the one that is shown. turns: (T, N, 3, 3),
    bone to world, of the solution; names: of these N bones, parents first."""
    heads: dict[str, FloatArray] = {}
    moved, total = np.zeros((len(turns), 3)), sum(body.mass for body in bodies)
    for n, name in enumerate(names):
        bone = shown.index(name)
        heads[name] = shown.heads[:, bone].copy()
        parent = shown.bones[bone].parent
        while parent >= 0 and shown.bones[parent].name not in heads:
            parent = shown.bones[parent].parent
        if parent >= 0:
            above = shown.bones[parent].name
            apart = shown.heads[:, bone] - shown.heads[:, parent]
            turned = turns[:, names.index(above)] @ np.swapaxes(shown.rotations[:, parent], 1, 2)
            heads[name] = heads[above] + np.einsum("tij,tj->ti", turned, apart)
        for body in (each for each in bodies if each.bone == name):
            com = shown.bones[bone].rotation.T @ body.com
            there = shown.heads[:, bone] - heads[name]
            moved += body.mass * (there + (shown.rotations[:, bone] - turns[:, n]) @ com)
    return moved / total
