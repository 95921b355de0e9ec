"""Hips whose height was left out, as exports “in place” may have it, and capture by video that
tells all places from the hips."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...analysis.performance import Performance, contact_points, perform
from ...analysis.soles import ANKLE_HEIGHT, BALL_HEIGHT, USUAL_SHOE
from ...arrays import FloatArray
from ...body.anatomy import Part
from ...body.character import build_character
from ...data.constants import UP
from ...data.problem import Mend
from ...data.recording import Recording
from ...skeleton.parts import SIDES
from ..figure import Figure, figure_of
from ..finding import Finding, FindingKind
from ..repairs import Repairs
from .arcs import with_arcs
from .flat_feet import foot_ends

# Of the way from hips to foot by the bones. Honest hips rise by 0.06 of it in a walk, as feet do
# below them; whoever sits has them at half of it.
LEVEL, STEPS, STANDS = 0.002, 0.05, 0.7


def find_level_hips(recording: Recording, figure: Figure) -> Finding | None:
    """Hips that keep one height above legs that stretch and bend: their rise was left out. Those of
    who sits or lies are lower. recording: upright."""
    hips, feet = figure.bones[0], figure.of(Part.FOOT)
    lowest = recording.heads[:, feet, 2].min(axis=1)
    leg, reach = _leg(recording, figure), recording.heads[:, hips, 2] - lowest
    if not _are_level(recording, figure) or np.median(reach) < STANDS * leg:
        return None
    if np.ptp(reach) < STEPS * leg:
        return None
    bent = 100.0 * float(np.ptp(reach) / leg)
    remedy = Repairs(mend=(Mend.LEVEL_HIPS,))
    return Finding(FindingKind.LEVEL_HIPS, bent, "%", remedy=remedy)


def _are_level(recording: Recording, figure: Figure) -> bool:
    heights = recording.heads[:, figure.bones[0], 2]
    return bool(np.ptp(heights) < LEVEL * _leg(recording, figure))


def _leg(recording: Recording, figure: Figure) -> float:
    """M, from the hips over the bones above a foot to it, however they lie at rest; the longer."""
    return max(_way_up(recording, foot, figure.bones[0]) for foot in figure.of(Part.FOOT))


def _way_up(recording: Recording, bone: int, hips: int) -> float:
    bones, length = recording.bones, 0.0
    while bone != hips and (parent := bones[bone].parent) >= 0:
        length += float(np.linalg.norm(bones[bone].head - bones[parent].head))
        bone = parent
    return length


def with_its_height(recording: Recording, chosen: Mapping[str, str] | None) -> Recording:
    """With the height over one floor at which the body stands, and falls, where the hips are level;
    else as it is. recording: in its right size and time. chosen: bones by parts of the body. Raises
    MissingPart.

    Twice, as soles are told by feet that stand at one height: first by those that persons have.
    """
    figure = figure_of(recording, chosen)
    if not _are_level(recording, figure):
        return recording
    middle = float(np.median(recording.heads[:, figure.bones[0], 2]))
    for lowest in (_lowest_joint, _lowest_point):
        performance = perform(recording, build_character(recording, chosen=chosen))
        com = performance.com[:, 2]
        lift = with_arcs(com - lowest(performance, figure), recording.rate) - com
        recording = replace(recording, heads=recording.heads + lift[:, None, None] * UP)
    away = middle - float(np.median(recording.heads[:, figure.bones[0], 2]))
    return replace(recording, heads=recording.heads + away * UP)  # the floor is where it was


def _lowest_joint(performance: Performance, figure: Figure) -> FloatArray:
    """(T,) m, of the feet, less what is usually below it."""
    height, lowest = performance.character.height, list[FloatArray]()
    for side in SIDES:
        ends = foot_ends(performance.recording, figure, side)
        for end, sole in zip(ends, (ANKLE_HEIGHT, BALL_HEIGHT), strict=True):
            lowest.append(end[:, 2] - sole * height - USUAL_SHOE)
    return np.asarray(np.min(lowest, axis=0))


def _lowest_point(performance: Performance, _: Figure) -> FloatArray:
    """(T,) m, of what may touch the ground, hands too."""
    points, _floor = contact_points(performance)
    return np.asarray(np.min([point.track[:, 2] for point in points.values()], axis=0))
