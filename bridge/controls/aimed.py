"""Neck and head that constraints or drivers aim, as at what the figure looks at: a result leaves
that to them, for they weigh little and nothing stands on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.body.character import Body
from ...solver.data.recording import Bone, PoseTrack, Recording
from ...solver.skeleton.parts import Part, Segment
from ..accessors import pose_of
from ..armature.poses import sample
from ..armature.read import recording_of
from .driven import beside_keys, driven_of, is_driven, turned_by_drivers
from .held import LOOKS, held_bones

AIMABLE = (Part.NECK, Part.HEAD)


def aimed_bones(
    armature: bpy.types.Object,
    bones: Sequence[Bone],
    segments: Sequence[Segment],
    frames: FloatArray,
) -> tuple[str, ...]:
    """Those of neck and head that something poses otherwise than their own keys do, at frames (T,)
    of what the armature shows; none where controls pose the rest of the body.

    bones: the recording's. segments: the body's, the pelvis first.
    """
    if not beside_keys(armature):
        return ()
    bodies = [bones[segment.bone].name for segment in segments]
    above = [bones[s.bone].name for s in segments if s.part in AIMABLE]
    if is_driven(armature, set(bodies).difference(above)):
        return ()
    held = held_bones(armature, above, frames)
    led = {*driven_of(armature, above), *turned_by_drivers(armature, [bodies[0], *above])}
    led.update(held[0] if held is not None else ())
    return tuple(name for name in above if name in led)


def without(track: PoseTrack, bones: Sequence[str]) -> PoseTrack:
    """The track of all other bones."""
    kept = [i for i, name in enumerate(track.bones) if name not in bones]
    names = tuple(track.bones[i] for i in kept)
    return replace(track, bones=names, rotations=track.rotations[:, kept])


@dataclass(frozen=True)
class Aimed:
    """Bones that are still aimed, and by what (names of constraints; none of drivers): how far they
    turn from the solution at most, in which frame, and how far that takes the centre of mass."""

    bones: tuple[str, ...]
    constraints: tuple[str, ...]
    degrees: float
    frame: float
    mm: float


def aimed_in(
    armature: bpy.types.Object, names: Sequence[str], track: PoseTrack, bodies: Sequence[Body]
) -> Aimed:
    """How a result that the armature shows differs from its solution by bones that are aimed.

    track: the solution, these bones among it. bodies: of the figure.
    """
    rows = np.unique(np.linspace(0, len(track.frames) - 1, LOOKS).round().astype(int))
    at = track.frames[rows]
    shown = recording_of(armature, at, sample(armature, at))
    turns = np.stack([track.rotations[rows, track.bones.index(name)] for name in names], axis=1)
    now = shown.rotations[:, [shown.index(name) for name in names]]
    cosines = 0.5 * (np.einsum("tbij,tbij->tb", now, turns) - 1.0)
    angles = np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))).max(axis=1)
    shift = np.linalg.norm(_shift(shown, names, turns, bodies), axis=1)
    posed = [
        constraint for name in names for constraint in pose_of(armature).bones[name].constraints
    ]
    led = tuple(dict.fromkeys(each.name for each in posed if each.is_valid and not each.mute))
    worst = int(angles.argmax())
    return Aimed(
        tuple(names), led, float(angles[worst]), float(at[worst]), 1e3 * float(shift.max())
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
