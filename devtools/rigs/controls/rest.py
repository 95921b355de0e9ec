"""The rig laid out as Auto-Rig Pro's at rest, as auto_rig_pro.toml has its bones; without Blender.

Knees and elbows rest a little bent, as that add-on wants them, so that inverse kinematics knows
where they go.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....solver.arrays import FloatArray
from ....solver.data.recording import Bone
from ....solver.numerics.rotations import rotation_matrix, unit
from ..actor import JOINTS, Actor
from ..layout import GROUND, Layout, Placed, read_layout
from ..rest import centres_of, heads_on

FILE = Path(__file__).with_name("auto_rig_pro.toml")
HINGES = (("upper_arm", "forearm", "hand"), ("thigh", "shank", "foot"))
KNEE, ELBOW = np.radians(8.0), np.radians(15.0)
POLE = 0.5  # m, from a knee or an elbow to its pole
SHORTEST = 0.04  # m, of a bone
UPWARDS = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class AtRest:
    """Joint centres (J, 3), turns from the actor's rest (J, 3, 3), and the frames of the bones at
    each joint (J, 3, 3), bone to world: Y along the bone, X where its limb bends."""

    layout: Layout
    centres: FloatArray
    turns: FloatArray
    frames: FloatArray

    @property
    def placed(self) -> tuple[Placed, ...]:
        """What the file tells of the bones."""
        return self.layout.bones

    def bones(self, actor: Actor) -> tuple[Bone, ...]:
        """The bones; world, m."""
        index = {bone.name: i for i, bone in enumerate(self.placed)}
        heads, found = heads_on(self.placed, actor, self.centres, self.turns), []
        for head, bone in zip(heads, self.placed, strict=True):
            parent = index[bone.parent] if bone.parent is not None else -1
            frame, length = np.eye(3), 2.0 * POLE
            if bone.joint != GROUND:
                j = JOINTS.index(bone.joint)
                frame, whole = self.frames[j], np.linalg.norm(actor.end(bone.joint) - actor.rest[j])
                length = max(float(whole) * (1.0 - bone.share % 1.0), SHORTEST)
                if is_pole(bone):
                    head = self.centres[j] + POLE * frame[:, 0]
            found.append(Bone(bone.name, parent, head, head + length * frame[:, 1], frame))
        return tuple(found)


def at_rest(actor: Actor) -> AtRest:
    """Arms in an A pose, knees and elbows a little bent."""
    ahead = unit((actor.end("foot.l") - actor.at("foot.l")) * [1.0, 1.0, 0.0])
    turns = actor.lowered()
    for side in "lr":
        _turn(turns, side, np.cross(-UPWARDS, ahead), {"thigh": KNEE, "shank": -KNEE})
        j = JOINTS.index(f"upper_arm.{side}")
        along = turns[j] @ (actor.end(f"upper_arm.{side}") - actor.rest[j])
        hinge = unit(np.cross(along, ahead))
        _turn(turns, side, hinge, {"upper_arm": -ELBOW / 2.0, "forearm": ELBOW, "hand": ELBOW})
    centres = centres_of(actor, turns)
    frames = [
        _frame(joint, actor, turns[j], _aside(joint, centres, ahead))
        for j, joint in enumerate(JOINTS)
    ]
    return AtRest(read_layout(FILE), centres, turns, np.stack(frames))


def deform_bones() -> tuple[str, ...]:
    """Names of the bones that move the skin."""
    words = tomllib.loads(FILE.read_text(encoding="utf-8"))["deform"].split()
    return tuple(dict.fromkeys(word.format(s=side) for word in words for side in "lr"))


def is_pole(bone: Placed) -> bool:
    """Whether a bone is a pole, which stands off its joint."""
    return "_pole" in bone.name


def bend(first: FloatArray, middle: FloatArray, last: FloatArray) -> FloatArray:
    """(..., 3) from the line between a limb's ends to its middle joint."""
    line, arm = unit(last - first), middle - first
    return np.asarray(arm - (arm * line).sum(-1, keepdims=True) * line)


def _turn(turns: FloatArray, side: str, axis: FloatArray, by: dict[str, float]) -> None:
    for joint, angle in by.items():
        j = JOINTS.index(f"{joint}.{side}")
        turns[j] = rotation_matrix(angle * axis) @ turns[j]


def _aside(joint: str, centres: FloatArray, ahead: FloatArray) -> FloatArray:
    """(3,) where the X axis of a joint's bones leads: a limb's where its knee or elbow points."""
    name, _, side = joint.partition(".")
    if name in ("foot", "toe"):
        return UPWARDS
    limb = next((limb for limb in HINGES if name in limb), None)
    if limb is None:
        return ahead
    first, middle, last = (centres[JOINTS.index(f"{each}.{side}")] for each in limb)
    return unit(bend(first, middle, last))


def _frame(joint: str, actor: Actor, turn: FloatArray, aside: FloatArray) -> FloatArray:
    """(3, 3) of a joint's bones, X where it says."""
    span = actor.end(joint) - actor.at(joint)  # none where two joints are at one place
    along = unit(turn @ span) if np.linalg.norm(span) > SHORTEST else UPWARDS
    x = unit(aside - (aside @ along) * along)
    return np.stack([x, along, np.cross(x, along)], axis=1)
