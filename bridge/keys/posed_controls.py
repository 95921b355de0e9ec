"""The keyed figure of a rig that controls pose: what their channels move of its bodies, as tried.

What a rig does between controls and bodies nobody tells, so it is measured at every frame
(`controls/responses.py`), and keys are judged by the bodies, as Blender evaluates them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ..accessors import armature_data, current_scene
from ..armature import fcurves
from ..armature.channels import proper
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import metres_per_unit
from ..controls.control_rig import ControlRig
from ..controls.responses import Dof, Freedom, apart, measured
from ..recipe.keys import KeyOptions
from .bone_channels import BoneChannels, KeyedParts, sampled_channels
from .events import KeyEvents
from .figure import CarriedParts, Errors
from .pose_figure import PLANTED, STEP, angles_between, nearest_frames


@dataclass(frozen=True)
class Tried:
    """What D dofs do to B bodies at a frame: turns (D, B, 3) rad and shifts (D, B, 3) m, world, for
    a radian, a unit or a whole size of each. bases: (C, 4, 4) of the controls. rotations (B, 3, 3),
    heads (B, 3) m: of the bodies, world."""

    turns: FloatArray
    shifts: FloatArray
    bases: FloatArray
    rotations: FloatArray
    heads: FloatArray


@dataclass(frozen=True)
class PosedControls:
    """Channels of a rig's controls at T frames, and what they do to its bodies."""

    rig: ControlRig
    frames: FloatArray
    channels: tuple[BoneChannels, ...]
    tried: tuple[Tried, ...]

    @property
    def bones(self) -> tuple[str, ...]:
        """The bodies."""
        return self.rig.bodies

    def errors(self, values: list[FloatArray]) -> Incremental[tuple[FloatArray, FloatArray]]:
        """Distances (T, B) m of the bodies' heads from where they should be, and angles (T, B) rad,
        with other values (T, n) by control."""
        posing, index = self.rig.posing, {float(f): t for t, f in enumerate(self.frames)}
        bases = {c.bone: c.basis_of(own) for c, own in zip(self.channels, values, strict=True)}

        def look(frames: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
            found = []
            with posing.kept():
                for frame in frames:
                    posing.go_to(float(frame))
                    for control, name in enumerate(self.rig.controls):
                        posing.pose(control, bases[name][index[float(frame)]])
                    to_world = _to_world(posing.object_to_world())
                    found.append(_in_world(to_world, posing.look().bodies))
            return found

        parts = yield from in_slices(self.frames, look)
        shown = [each for part in parts for each in part]
        rotations, heads = (np.stack(each) for each in zip(*shown, strict=True))
        off = np.linalg.norm(heads - np.stack([each.heads for each in self.tried]), axis=2)
        wanted = np.stack([each.rotations for each in self.tried])
        return off, angles_between(rotations, wanted)

    def keyed_figure(self, events: KeyEvents, error: KeyOptions) -> ControlFigure:
        """The bodies, with the points of them that may be off by no more."""
        heads = np.stack([each.heads for each in self.tried])
        rotations = np.stack([each.rotations for each in self.tried])
        rest = armature_data(self.rig.armature).bones
        scale = metres_per_unit(current_scene())
        arms = [np.zeros(3)] * len(self.bones)
        arms += [np.array([0.0, scale * rest[name].length, 0.0]) for name in self.bones]
        planted = [point for point in events.planted if point.bone in self.bones]
        owners = [*range(len(self.bones))] * 2 + [self.bones.index(p.bone) for p in planted]
        arms += [point.offset for point in planted]
        turned = np.einsum("tpij,pj->tpi", rotations[:, owners], np.stack(arms))
        distances = np.full(turned.shape[:2], error.distance)
        for column, point in enumerate(planted, start=2 * len(self.bones)):
            stands = (self.frames >= point.first) & (self.frames <= point.last)
            distances[stands, column] *= PLANTED
        edges = [frame for point in planted for frame in (point.first, point.last)]
        fixed = nearest_frames(self.frames, events.columns)
        feet = nearest_frames(self.frames, (*events.columns, *edges))
        bodies = {self.bones.index(point.bone) for point in planted}
        controls = []
        for own in self.channels:
            turns, places = self._effects(own, turned, owners)
            moved = np.flatnonzero(np.abs(turns).max((0, 1, 3)) > 0.0)
            leads = bool(bodies & set(moved.tolist())) and len(moved) < len(self.bones) // 2
            controls.append(KeyedControl(own.values, feet if leads else fixed, turns, places))
        return ControlFigure(
            self.frames, tuple(controls), heads[:, owners] + turned, distances, error.angle
        )

    def _effects(
        self, own: BoneChannels, arms: FloatArray, owners: list[int]
    ) -> tuple[FloatArray, FloatArray]:
        """Turns (T, n, B, 3) of bodies and displacements (T, n, P, 3) of points, world, by channel
        of a control. arms: (T, P, 3) from the owners' heads."""
        control = self.rig.controls.index(own.bone)
        dofs = self.rig.responses.dofs
        rows = [d for d, dof in enumerate(dofs) if dof.control == control]
        amounts = _amounts(own, [dofs[d] for d in rows])
        turns = np.stack([each.turns[rows] for each in self.tried])
        shifts = np.stack([each.shifts[rows] for each in self.tried])
        turned = np.einsum("tnd,tdbi->tnbi", amounts, turns)
        moved = np.einsum("tnd,tdbi->tnbi", amounts, shifts)[:, :, owners]
        return turned, moved + np.cross(turned[:, :, owners], arms[:, None])


@dataclass(frozen=True)
class KeyedControl:
    """Channels of a control. samples: (T, n). fixed: frames that get a key in any case. turns:
    (T, n, B, 3) of bodies and places: (T, n, P, 3) of points, world, by channel."""

    samples: FloatArray
    fixed: tuple[float, ...]
    turns: FloatArray
    places: FloatArray


@dataclass(frozen=True)
class ControlFigure:
    """Controls with keys, and the points (T, P, 3) m of the bodies that must stay where they are.

    distances: (T, P) m and angle: rad, by which points and bodies may be off.
    """

    frames: FloatArray
    bones: tuple[KeyedControl, ...]
    points: FloatArray
    distances: FloatArray
    angle: float

    @cached_property
    def carried(self) -> tuple[CarriedParts, ...]:
        """By control the bodies and the points that it moves."""
        return tuple(CarriedParts(_moved(own.turns), _moved(own.places)) for own in self.bones)

    def no_errors(self) -> Errors:
        """Zero at every frame."""
        bodies = self.bones[0].turns.shape[2]
        return Errors(np.zeros((len(self.frames), bodies, 3)), 0.0 * self.points)

    def errors_by(self, bone: int, off: FloatArray, frames: slice = slice(None)) -> Errors:
        """What a control's bodies and points are off by if its channels are off by (T', n)."""
        own, parts = self.bones[bone], self.carried[bone]
        return Errors(
            np.einsum("tn,tnbi->tbi", off, own.turns[frames][:, :, parts.bones]),
            np.einsum("tn,tnpi->tpi", off, own.places[frames][:, :, parts.points]),
        )

    def worst(
        self, errors: Errors, frames: slice = slice(None), points: IntArray | slice = slice(None)
    ) -> FloatArray:
        """As of KeyableFigure."""
        return errors.worst(self.distances[frames][:, points], self.angle)


def posed_controls(
    rig: ControlRig, curves: fcurves.CurveHolder, frames: FloatArray
) -> Incremental[PosedControls]:
    """The controls of a rig as curves have them, tried at frames (T,), in slices."""
    posing, groups = rig.posing, apart(rig.responses)
    order = [dof for group in groups for dof, _ in group]
    rows = [order.index(dof) for dof in rig.responses.dofs]

    def look(part: FloatArray) -> list[Tried]:
        with posing.kept():
            return [tried(float(frame)) for frame in part]

    def tried(frame: float) -> Tried:
        posing.go_to(frame)
        bases = posing.bases()
        responses, posed = measured(posing, bases, groups), posing.look()
        to_world = _to_world(posing.object_to_world())
        turns, shifts = responses.columns(posed, bases)
        turns = turns[rows] @ proper(to_world[:3, :3]).T
        return Tried(
            turns, shifts[rows] @ to_world[:3, :3].T, bases, *_in_world(to_world, posed.bodies)
        )

    parts = yield from in_slices(frames, look)
    found = tuple(each for part in parts for each in part)
    bases = np.stack([each.bases for each in found])
    channels = tuple(
        sampled_channels(rig.armature, name, _keyed(rig, name), bases[:, c], curves, frames)
        for c, name in enumerate(rig.controls)
    )
    return PosedControls(rig, frames, channels, found)


def _keyed(rig: ControlRig, name: str) -> KeyedParts:
    used: Mapping[str, set[Freedom]] = rig.used
    parts = used[name]
    turns = Freedom.TURN in parts or name in rig.carriers
    return KeyedParts(turns, Freedom.SHIFT in parts, Freedom.SIZE in parts)


def _amounts(own: BoneChannels, dofs: list[Dof]) -> FloatArray:
    """(T, n, D) by how much each dof of a control changes with each channel."""
    count, width = own.values.shape
    found = np.zeros((count, width, len(dofs)))
    linear = np.linalg.inv(own.basis_of(own.values)[:, :3, :3])
    for k, step in enumerate(STEP * np.eye(width)):
        ahead, back = (own.basis_of(own.values + sign * step) for sign in (1.0, -1.0))
        change = (ahead - back) / (2.0 * STEP)
        inner = linear @ change[:, :3, :3]  # in the axes of the basis
        for d, dof in enumerate(dofs):
            if dof.freedom is Freedom.SHIFT:
                found[:, k, d] = change[:, dof.axis, 3]
            elif dof.freedom is Freedom.SIZE:
                found[:, k, d] = np.trace(inner, axis1=1, axis2=2) / 3.0
            else:
                j, n = (dof.axis + 1) % 3, (dof.axis + 2) % 3
                found[:, k, d] = (inner[:, n, j] - inner[:, j, n]) / 2.0
    return found


def _moved(effects: FloatArray) -> IntArray:
    """Indices of what (T, n, M, 3) effects are on."""
    return np.asarray(np.flatnonzero(np.abs(effects).max((0, 1, 3)) > 0.0))


def _to_world(object_to_world: FloatArray) -> FloatArray:
    """(4, 4) to the world in m."""
    to_world = object_to_world.copy()
    to_world[:3] *= metres_per_unit(current_scene())
    return to_world


def _in_world(to_world: FloatArray, bodies: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rotations (B, 3, 3) and heads (B, 3) m of poses (B, 4, 4) of an armature."""
    placed = to_world @ bodies
    return proper(placed[:, :3, :3]), placed[:, :3, 3]
