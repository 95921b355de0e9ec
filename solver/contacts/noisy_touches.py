"""Touches of a foot that noise parts: video capture errs in the body's place by centimetres, to and
fro within tenths of a second, so that feet which stand seem to step."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.contacts import Contact, PointKind
from ..scene.support import Heights
from .point_movement import MAX_SLIDE, PointMovement

MAX_BREAK = 0.12  # s; a foot cannot leave its place and come back in less
BREAK_WINDOW = 0.2  # s, on either side of a break, over which a place is the mean
FARTHER = 1.5  # times what feet move by alike, as the turns of each leg are noisy, too


@dataclass(frozen=True)
class _Break:
    """Of the contact of a foot that stays low. after: the touch that goes on. moved: (2,) m, level,
    of its point meanwhile. alike: whether the other foot stays low, too, and moves with it."""

    after: Contact
    moved: FloatArray
    alike: bool


def joined_over_noise(
    clock: FloatArray,
    touches: Sequence[Contact],
    feet: Mapping[str, PointMovement],
    ground: Heights,
) -> list[Contact]:
    """The touches, those of a foot's point that noise parts as one. clock: (N,) s, of the feet.

    Feet that stand move alike then, which feet that step do not, and once the other way, which feet
    that slide do not. So far, noise may have moved one that stands alone.
    """
    breaks = list(_breaks(clock, touches, feet, ground))
    shifts = np.array([b.moved for b in breaks if b.alike]).reshape(-1, 2)
    if not (shifts @ shifts.T < 0.0).any():
        return list(touches)
    farthest = np.linalg.norm(shifts, axis=1).max()
    parted = {id(b.after) for b in breaks if np.linalg.norm(b.moved) <= FARTHER * farthest}
    joined: list[Contact] = []
    for touch in sorted(touches, key=lambda t: (t.point, t.start)):
        if id(touch) not in parted:
            joined.append(touch)
            continue
        before = joined[-1]
        end = max(before.end, touch.end)
        during = (clock >= before.start) & (clock <= end)
        place = np.median(feet[touch.point].point[during], axis=0)
        joined[-1] = replace(before, end=end, place=place)
    return joined


def _breaks(
    clock: FloatArray,
    touches: Iterable[Contact],
    feet: Mapping[str, PointMovement],
    ground: Heights,
) -> Iterable[_Break]:
    """Where a foot's point touches again sooner than a foot can, and its foot stays low."""
    for one, other in pairwise(sorted(touches, key=lambda t: (t.point, t.start))):
        if one.point != other.point or other.start - one.end >= MAX_BREAK or one.point not in feet:
            continue
        before = (clock > one.end - BREAK_WINDOW) & (clock <= one.end)
        after = (clock >= other.start) & (clock < other.start + BREAK_WINDOW)
        moved = {
            name: (foot.track[after].mean(axis=0) - foot.track[before].mean(axis=0))[:2]
            for name, foot in feet.items()
        }
        side = one.point.split()[0]
        own = [name for name in feet if name.split()[0] == side]
        across = [name for name in feet if name not in own]
        near = (np.linalg.norm(moved[name] - moved[one.point]) for name in across)
        between = (clock >= min(one.end, other.start)) & (clock <= max(one.end, other.start))
        if _low([feet[name] for name in own], clock, between, ground):
            alike = bool(min(near, default=np.inf) < MAX_SLIDE)
            beside = _low([feet[name] for name in across], clock, before | between | after, ground)
            yield _Break(other, moved[one.point], alike and beside)


def _low(
    foot: Iterable[PointMovement], clock: FloatArray, during: BoolArray, ground: Heights
) -> bool:
    """Whether some point of a foot is as low as a toe that touches, at each of some instants."""
    heights = [f.track[during, 2] - ground(clock, f.track)[during] for f in foot]
    return bool(heights) and bool((np.min(heights, axis=0) < PointKind.TOE.value.max_height).all())
