"""The performer of the jump: joint centres and the turns of the bodies between them.

What every rig has: hips, knees, ankles, balls of the feet, three joints of the spine, a neck, a
head, clavicles, shoulders, elbows, wrists. The recording's other joints are held as at rest.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.recording import BEYOND, Recording
from ...solver.numerics.rotations import axis_rotation, unit
from ..figures.clips import CLIPS, RATE
from ..recordings import read

CLIP = CLIPS[0]
SIDES = {"l": "Left", "r": "Right"}
# joint: bone of the recording, and the joint above
_MIDDLE = {
    "pelvis": ("Hips", None),
    "spine1": ("LowerBack", "pelvis"),
    "spine2": ("Spine", "spine1"),
    "spine3": ("Spine1", "spine2"),
    "neck": ("Neck", "spine3"),
    "head": ("Head", "neck"),
}
_SIDED = {
    "clavicle": ("Shoulder", "spine3"),
    "upper_arm": ("Arm", "clavicle"),
    "forearm": ("ForeArm", "upper_arm"),
    "hand": ("Hand", "forearm"),
    "thigh": ("UpLeg", "pelvis"),
    "shank": ("Leg", "thigh"),
    "foot": ("Foot", "shank"),
    "toe": ("ToeBase", "foot"),
}
_NEXT = {"pelvis": "spine1", "spine1": "spine2", "spine2": "spine3", "spine3": "neck"}
_NEXT |= {"neck": "head", "clavicle": "upper_arm", "upper_arm": "forearm", "forearm": "hand"}
_NEXT |= {"thigh": "shank", "shank": "foot", "foot": "toe"}
JOINTS = (*_MIDDLE, *(f"{joint}.{side}" for joint in _SIDED for side in SIDES))
LOWERED = np.radians(45.0)  # arms in an A pose
HEAD_M, HAND_M = 0.22, 0.18  # beyond the last joints, as of people of that stature
TOE_M = 0.067  # as recorded


@dataclass(frozen=True)
class Actor:
    """Joints J (JOINTS) at T frames; world, m, Z up; the rest pose is a T pose.

    frames: (T,) scene frames. heads: (T, J, 3). turns: (T, J, 3, 3) from rest. rest: (J, 3).
    parents: (J,) indices.
    """

    frames: FloatArray
    heads: FloatArray
    turns: FloatArray
    rest: FloatArray
    parents: tuple[int, ...]

    def end(self, joint: str) -> FloatArray:
        """(3,) where the body of a joint ends at rest: at the next joint, or a tip."""
        name, _, side = joint.partition(".")
        if name in _NEXT:
            following = _NEXT[name]
            return self.at(f"{following}.{side}" if following in _SIDED else following)
        here = self.at(joint)
        if name == "head":
            return np.asarray(here + np.array([0.0, 0.0, HEAD_M]))
        along = here - self.rest[self.parents[JOINTS.index(joint)]]
        if name == "hand":
            return np.asarray(here + HAND_M * unit(along))
        return np.asarray(here + TOE_M * unit(along * [1.0, 1.0, 0.0]))

    def part(self, first: float, last: float, every: int) -> Actor:
        """The frames from the first to the last, one in `every` of them, counted from 1."""
        rows = np.flatnonzero((self.frames >= first) & (self.frames <= last))[::every]
        frames = np.arange(1.0, len(rows) + 1.0)
        return replace(self, frames=frames, heads=self.heads[rows], turns=self.turns[rows])

    def at(self, joint: str) -> FloatArray:
        """(3,) a joint's rest position."""
        return np.asarray(self.rest[JOINTS.index(joint)])

    def lowered(self) -> FloatArray:
        """(J, 3, 3) turns from rest that lower the arms into an A pose."""
        turns = np.tile(np.eye(3), (len(JOINTS), 1, 1))
        for side, sign in (("l", 1.0), ("r", -1.0)):
            across = self.at("upper_arm.l") - self.at("upper_arm.r")
            # The Y axis is ahead or behind: whichever, the outer end goes down.
            down = axis_rotation(1, np.array([np.sign(across[0]) * sign * LOWERED]))[0]
            for joint in ("upper_arm", "forearm", "hand"):
                turns[JOINTS.index(f"{joint}.{side}")] = down
        return turns


@cache
def actor() -> Actor:
    """The jump of the figures, and half a second around it. Raises SetUpError."""
    whole = read(CLIP.path)
    first, last = CLIP.frames
    return acting(whole, whole.window(first - BEYOND * RATE, last + BEYOND * RATE))


def acting(whole: Recording, recording: Recording) -> Actor:
    """Some frames of a recording whose bones are named as the jump's."""
    bones = [whole.index(_bone(joint)) for joint in JOINTS]
    parents = tuple(map(_parent, JOINTS))
    rest = np.stack([whole.bones[b].head for b in bones])
    base = np.stack([whole.bones[b].rotation for b in bones])
    turns = recording.rotations[:, bones] @ np.swapaxes(base, -1, -2)
    return Actor(recording.frames, _heads(recording, turns, rest, parents), turns, rest, parents)


def _heads(
    recording: Recording, turns: FloatArray, rest: FloatArray, parents: tuple[int, ...]
) -> FloatArray:
    """(T, J, 3) by forward kinematics, from the recorded hips."""
    heads = np.zeros((len(turns), len(JOINTS), 3))
    heads[:, 0] = recording.heads[:, recording.index("Hips")]
    for j, parent in enumerate(parents):
        if parent >= 0:
            heads[:, j] = heads[:, parent] + turns[:, parent] @ (rest[j] - rest[parent])
    return heads


def _bone(joint: str) -> str:
    name, _, side = joint.partition(".")
    return f"{SIDES[side]}{_SIDED[name][0]}" if side else _MIDDLE[name][0]


def _parent(joint: str) -> int:
    name, _, side = joint.partition(".")
    above = (_SIDED[name] if side else _MIDDLE[name])[1]
    if above is None:
        return -1
    return JOINTS.index(f"{above}.{side}" if above in _SIDED else above)
