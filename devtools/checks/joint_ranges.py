"""How far joints of a written action go beyond both the human range and the recording's own.

Angles are taken here, from the bones' rotations; only the ranges themselves are the solver's.
"""

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.body.anatomy import Part, Side
from ...solver.body.character import Character
from ...solver.body.human_limits import (
    BendRange,
    ConeRange,
    JointRange,
    RestFigure,
    human_ranges,
)
from ...solver.data.recording import Recording
from ...solver.numerics.rotations import perpendicular, unit

LEAST_BEND = 0.05  # sine, below which a joint does not tell in which direction it bends
LEAST_ACROSS = 0.3  # of the left, across a cone's axis, for it to tell the cone's sides


@dataclass(frozen=True)
class JointExcess:
    """The joint that is furthest beyond its range: degrees, which range, and the scene frame."""

    degrees: float
    joint: str
    frame: float


def worst_joint(shown: Recording, recorded: Recording, character: Character) -> JointExcess:
    """Over every frame and joint. recorded: what widens the ranges; both of the same bones."""
    figure = rest_figure(character)
    worst = JointExcess(0.0, "", float(shown.frames[0]))
    for limit in human_ranges(figure):
        over = excess(
            limit, figure, *(directions(r, limit.bone, figure) for r in (shown, recorded))
        )
        frame = int(over.argmax())
        if over[frame] > np.radians(worst.degrees):
            found = float(np.degrees(over[frame]))
            worst = JointExcess(found, limit.name, float(shown.frames[frame]))
    return worst


def rest_figure(character: Character) -> RestFigure:
    """A character's rest pose, world axes."""
    bodies, joints = character.bodies, character.joints
    parts: dict[tuple[Part, Side], tuple[str, ...]] = {}
    for body in bodies:
        key = body.part, body.side
        parts[key] = (*parts.get(key, ()), body.bone)
    sides = [character.body(Part.THIGH, side) for side in (Side.LEFT, Side.RIGHT)]
    left, right = (joints[side].offset for side in sides if side is not None)
    return RestFigure(
        parts,
        {
            b.bone: bodies[j.parent].bone
            for b, j in zip(bodies, joints, strict=True)
            if j.parent >= 0
        },
        {body.bone: unit(body.tip) for body in bodies},
        unit((left - right) * [1.0, 1.0, 0.0]),
    )


def directions(shown: Recording, bone: str, figure: RestFigure) -> FloatArray:
    """(T, 3) where a bone points, in its parent's frame, whose axes at rest are the world's."""
    own, parent = (_turns(shown, name) for name in (bone, figure.parents[bone]))
    return np.asarray(np.einsum("tji,tj->ti", parent, own @ figure.along[bone]))


def _turns(shown: Recording, bone: str) -> FloatArray:
    """(T, 3, 3) how a bone is turned from its rest pose."""
    b = shown.index(bone)
    return np.asarray(shown.rotations[:, b] @ shown.bones[b].rotation.T)


def excess(
    limit: JointRange, figure: RestFigure, now: FloatArray, recorded: FloatArray
) -> FloatArray:
    """(T,) rad beyond the range and the recording's. now, recorded: (T, 3), (R, 3) directions."""
    if isinstance(limit, ConeRange):
        return _beyond_cone(limit, figure, now, recorded)
    return _beyond_bend(limit, figure, now, recorded)


def _beyond_bend(
    limit: BendRange, figure: RestFigure, now: FloatArray, recorded: FloatArray
) -> FloatArray:
    straight = figure.along[figure.parents[limit.bone]]
    across = recorded.mean(axis=0)
    across = across - straight * (across @ straight)
    if np.linalg.norm(across) < LEAST_BEND:
        return np.zeros(len(now))
    bends = [np.arctan2(each @ unit(across), each @ straight) for each in (now, recorded)]
    lower, upper = min(limit.lower, bends[1].min()), max(limit.upper, bends[1].max())
    return np.asarray(np.maximum(np.maximum(lower - bends[0], bends[0] - upper), 0.0))


def _beyond_cone(
    limit: ConeRange, figure: RestFigure, now: FloatArray, recorded: FloatArray
) -> FloatArray:
    """A stretched cone is as wide as its stretch says where the bone leans: degrees stay true."""
    lean, share = _lean(limit, figure, now)
    widest = _narrowed(*_lean(limit, figure, recorded)).max()
    widest = max(limit.half_angle, float(widest))
    allowed = np.arctan2(np.sin(widest), share * np.cos(widest))
    return np.asarray(np.maximum(lean - allowed, 0.0))


def _narrowed(lean: FloatArray, share: FloatArray) -> FloatArray:
    return np.asarray(np.arctan2(share * np.sin(lean), np.cos(lean)))


def _lean(limit: ConeRange, figure: RestFigure, now: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(T,) rad from a cone's axis; (T,) what its tangent counts, where the cone is stretched."""
    side = figure.left - limit.axis * (figure.left @ limit.axis)
    side = unit(side) if np.linalg.norm(side) > LEAST_ACROSS else perpendicular(limit.axis)
    across = now @ np.stack([side, np.cross(limit.axis, side)]).T
    length = np.linalg.norm(across, axis=1)
    narrowed = np.linalg.norm(across / np.array(limit.stretch), axis=1)
    share = narrowed / np.maximum(length, 1e-12)
    return np.arctan2(length, now @ limit.axis), np.where(length > 1e-12, share, 1.0)
