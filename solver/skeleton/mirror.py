"""A recording mirrored: what the left side did the right side does, on the same skeleton."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray
from ..data.faults import NotMirrored
from ..data.problem import MotionProblem, Pin
from ..data.recording import Bone, Recording
from .names import split_side
from .parts import Side

OTHER = {"left": "right", "right": "left", "l": "r", "r": "l"}
OTHER_LETTER = {"L": "R", "R": "L", "l": "r", "r": "l"}
NEAR_AXIS = np.cos(np.radians(10.0))  # a rest pose that faces so near along an axis faces along it
LEVEL = 0.3  # of the vector from one side to the other: less along the floor tells no direction


def other_side(name: str) -> str:
    """The name of the bone, point or contact that mirrors this one: "LeftFoot" → "RightFoot",
    "thigh.L" → "thigh.R", "Left heel 2" → "Right heel 2". The same where it tells no side."""
    side = split_side(name)[0]
    if side is Side.MIDDLE:
        return name
    letter = side.value[0]
    begins, ends = r"(?<![^\W_])", r"(?![^\W_])"
    for pattern in (side.value, begins + letter + ends, begins + letter):
        found = re.search(pattern, name, re.IGNORECASE)
        if found:
            was = found[0]
            other = OTHER[was.lower()]
            spelt = other.upper() if was.isupper() else other
            spelt = spelt.capitalize() if was.istitle() else spelt
            return f"{name[: found.start()]}{spelt}{name[found.end() :]}"
    return name


def swapped(problem: MotionProblem) -> MotionProblem:
    """The problem with its pins and corrections on the other side's contacts, as a mirrored
    recording has them; places and directions stay. Twice is the problem itself."""
    return replace(
        problem,
        pins=tuple(_swapped_pin(pin) for pin in problem.pins),
        contacts=tuple(replace(c, name=other_side(c.name)) for c in problem.contacts),
        added=tuple(replace(a, point=other_side(a.point)) for a in problem.added),
    )


def _swapped_pin(pin: Pin) -> Pin:
    step = None if pin.step is None else other_side(pin.step)
    return replace(pin, touching=tuple(map(other_side, pin.touching)), step=step)


def mirrored(recording: Recording, first: float | None = None) -> Recording:
    """Reflected across the body's sagittal plane at a frame, the first by default: the performer
    with left and right swapped, lengths included, on bones that keep their names and rest axes.

    The plane is upright and goes through the middle between the sides. Twice is the recording
    itself. Raises NotMirrored where a bone has no partner on the other side.
    """
    partners = _partners(recording.bones)
    frame = 0 if first is None else int(np.searchsorted(recording.frames, first - 1e-6))
    at = recording.heads[min(frame, len(recording.frames) - 1)]
    plane = _Plane.through(at, partners, _level(_across(at, partners, recording.bones), at))
    heads = np.stack([bone.head for bone in recording.bones])
    rest_plane = _Plane.through(heads, partners, _rest_normal(recording.bones, partners))
    bones = tuple(
        replace(
            bone,
            head=rest_plane.reflected(recording.bones[partner].head),
            tail=rest_plane.reflected(recording.bones[partner].tail),
        )
        for bone, partner in zip(recording.bones, partners, strict=True)
    )
    rests = np.stack([bone.rotation for bone in recording.bones])
    turned = recording.rotations @ np.swapaxes(rests, 1, 2)  # from the rest, world axes
    rotations = plane.matrix @ turned[:, partners] @ rest_plane.matrix @ rests
    moved = plane.reflected(recording.heads[:, partners])
    known = tuple(
        replace(each, contacts=tuple((other_side(p), a, b) for p, a, b in each.contacts))
        for each in recording.known
    )
    return replace(recording, bones=bones, heads=moved, rotations=rotations, known=known)


@dataclass(frozen=True)
class _Plane:
    """All points p with p · normal = distance, m; normal (3,) unit."""

    normal: FloatArray
    distance: float

    @staticmethod
    def through(places: FloatArray, partners: Sequence[int], normal: FloatArray) -> _Plane:
        """Through the middle between bones at places (B, 3) and their partners."""
        sided = [i for i, other in enumerate(partners) if other != i]
        return _Plane(normal, float(places[sided].mean(axis=0) @ normal))

    @property
    def matrix(self) -> FloatArray:
        """(3, 3) reflection of directions."""
        return np.asarray(np.eye(3) - 2.0 * np.outer(self.normal, self.normal))

    def reflected(self, places: FloatArray) -> FloatArray:
        """Of places (..., 3) m."""
        return np.asarray(places @ self.matrix + 2.0 * self.distance * self.normal)


def _partners(bones: Sequence[Bone]) -> list[int]:
    """Of each bone the one that mirrors it; itself in the middle. Raises NotMirrored."""
    index = {bone.name: i for i, bone in enumerate(bones)}
    found = [index.get(other_side(bone.name), -1) for bone in bones]
    for i, bone in enumerate(bones):
        if found[i] == i and bone.name[0] in OTHER_LETTER:  # "LHipJoint", "lthumb": of no part
            found[i] = index.get(OTHER_LETTER[bone.name[0]] + bone.name[1:], i)
    for i, bone in enumerate(bones):
        above = found[bone.parent] if bone.parent >= 0 else -1
        if found[i] < 0 or bones[found[i]].parent != above:
            raise NotMirrored(bone.name, other_side(bone.name))
    if all(other == i for i, other in enumerate(found)):
        raise NotMirrored("", "")
    return found


def _across(places: FloatArray, partners: Sequence[int], bones: Sequence[Bone]) -> FloatArray:
    """(3,) mean vector from the right side to the left; places (B, 3) m."""
    left = [i for i, bone in enumerate(bones) if split_side(bone.name)[0] is Side.LEFT]
    others = [partners[i] for i in left]
    return np.asarray((places[left] - places[others]).mean(axis=0))


def _level(across: FloatArray, places: FloatArray) -> FloatArray:
    """(3,) unit, along the floor: across the body, or, where that lies on its side, across the way
    that it lies."""
    flat = across * (1.0, 1.0, 0.0)
    if np.linalg.norm(flat) < LEVEL * np.linalg.norm(across):
        spread = (places - places.mean(axis=0))[:, :2]
        long = np.linalg.eigh(spread.T @ spread)[1][:, -1]
        flat = np.array([-long[1], long[0], 0.0])
    return np.asarray(flat / np.linalg.norm(flat))


def _rest_normal(bones: Sequence[Bone], partners: Sequence[int]) -> FloatArray:
    """(3,) unit, across the rest pose; an axis where that is meant, for no rest is quite even."""
    across = _across(np.stack([bone.head for bone in bones]), partners, bones)
    across = across / np.linalg.norm(across)
    nearest = np.eye(3)[np.abs(across).argmax()]
    return nearest if abs(float(across @ nearest)) > NEAR_AXIS else across
