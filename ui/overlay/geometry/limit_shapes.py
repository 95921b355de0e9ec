"""Limits of joints as shapes, in the armature's space."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import degrees
from typing import NamedTuple

import numpy as np

from ....bridge.constraint_kinds import cone, joint_limit, twist_limit
from ....bridge.rows.times import Frames
from ....bridge.shapes.vectors import across, unit
from ....solver.arrays import FloatArray
from ....solver.body.human_limits import edge
from ...drawing.sketch import Colour
from . import arcs, limit_poses, palette
from .body_rotations import TracedFigure
from .limit_poses import Joints
from .shapes import Label, Look, Shape, Standing, faded, lines, merged, placed

CONE, ANGLE, TWIST = (kind.KIND.name for kind in (cone, joint_limit, twist_limit))
ARC, RING = 0.55, 0.42  # radii, as shares of the bone's length
RING_AT, RING_HOLE = 0.45, 0.62  # where along the bone a twist is drawn, and its hole
HAND = 1.1  # how much farther the line of the present angle reaches
BEYOND = 0.01  # rad, by how much a limit must be missed to be said
UNCHOSEN = 0.75  # opacity of those that are not chosen in the list
TEMPLATES = 256  # remembered at most


@dataclass(frozen=True)
class Pose:
    """The armature's bones, (N, 4, 4) by name: as they are posed, and at rest."""

    posed: Mapping[str, FloatArray]
    rest: Mapping[str, FloatArray]


class Limit(NamedTuple):
    """A limit of a bone's joint to its parent.

    lower, upper: rad, None where free; upper is a cone's half angle. axis: a cone's own in the
    armature's space, None for the mean in the recording.
    """

    kind: str
    bone: str
    parent_bone: str
    span: Frames
    standing: Standing
    chosen: bool
    length: float
    lower: float | None
    upper: float | None
    axis: tuple[float, float, float] | None = None
    stretch: tuple[float, float] = (1.0, 1.0)


def limit_shapes(
    limits: Iterable[Limit], figure: TracedFigure | None, pose: Pose
) -> Iterator[Shape | Label]:
    """figure: of the recording, which tells mean directions; None where there is none."""
    by_kind: dict[str, list[Limit]] = {}
    for limit in limits:
        by_kind.setdefault(limit.kind, []).append(limit)
    for kind, same in by_kind.items():
        _, measured = limit_frames(same, figure, pose)
        for limit, axes, origin in zip(same, measured.axes, measured.origins, strict=True):
            for shape in template(
                kind, limit.lower, limit.upper, limit.stretch, limit.length, colour_of(limit)
            ):
                yield placed(shape, axes, origin)
        yield from _present(same, measured)


@lru_cache(maxsize=TEMPLATES)
def template(
    kind: str,
    lower: float | None,
    upper: float | None,
    stretch: tuple[float, float],
    length: float,
    colour: Colour,
) -> tuple[Shape, ...]:
    """A limit in axes of its own; see arcs.py."""
    if kind == CONE:
        return merged(arcs.cone(upper or 0.0, stretch, length, colour))
    if kind == ANGLE:
        return merged(arcs.arc(lower, upper, ARC * length, colour))
    return merged(arcs.arc(lower, upper, RING * length, colour, RING_HOLE))


def colour_of(limit: Limit) -> Colour:
    if limit.standing is Standing.OFF:
        return palette.PIN_OFF
    strength = 1.0 if limit.chosen else UNCHOSEN
    return faded(palette.LIMIT, strength * limit.standing)


# ---------------------------------------------------------------- where they are


def limit_frames(
    limits: Sequence[Limit], figure: TracedFigure | None, pose: Pose
) -> tuple[Joints, limit_poses.LimitFrames]:
    """Limits of one kind: their joints, and the axes in which they are drawn."""
    joints = joints_of(limits, figure, pose)
    return joints, _SEEN[limits[0].kind](limits, joints, figure, pose)


