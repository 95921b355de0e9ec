"""What was changed by hand, as offsets from what was written: the polish of a result.

Rotations are told by their turn from what was written, in the bone's own axes, as Blender's NLA
combines quaternions, and the sizes of a difference by how many times they are what was written;
everything else by its difference. So a hand that was lifted stays as far lifted, wherever the arm
is in the next result.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.numerics.rotations import rotation_matrix, rotation_vector
from ..accessors import pose_of
from ..armature import fcurves
from ..armature.channels import EULER_ORDERS, channels, rotations_of
from ..takes.take_time import TakeTime
from .samples import Channel, CurveSamples, Written, edited_action, sampled

_SAME = 1e-6  # of a channel's value; float32 leaves less
_ROTATIONS = {"rotation_quaternion": 4, "rotation_axis_angle": 4, "rotation_euler": 3}
_DEFAULTS = {"scale": 1.0}
_FACTORS = "FACTORS"


@dataclass(frozen=True)
class HandOffset:
    """Of a property: values (T, n). mode: the rotation mode of one whose values are rotation
    vectors, rad, in the bone's own axes (n = 3); FACTORS of one whose values are logarithms of
    factors; None of one whose values are summands."""

    path: str
    indices: tuple[int, ...]
    mode: str | None
    values: FloatArray

    def at(self, own: FloatArray, frames: FloatArray) -> FloatArray:
        """Values (N, n) at frames (N,) of the frames that it has, `own` (T,); beyond them held."""
        columns = [np.interp(frames, own, column) for column in self.values.T]
        return np.stack(columns, axis=1)

    def put_on(self, base: FloatArray, offsets: FloatArray) -> FloatArray:
        """Channels (N, c) of the property with offsets (N, n) on top, on the base's branch."""
        if self.mode is None:
            return np.asarray(base + offsets)
        if self.mode == _FACTORS:
            return np.asarray(base * np.exp(offsets))
        turned = rotations_of(base, self.mode) @ rotation_matrix(offsets)
        values = channels(turned, self.mode, base[0])
        if self.mode == "QUATERNION":
            side = np.einsum("ti,ti->t", values, base)
            return np.asarray(values * np.where(side < 0.0, -1.0, 1.0)[:, None])
        if self.mode in EULER_ORDERS:
            whole = 2.0 * np.pi * np.round((values - base) / (2.0 * np.pi))
            return np.asarray(values - whole)
        return values


def acting(offsets: FloatArray) -> BoolArray:
    """(T,) where offsets (T, n) change anything."""
    return np.asarray(np.abs(offsets).max(axis=1) > _SAME)


@dataclass(frozen=True)
class Polish:
    """Hand polish of a result. frames: (T,) of that result. time: its take's frames in it.

    unkept: lines about edits that no offset tells.
    """

    result: bpy.types.Action
    frames: FloatArray
    offsets: tuple[HandOffset, ...]
    time: TakeTime
    unkept: tuple[str, ...]


def polish_of(armature: bpy.types.Object, result: bpy.types.Action, written: Written) -> Polish:
    """What was changed by hand in a result of an armature since it was made."""
    was = written.samples
    edited = edited_action(result)
    now = sampled(edited, fcurves.slot_identifier(armature))
    frames = np.union1d(was.frames, now.frames)
    offsets, remoded = [], []
    for path in dict.fromkeys(path for path, _ in now.values):
        if _other_mode(path, was):
            remoded.append(fcurves.bone_of(path) or armature.name)
            continue
        offset = _offset(armature, path, was, now, frames, combined=edited != result)
        if offset is not None:
            offsets.append(offset)
    gone = {fcurves.bone_of(path) or path for path, index in was.values.keys() - now.values.keys()}
    told = []
    if gone:
        told.append(f"Curves that were removed or muted by hand are back: {_listed(gone)}")
    if remoded:
        told.append(f"Not kept, as the rotation mode was changed: {_listed(set(remoded))}")
    return Polish(result, frames, tuple(offsets), written.time, tuple(told))


def _listed(names: set[str]) -> str:
    return ", ".join(sorted(names))


def _other_mode(path: str, was: CurveSamples) -> bool:
    """Whether a rotation was written in another mode than that of a property."""
    owner, _, attribute = path.rpartition(".")
    if attribute not in _ROTATIONS or (path, 0) in was.values:
        return False
    others = (f"{owner}.{each}".lstrip(".") for each in _ROTATIONS if each != attribute)
    return any((other, 0) in was.values for other in others)


def _offset(
    armature: bpy.types.Object,
    path: str,
    was: CurveSamples,
    now: CurveSamples,
    frames: FloatArray,
    *,
    combined: bool,
) -> HandOffset | None:
    """Of a property; None where it is as it was written."""
    attribute = path.rpartition(".")[2]
    known = {index for other, index in (*was.values, *now.values) if other == path}
    indices = tuple(range(_ROTATIONS[attribute])) if attribute in _ROTATIONS else (*sorted(known),)
    one, other = (_columns(each, path, indices, frames) for each in (was, now))
    for k, index in enumerate(indices):
        if (path, index) not in now.values:  # told to be back, where there was one
            other[:, k] = one[:, k]
    if np.abs(other - one).max() <= _SAME:
        return None
    if combined and attribute == "scale" and (one * other > 0.0).all():  # Blender multiplies them
        return HandOffset(path, indices, _FACTORS, np.log(other / one))
    mode = _mode_of(armature, path) if attribute in _ROTATIONS else None
    if mode is None or (combined and mode != "QUATERNION"):  # Blender adds up angles
        return HandOffset(path, indices, None, other - one)
    turns = np.swapaxes(rotations_of(one, mode), -1, -2) @ rotations_of(other, mode)
    return HandOffset(path, indices, mode, rotation_vector(turns))


def _mode_of(armature: bpy.types.Object, path: str) -> str | None:
    """The rotation mode in which a property's values count; None of one that we do not know."""
    attribute, bone = path.rpartition(".")[2], fcurves.bone_of(path)
    if attribute == "rotation_quaternion":
        return "QUATERNION"
    if attribute == "rotation_axis_angle":
        return "AXIS_ANGLE"
    posed = pose_of(armature).bones.get(bone) if bone is not None else armature
    mode = getattr(posed, "rotation_mode", None)
    return mode if mode in EULER_ORDERS else None


def _columns(
    samples: CurveSamples, path: str, indices: tuple[int, ...], frames: FloatArray
) -> FloatArray:
    """(N, c) values of a property at frames (N,)."""
    found = [samples.at((path, i), frames, default_of((path, i))) for i in indices]
    return np.stack(found, axis=1)


def default_of(channel: Channel) -> float:
    """What a channel without a curve counts as."""
    path, index = channel
    attribute = path.rpartition(".")[2]
    if attribute == "rotation_quaternion" and index == 0:
        return 1.0
    if attribute == "rotation_axis_angle" and index == 2:
        return 1.0
    return _DEFAULTS.get(attribute, 0.0)


def without(polish: Polish, samples: CurveSamples, frames: FloatArray) -> CurveSamples:
    """Samples of a result as they are without a polish. frames: (T,) of the polish at theirs."""
    values = dict(samples.values)
    for offset in polish.offsets:
        more = offset.at(polish.frames, frames)
        less = _columns(samples, offset.path, offset.indices, samples.frames)
        rows = acting(more)
        if rows.any():
            less[rows] = offset.put_on(less[rows], -more[rows])
        for index, column in zip(offset.indices, less.T, strict=True):
            if (offset.path, index) in values:
                values[offset.path, index] = column
    return CurveSamples(samples.frames, values)
