"""The body's flesh as its skinned mesh has it: how thick each body is, and where beside its bone.

Of each body's points those beside its axis, from joint to tip, are looked at around it. In each
direction the median distance counts, which hair, cloth and what a hand holds do not change, as long
as they are less than half of what is there. They are taken as an ellipse's: its middle is where
distances have no first harmonic, and from there 1 / distance^2 is a mean and a second harmonic.
"""

from dataclasses import dataclass

import numpy as np

from ..analysis.performance import Performance
from ..analysis.skin import skin_of_bodies
from ..arrays import FloatArray, IntArray
from ..body.character import Body, Character
from ..body.joint_choice import MIN_BONE_LENGTH
from ..body.mass_tables import BOX_ASPECT
from ..data.problem import MotionProblem
from ..data.recording import Recording, Skin
from ..data.solver_options import ShapeSource
from ..numerics.rotations import unit

MOST = 2.0  # times as thick as mass and length make it: flesh of a quarter of water's density
FEWEST = 30  # points that tell a body's shape
DIRECTIONS = 12  # in which distances are looked at
LEAST_SEEN = 7  # of the directions, in which there must be points: more than half around
FURTHEST = 0.98  # share of the points of a last body before which it ends
LEAST = 1e-4  # m, of a distance
ROUNDS = 3  # in which the middle of a section settles
UNEVEN = 0.1  # of its radius, by which a section must be wider to be more than round
FLATTEST = 0.8  # second harmonic over the mean: three times as wide as deep


@dataclass(frozen=True)
class Flesh:
    """A body's flesh: the points at most `radius` m from its axis, or wider than that.

    centre: (3,) m, of the axis beside the joint, in the body's frame. aside: (3,) m, from the axis
    to each of two that lie side by side where the body is wide; 0 of round ones. reach: how far
    the flesh goes beyond the joint, as a share of the way to the tip.
    """

    radius: float
    centre: FloatArray
    aside: FloatArray
    reach: float = 1.0


def flesh_of(skin: Skin | None, recording: Recording, character: Character) -> dict[int, Flesh]:
    """By bodies' indices, of those on which there is skin enough to tell.

    recording: what the character was built from; its rest pose is the skin's.
    """
    if skin is None:
        return {}
    points = skin_of_bodies(skin, recording, character)
    leaves = set(range(len(character.bodies))) - {joint.parent for joint in character.joints}
    found = {}
    for i, body in enumerate(character.bodies):
        flesh = _fitted(body, points[i], leaf=i in leaves)
        if flesh is not None:
            found[i] = flesh
    return found


def shape_flesh(problem: MotionProblem, performance: Performance) -> dict[int, Flesh]:
    """What a problem's shapes are made from beside bones, on the performance's character."""
    if problem.requests.solution.shapes is ShapeSource.BONES:
        return {}
    return flesh_of(problem.skin, performance.recording, performance.character)


def _fitted(body: Body, points: FloatArray, *, leaf: bool) -> Flesh | None:
    """From points (N, 3) m in the body's frame; None where these are too few, or not around it."""
    length = float(np.linalg.norm(body.tip))
    if length < MIN_BONE_LENGTH or len(points) < FEWEST:
        return None
    along = points @ unit(body.tip) / length
    reach = 1.0
    if leaf:
        reach = float(np.quantile(np.minimum(along, MOST), FURTHEST))
    beside = (along >= 0.0) & (along <= reach)
    if reach <= 0.0 or np.count_nonzero(beside) < FEWEST:
        return None
    across = body.box_rotation[:, :2]
    flat = points[beside] @ across
    wide, deep = body.box_size[:2]
    most = MOST * float(np.sqrt(wide * deep / np.pi))  # of the circle of the box's area
    section = _section(flat, most)
    if section is None:
        return None
    if np.linalg.norm(section.middle) > section.half_width:
        return None  # the bone is not in it: a load beside it, no flesh
    apart = section.half_width - section.half_depth
    centre = across @ section.middle
    if BOX_ASPECT.get(body.part, 1.0) == 1.0 or apart < UNEVEN * section.half_depth:
        mean = float(np.sqrt(section.half_width * section.half_depth))
        return Flesh(mean, centre, np.zeros(3), reach)
    return Flesh(section.half_depth, centre, apart * (across @ section.way), reach)


@dataclass(frozen=True)
class _Section:
    """An ellipse: its middle (2,) m, the unit vector (2,) along its width, and its half axes, m."""

    middle: FloatArray
    way: FloatArray
    half_width: float
    half_depth: float


def _section(flat: FloatArray, most: float) -> _Section | None:
    """Of points (N, 2) m from the bone; None where these are not around anything.

    most: m, beyond which distances do not count as more.
    """
    centre = np.median(flat, axis=0)
    for _ in range(ROUNDS):
        apart = flat - centre
        turn = np.arctan2(apart[:, 1], apart[:, 0]) / (2.0 * np.pi) * DIRECTIONS
        directions = np.floor(turn).astype(int) % DIRECTIONS
        seen, far = _medians(directions, np.minimum(np.linalg.norm(apart, axis=1), most))
        if len(seen) < LEAST_SEEN:
            return None
        angle = (seen + 0.5) * 2.0 * np.pi / DIRECTIONS
        waves = [np.ones_like(angle), *(f(n * angle) for n in (1, 2) for f in (np.cos, np.sin))]
        _, x, y, _, _ = np.linalg.lstsq(np.stack(waves, axis=1), far, rcond=None)[0]
        centre = centre + np.array([x, y])
    even = np.stack([waves[0], *waves[3:]], axis=1)
    mean, c, s = np.linalg.lstsq(even, 1.0 / np.maximum(far, LEAST) ** 2, rcond=None)[0]
    if mean <= 0.0:
        return None
    wave, way = min(np.hypot(c, s), FLATTEST * mean), 0.5 * np.arctan2(-s, -c)
    along = np.array([np.cos(way), np.sin(way)])
    return _Section(centre, along, float((mean - wave) ** -0.5), float((mean + wave) ** -0.5))


def _medians(groups: IntArray, values: FloatArray) -> tuple[IntArray, FloatArray]:
    """The groups (N,) that there are (G,), and the median of values (N,) of each."""
    order = np.lexsort((values, groups))
    seen, first, count = np.unique(groups[order], return_index=True, return_counts=True)
    return seen, values[order][first + count // 2]