def joints_of(limits: Sequence[Limit], figure: TracedFigure | None, pose: Pose) -> Joints:
    """The limits' joints as the armature is posed."""

    def rotations(matrices: Mapping[str, FloatArray], bones: Iterable[str]) -> FloatArray:
        return limit_poses.rotations(np.array([matrices[bone] for bone in bones]))

    bones, parents = zip(*((limit.bone, limit.parent_bone) for limit in limits), strict=True)
    rest = rotations(pose.rest, bones)
    along = rest[:, :, 1].copy()
    for k, bone in enumerate(bones):
        body = _body(bone, figure)
        if figure is not None and body is not None and body in figure.parents:
            along[k] = figure.along[body]
    return Joints(
        np.array([pose.posed[bone][:3, 3] for bone in bones]),
        rotations(pose.posed, parents) @ np.swapaxes(rotations(pose.rest, parents), 1, 2),
        rotations(pose.posed, bones) @ np.swapaxes(rest, 1, 2),
        along,
    )


def _body(bone: str, figure: TracedFigure | None) -> int | None:
    return figure.bones.index(bone) if figure is not None and bone in figure.bones else None


def _cones(
    limits: Sequence[Limit], joints: Joints, figure: TracedFigure | None, _pose: Pose
) -> limit_poses.LimitFrames:
    axis = joints.along.copy()
    for k, limit in enumerate(limits):
        body = _body(limit.bone, figure)
        if limit.axis is not None:
            axis[k] = limit.axis
        elif figure is not None and body is not None:
            axis[k] = figure.lean(body, *limit.span)
    axis = unit(axis)
    sideways = figure.sideways if figure is not None else np.array([1.0, 0.0, 0.0])
    side = sideways - axis * (axis @ sideways)[:, None]
    clear = (
        np.linalg.norm(side, axis=1, keepdims=True) > 0.3
    )  # as in solver/constraints/constraint_builder.py
    side = np.where(clear, unit(side), across(axis))
    return limit_poses.cones(joints, axis, side, np.array([limit.stretch for limit in limits]))


def _bends(
    limits: Sequence[Limit], joints: Joints, figure: TracedFigure | None, pose: Pose
) -> limit_poses.LimitFrames:
    rest = [(pose.rest[limit.bone], pose.rest[limit.parent_bone]) for limit in limits]
    straight = unit(np.array([own[:3, 3] - parent[:3, 3] for own, parent in rest]))
    flexion = np.full_like(straight, np.nan)
    for k, limit in enumerate(limits):
        body, above = _body(limit.bone, figure), _body(limit.parent_bone, figure)
        if figure is not None and body is not None and above is not None:
            straight[k], flexion[k] = figure.along[above], figure.flexion[body]
    return limit_poses.bends(joints, straight, flexion)


def _twists(
    limits: Sequence[Limit], joints: Joints, _figure: TracedFigure | None, _pose: Pose
) -> limit_poses.LimitFrames:
    return limit_poses.twists(joints, RING_AT * np.array([limit.length for limit in limits]))


_SEEN = {CONE: _cones, ANGLE: _bends, TWIST: _twists}


# ---------------------------------------------------------------- how it is now


def _present(limits: Sequence[Limit], measured: limit_poses.LimitFrames) -> Iterator[Shape | Label]:
    """A line where each limb is now, and the angle in words where it matters."""
    for look in (Look.THIN, Look.BOLD):
        pairs, colours = [], []
        for k, limit in enumerate(limits):
            missed = _missed(limit, measured, k)
            if limit.standing is not Standing.NOW or (look is Look.BOLD) != missed:
                continue
            tip = measured.origins[k] + HAND * _reach(limit) * measured.hands[k]
            pairs.append((measured.origins[k], tip))
            colours.append(palette.BEYOND if missed else palette.WITHIN)
            if limit.chosen or missed:
                yield Label(f"{round(degrees(measured.now[k]))}°", tuple(tip.tolist()), colours[-1])
        if pairs:
            yield lines(pairs, colours, look)


def _missed(limit: Limit, measured: limit_poses.LimitFrames, k: int) -> bool:
    now, upper = float(measured.now[k]), limit.upper
    if limit.kind == CONE and upper is not None:
        upper = float(edge(measured.narrow[k : k + 1], upper)[0])
    short = limit.lower is not None and now < limit.lower - BEYOND
    return short or (upper is not None and now > upper + BEYOND)


def _reach(limit: Limit) -> float:
    """Radius of a limit's shape."""
    return {CONE: 1.0, ANGLE: ARC, TWIST: RING}[limit.kind] * limit.length
