"""The keyed figure of a rig that controls pose: what their channels move of its bodies, as tried.

What a rig does between controls and bodies nobody tells, so each channel is tried at every frame,
and keys are judged by the bodies, as Blender evaluates them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import BoolArray, FloatArray, IntArray
from ...solver.numerics.rotations import angles_between, rotation_vector
from ..accessors import armature_data, current_scene
from ..armature import fcurves
from ..armature.channels import proper
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import metres_per_unit
from ..controls.control_rig import ControlRig
from ..controls.posing import Posing
from ..controls.responses import Freedom, disjoint
from ..recipe.keys import KeyOptions
from .bone_channels import BoneChannels, KeyedParts, sampled_channels
from .events import KeyEvents
from .figure import CarriedParts, Errors
from .pose_figure import PLANTED, nearest_frames

STEP = 0.001  # of a channel, by which it is tried
STILL = 1e-6  # of a channel; one that changes by less is off by less, whatever its keys


@dataclass(frozen=True)
class Tried:
    """What N channels of controls, one after the other, do to B bodies at a frame: turns (N, B, 3)
    rad and shifts (N, B, 3) m, world, for a unit of each. rotations (B, 3, 3), heads (B, 3) m: of
    the bodies, world."""

    turns: FloatArray
    shifts: FloatArray
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
        bodies = [self.bones.index(point.bone) for point in planted]
        last = np.cumsum([own.values.shape[1] for own in self.channels])
        controls = []
        for own, stop in zip(self.channels, last.tolist(), strict=True):
            columns = slice(stop - own.values.shape[1], stop)
            turns, places = self._effects(columns, turned, owners)
            of = self.rig.followers(own.bone)
            leads = bool(of[bodies].any()) and of.sum() < len(self.bones) // 2
            carried = CarriedParts(np.flatnonzero(of), np.flatnonzero(of[owners]))
            columns_of = feet if leads else fixed
            controls.append(KeyedControl(own.values, columns_of, turns, places, carried))
        return ControlFigure(
            self.frames, tuple(controls), heads[:, owners] + turned, distances, error.angle
        )

    def _effects(
        self, columns: slice, arms: FloatArray, owners: list[int]
    ) -> tuple[FloatArray, FloatArray]:
        """Turns (T, n, B, 3) of bodies and displacements (T, n, P, 3) of points, world, by some of
        all channels. arms: (T, P, 3) from the owners' heads."""
        turns = np.stack([each.turns[columns] for each in self.tried])
        shifts = np.stack([each.shifts[columns] for each in self.tried])
        return turns, shifts[:, :, owners] + np.cross(turns[:, :, owners], arms[:, None])


@dataclass(frozen=True)
class KeyedControl:
    """Channels of a control. samples: (T, n). fixed: frames that get a key in any case. turns:
    (T, n, B, 3) of bodies and places: (T, n, P, 3) of points, world, by channel. carried: those
    that follow the control."""

    samples: FloatArray
    fixed: tuple[float, ...]
    turns: FloatArray
    places: FloatArray
    carried: CarriedParts


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

    @property
    def carried(self) -> tuple[CarriedParts, ...]:
        """By control the bodies and the points that it moves."""
        return tuple(own.carried for own in self.bones)

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
    posing, index = rig.posing, {float(frame): t for t, frame in enumerate(frames)}

    def animated(part: FloatArray) -> list[FloatArray]:
        with posing.kept():
            return [at(float(frame)) for frame in part]

    def at(frame: float) -> FloatArray:
        posing.go_to(frame)
        return posing.bases()

    parts = yield from in_slices(frames, animated)
    bases = np.stack([each for part in parts for each in part])
    channels = tuple(
        sampled_channels(rig.armature, name, _keyed(rig, name), bases[:, c], curves, frames)
        for c, name in enumerate(rig.controls)
    )
    groups = _groups(rig, channels)
    count = sum(own.values.shape[1] for own in channels)

    def look(part: FloatArray) -> list[Tried]:
        with posing.kept():
            return [_tried(posing, at(float(f)), groups, count, index[float(f)]) for f in part]

    tried = yield from in_slices(frames, look)
    return PosedControls(rig, frames, channels, tuple(each for part in tried for each in part))


@dataclass(frozen=True)
class _Trial:
    """A channel changed by a step. row: its own, of the channels of all controls. bases: (T, 4, 4)
    of its control then. of: (B,) the bodies that follow this control."""

    row: int
    control: int
    bases: FloatArray
    of: BoolArray


def _groups(rig: ControlRig, channels: tuple[BoneChannels, ...]) -> list[list[_Trial]]:
    """Trials of the channels that change, locked ones too: a take may turn what the interface does
    not. Those that are tried at once move no body in common."""
    trials, row = [], 0
    for control, own in enumerate(channels):
        of, changes = rig.followers(own.bone), np.ptp(own.values, axis=0)
        for step, change in zip(STEP * np.eye(len(changes)), changes, strict=True):
            if change > STILL:
                trials.append(_Trial(row, control, own.basis_of(own.values + step), of))
            row += 1
    mine = np.eye(len(channels), dtype=bool)
    moved = [np.append(trial.of, mine[trial.control]) for trial in trials]
    return [[trials[i] for i in group] for group in disjoint(moved)]


def _tried(
    posing: Posing, bases: FloatArray, groups: list[list[_Trial]], count: int, t: int
) -> Tried:
    """What channels, that many, do at the frame that is shown, of index t. bases: (C, 4, 4)."""
    for control, basis in enumerate(bases):
        posing.pose(control, basis)
    to_world = _to_world(posing.object_to_world())
    rotations, heads = _in_world(to_world, posing.look().bodies)
    turns, shifts = np.zeros((2, count, *heads.shape))
    for group in groups:
        for trial in group:
            posing.pose(trial.control, trial.bases[t])
        turned, moved = _in_world(to_world, posing.look().bodies)
        turn = rotation_vector(turned @ np.swapaxes(rotations, 1, 2)) / STEP
        for trial in group:
            posing.pose(trial.control, bases[trial.control])
            turns[trial.row, trial.of] = turn[trial.of]
            shifts[trial.row, trial.of] = (moved - heads)[trial.of] / STEP
    return Tried(turns, shifts, rotations, heads)


def _keyed(rig: ControlRig, name: str) -> KeyedParts:
    used: Mapping[str, set[Freedom]] = rig.used
    parts = used[name]
    turns = Freedom.TURN in parts or name in rig.carriers
    return KeyedParts(turns, Freedom.SHIFT in parts, Freedom.SIZE in parts)


def _to_world(object_to_world: FloatArray) -> FloatArray:
    """(4, 4) to the world in m."""
    to_world = object_to_world.copy()
    to_world[:3] *= metres_per_unit(current_scene())
    return to_world


def _in_world(to_world: FloatArray, bodies: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rotations (B, 3, 3) and heads (B, 3) m of poses (B, 4, 4) of an armature."""
    placed = to_world @ bodies
    return proper(placed[:, :3, :3]), placed[:, :3, 3]
