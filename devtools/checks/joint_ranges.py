"""How far joints of a written action go beyond both the human range and the recording's own.

The ranges, and the vectors that each of their angles is about, are the solver's; the angles are
taken here, from the bones' rotations, by formulas of their own.
"""

from dataclasses import dataclass

import numpy as np

from ...solver.analysis.performance import Performance
from ...solver.arrays import FloatArray
from ...solver.body.character import Character
from ...solver.data.recording import Recording
from ...solver.human.ranges import JointRange, joint_ranges
from ...solver.numerics.rotations import perpendicular
from ...solver.transcription.joint_measures import (
    BendAngle,
    ConeAngle,
    JointMeasure,
    SideAngle,
    TwistAngle,
)

TURN = 2.0 * np.pi


@dataclass(frozen=True)
class JointExcess:
    """The joint that is furthest beyond its range: degrees, which range, and the scene frame."""

    degrees: float
    joint: str
    frame: float


def worst_joint(shown: Recording, performance: Performance) -> JointExcess:
    """Over every frame and joint of what Blender shows. performance: what widens the ranges, and
    tells the way that joints bend; of the same bones."""
    character = performance.character
    worst = JointExcess(0.0, "", float(shown.frames[0]))
    for limit in joint_ranges(character, performance.angles):
        turns = (turned(r, character, limit.body) for r in (shown, performance.recording))
        over = excess(limit, *turns)
        frame = int(over.argmax())
        if over[frame] > np.radians(worst.degrees):
            degrees = float(np.degrees(over[frame]))
            worst = JointExcess(degrees, limit.name, float(shown.frames[frame]))
    return worst


def turned(shown: Recording, character: Character, body: int) -> FloatArray:
    """(T, 3, 3) a body's frame to its parent's; both are the world's in the rest pose."""
    pair = (character.bodies[character.joints[body].parent].bone, character.bodies[body].bone)
    parent, own = (
        shown.rotations[:, b] @ shown.bones[b].rotation.T for b in map(shown.index, pair)
    )
    return np.asarray(np.swapaxes(parent, 1, 2) @ own)


def excess(limit: JointRange, now: FloatArray, recorded: FloatArray) -> FloatArray:
    """(T,) rad beyond the range and the recording's. now, recorded: (T, 3, 3), (R, 3, 3)."""
    if isinstance(limit.measure, ConeAngle):
        after, allowed = (outside(limit.measure, limit.upper, R) for R in (now, recorded))
        return np.asarray(np.maximum(after - max(allowed.max(), 0.0), 0.0))
    found, before = (angles(limit.measure, R) for R in (now, recorded))
    if isinstance(limit.measure, TwistAngle):  # may have gone round; the nearest turn counts
        middle = 0.5 * (limit.lower + limit.upper)
        found, before = (middle + (a - middle + np.pi) % TURN - np.pi for a in (found, before))
    lower, upper = min(limit.lower, before.min()), max(limit.upper, before.max())
    return np.asarray(np.maximum(np.maximum(lower - found, found - upper), 0.0))


def outside(cone: ConeAngle, half: float, R: FloatArray) -> FloatArray:
    """(T,) rad from the cone's edge outwards, in the plane of the axis and the bone."""
    axis, *across = cone.frame
    along = R @ cone.along
    sides = [along @ side for side in across]
    whole, squeezed = np.hypot(*sides), np.hypot(*(sides / cone.stretch[:, None]))
    from_axis = np.arccos(np.clip(along @ axis, -1.0, 1.0))
    return np.asarray(from_axis - np.arctan2(whole * np.sin(half), squeezed * np.cos(half)))


def angles(measure: JointMeasure, R: FloatArray) -> FloatArray:
    """(T,) rad of rotations (T, 3, 3), child to parent, about what is no cone's axis."""
    match measure:
        case BendAngle():
            along = R @ measure.along
            ahead = along @ measure.straight + 1j * (along @ measure.flexion)
            return np.asarray(np.angle(ahead))
        case SideAngle():
            off = R @ measure.along @ measure.normal
            return np.asarray(np.pi / 2.0 - np.arccos(np.clip(off, -1.0, 1.0)))
        case TwistAngle():
            return _twist(measure.along, R @ measure.zero.T)
    raise TypeError(measure)


def _twist(axis: FloatArray, R: FloatArray) -> FloatArray:
    """(T,) rad that R (T, 3, 3) turns about axis (3,) beside the least turn that carries the axis
    to where R does (Rodrigues)."""
    to = R @ axis
    across = np.cross(axis, to)
    aside = perpendicular(axis)
    share = across @ aside / np.maximum(1.0 + to @ axis, 1e-12)
    carried = (to @ axis)[:, None] * aside + np.cross(across, aside) + share[:, None] * across
    arrived = R @ aside
    sine = np.einsum("ti,ti->t", np.cross(carried, arrived), to)
    return np.asarray(np.arctan2(sine, np.einsum("ti,ti->t", carried, arrived)))
