"""Channels that a result owns: of bodies' bones, where the figure is, and what goes along."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.stance_move import StanceMove
from ..accessors import armature_data, pose_of
from ..armature.fcurves import CurveHolder, values_at
from ..armature.pose_basis import carrier_of
from ..armature.write import property_values, rotation_channel, steady_properties
from ..companions.found import Companions
from ..controls.control_rig import ControlRig
from ..controls.responses import Freedom
from .key_splice import FullTurns

_STRAIGHT = 1e-3  # rad, by which a stance may turn where a root bone need not turn with it
_WHOLE = 0.5  # rad, by which angles may miss whole turns to count as such


@dataclass(frozen=True)
class OwnedChannel:
    """A property of a bone whose curves a result owns. carries: whether it moves the figure."""

    bone: str
    path: str
    attribute: str
    carries: bool

    def at_rest(self, armature: bpy.types.Object) -> FloatArray:
        """(n,) the values that the property has where nothing animates it, as the take is shown."""
        return np.array(getattr(pose_of(armature).bones[self.bone], self.attribute))

    def recorded(self, curves: CurveHolder, rest: FloatArray, frames: FloatArray) -> FloatArray:
        """(T, n) the values that the take's curves have at frames (T,). rest: as of `at_rest`."""
        values = np.tile(rest, (len(frames), 1)).astype(float)
        for index in range(values.shape[1]):
            curve = curves.fcurves.find(self.path, index=index)
            if curve is not None:
                values[:, index] = values_at(curve, frames)
        return values

    def values(
        self, armature: bpy.types.Object, bases: FloatArray, recorded: FloatArray
    ) -> FloatArray:
        """(T, n) channels of bases (T, 4, 4), beginning on the branch of the recorded ones."""
        bone = pose_of(armature).bones[self.bone]
        return property_values(bone, self.attribute, bases, recorded[0])

    def turns(self, values: FloatArray, recorded: FloatArray) -> list[FullTurns]:
        """Full turns, by channel, that new values (T, n) have more than the recorded ones."""
        count = values.shape[1]
        if self.attribute == "rotation_quaternion":
            flips = np.sign(np.einsum("ti,ti->t", recorded[1:], recorded[:-1]))
            same = np.prod(flips) * (values[-1] @ recorded[-1])
            return [FullTurns(factor=-1.0 if same < 0.0 else 1.0)] * count
        if self.attribute == "rotation_euler":
            more = values[-1] - np.unwrap(recorded, axis=0)[-1]
            whole = 2.0 * np.pi * np.round(more / (2.0 * np.pi))
            if np.abs(more - whole).max() < _WHOLE:
                return [FullTurns(summand=float(each)) for each in whole]
        return [FullTurns()] * count


def owned_channels(armature: bpy.types.Object, bones: tuple[str, ...]) -> Iterator[OwnedChannel]:
    """The channels of a track's bones, of which the first is the pelvis."""
    carrier = carrier_of(armature_data(armature).bones[bones[0]]).name
    posed, carrying = pose_of(armature).bones, carrying_bones(armature, bones)
    for bone in bones:
        attribute = rotation_channel(posed[bone])
        path = posed[bone].path_from_id(attribute)
        yield OwnedChannel(bone, path, attribute, carries=bone in carrying)
    path = posed[carrier].path_from_id("location")
    yield OwnedChannel(carrier, path, "location", carries=True)


def steady_channels(
    armature: bpy.types.Object, curves: CurveHolder, bodies: tuple[str, ...], steady: Iterable[str]
) -> Iterator[OwnedChannel]:
    """The channels with keys of bones that hold joints in their places, steady."""
    for bone in steady:
        for attribute in steady_properties(armature, curves, bodies, bone):
            path = pose_of(armature).bones[bone].path_from_id(attribute)
            yield OwnedChannel(bone, path, attribute, carries=False)


def carrying_bones(armature: bpy.types.Object, bones: tuple[str, ...]) -> tuple[str, ...]:
    """Of a track's bones those that have to turn for all to turn as one body: the pelvis, and what
    does not inherit its rotation."""
    rest = armature_data(armature).bones
    return bones[:1] + tuple(each for each in bones[1:] if not rest[each].use_inherit_rotation)


def placing_channels(
    armature: bpy.types.Object, bone: str, *, turns: bool = True, carries: bool = False
) -> Iterator[OwnedChannel]:
    """The channels that place a bone beside the body and, where it turns, turn it."""
    posed = pose_of(armature).bones[bone]
    for attribute in ("location", *[rotation_channel(posed)] * turns):
        yield OwnedChannel(bone, posed.path_from_id(attribute), attribute, carries)


def company_channels(
    armature: bpy.types.Object,
    curves: CurveHolder,
    company: Companions,
    moved: StanceMove | None,
) -> tuple[tuple[OwnedChannel, ...], tuple[OwnedChannel, ...]]:
    """The channels of the root bone, which turns where the last stance does, and those with keys of
    what keeps its place on the body."""
    root: Iterable[OwnedChannel] = ()
    if company.root is not None:
        turns = moved is not None and abs(moved.turn) > _STRAIGHT
        root = placing_channels(armature, company.root, turns=turns, carries=True)
    keyed = {curve.data_path for curve in curves.fcurves}
    channels = (c for bone, _ in company.followers for c in placing_channels(armature, bone))
    return tuple(root), tuple(channel for channel in channels if channel.path in keyed)


def owned_by(rig: ControlRig, curves: CurveHolder) -> Iterator[OwnedChannel]:
    """The channels of the controls that pose a rig's bodies. One that carries the figure turns with
    it where it has keys of its turn, though that poses nothing, as a pole's."""
    keyed = {curve.data_path for curve in curves.fcurves}
    for name, freedoms in rig.used.items():
        bone, carries = pose_of(rig.armature).bones[name], name in rig.carriers
        attribute = rotation_channel(bone)
        path = bone.path_from_id(attribute)
        if Freedom.TURN in freedoms or (carries and path in keyed):
            yield OwnedChannel(name, path, attribute, carries)
        if Freedom.SHIFT in freedoms:
            yield OwnedChannel(name, bone.path_from_id("location"), "location", carries)
        if Freedom.SIZE in freedoms:
            yield OwnedChannel(name, bone.path_from_id("scale"), "scale", carries=False)
