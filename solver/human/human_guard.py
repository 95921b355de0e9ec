"""The human guard of one adaptation: which joints a motion takes beyond their range, and its rows.

Never tighter than the recording: where its fit takes a joint beyond the human range, that is the
range.
"""

from collections.abc import Set
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, radians

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.row_kinds import RowKind
from ..transcription.constraint import DenseViolation
from ..transcription.guard_rows import GuardRows, chosen, named
from ..transcription.motion import LastMotion, Motion
from ..transcription.sampling import Channel, ChannelJacobian, State
from .ranges import JointRange, joint_ranges

SPACING = 0.008  # s, of the dense grid; joint angles are smooth
ROW_SPACING = 0.032  # s, between rows of a joint that stays beyond its range for longer
MOST_NEW = radians(0.25)  # beyond the range, that gets no row; no one sees it
# At any instant: between those of the dense grid an angle that accelerates by 200 rad/s², as a
# runner's knee does, goes on by an eighth of that times the spacing squared.
MOST_BEYOND = MOST_NEW + 200.0 * SPACING**2 / 8.0
RANGE_SAMPLES = 200  # instants that tell the way joints bend


@dataclass(frozen=True)
class BeyondRange:
    """Joints beyond their range: items (M,), times (M,) s, over (M,) rad; upper: (M,) which end."""

    items: IntArray
    times: FloatArray
    over: FloatArray
    upper: BoolArray

    def some(self, which: IntArray | BoolArray) -> "BeyondRange":
        """Some of them."""
        return BeyondRange(
            self.items[which], self.times[which], self.over[which], self.upper[which]
        )

    def worst(self, names: tuple[str, ...]) -> list[DenseViolation]:
        """The worst of each item, worst first. names: of the items."""
        found: dict[str, DenseViolation] = {}
        for i in np.argsort(-self.over).tolist():
            name, over, time = names[self.items[i]], float(self.over[i]), float(self.times[i])
            found.setdefault(name, DenseViolation(name, RowKind.RANGE, over, time))
        return list(found.values())


@dataclass(frozen=True)
class RangeLeft:
    """What is left of ranges, rad, below 0 beyond: of items (U,), at the end `upper` (U,) tells."""

    ranges: tuple[JointRange, ...]
    items: IntArray
    upper: BoolArray
    kind: RowKind = RowKind.RANGE

    def some(self, which: BoolArray) -> "RangeLeft":
        """Of some of the rows (U,)."""
        return replace(self, items=self.items[which], upper=self.upper[which])

    def value(self, state: State) -> FloatArray:
        """(U, 1) rad."""
        left, angles = np.empty(len(self.items)), state.angles()
        for item, rows in self._by_item():
            each, joint = self.ranges[item], self.ranges[item].measure.joint
            found = each.measure.of(joint.axes.rotation(angles[rows, joint.dofs]))
            left[rows] = np.where(self.upper[rows], each.upper - found, found - each.lower)
        return left[:, None]

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        angles, character = state.angles(), state.character
        full = np.empty((len(self.items), 1, character.n_angles))
        for item, rows in self._by_item():
            by = self.ranges[item].measure.by_angles(character, angles[rows])
            full[rows, 0] = np.where(self.upper[rows, None], -by, by)
        return [ChannelJacobian(Channel.ANGLES, 0, full)]

    def _by_item(self) -> list[tuple[int, IntArray]]:
        return [(item, np.flatnonzero(self.items == item)) for item in set(self.items.tolist())]


@dataclass(frozen=True)
class HumanGuard:
    """Ranges of a motion's joints. human: those of any person; reference: the fit on this body.

    own: bones whose joints have limits of the artist's, and none of these. hard: whether none of
    them may be given up. spacing: s, of the instants at which a motion is looked at.
    """

    human: tuple[JointRange, ...]
    reference: Motion
    own: frozenset[str] = frozenset()
    hard: bool = False
    spacing: float = SPACING
    kind: RowKind = RowKind.RANGE

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Of the items."""
        return tuple(each.name for each in self.human)

    @cached_property
    def _turned(self) -> FloatArray:
        """(T + 1, B, 3, 3) joint rotations of the reference on the dense grid, and of its rest
        pose."""
        turned = self.reference.joint_rotations(_grid(self.reference.duration, SPACING))
        return np.concatenate([turned, np.broadcast_to(np.eye(3), (1, *turned.shape[1:]))])

    @cached_property
    def ranges(self) -> tuple[JointRange, ...]:
        """As wide as the reference and its rest pose ask for; endless where the artist limits."""
        bodies = self.reference.transcription.character.bodies
        return tuple(
            replace(each, lower=-inf, upper=inf)
            if bodies[each.body].bone in self.own
            else each.holding(self._turned[:, each.body])
            for each in self.human
        )

    @cached_property
    def recorded(self) -> list[DenseViolation]:
        """How far the recording itself (its fit) goes beyond human ranges; it may."""
        times = _grid(self.reference.duration, SPACING)
        return _beyond(self.human, times, self._turned[:-1]).worst(self.names)

    def sparse(self) -> "HumanGuard":
        """The same, for which half as many instants are looked at."""
        return replace(self, spacing=2.0 * SPACING)

    def violations(self, motion: Motion) -> list[DenseViolation]:
        """The worst of each joint beyond its range, worst first."""
        return self._last.of(motion).worst(self.names)

    @cached_property
    def _last(self) -> LastMotion[BeyondRange]:
        return LastMotion(self._look)

    def _look(self, motion: Motion) -> BeyondRange:
        times = _grid(motion.duration, self.spacing)
        return _beyond(self.ranges, times, motion.joint_rotations(times))

    def rows(self, motion: Motion, given_up: Set[str]) -> GuardRows | None:
        """A motion's range rows, with more where it goes beyond; the same where it does not.

        given_up: names of items that have no rows.
        """
        old = motion.transcription.guard(self.kind)
        found = self._last.of(motion)
        found = found.some(~named(self.names, found.items, given_up))
        if not len(found.items):
            return old
        found = found.some(chosen(found, self.spacing, ROW_SPACING))
        items, times, upper = found.items, found.times, found.upper
        if old is not None:
            assert isinstance(old.function, RangeLeft)
            kept = ~named(self.names, old.items, given_up)
            items = np.concatenate([old.items[kept], items])
            times = np.concatenate([old.times[kept], times])
            upper = np.concatenate([old.function.upper[kept], upper])
        function = RangeLeft(self.ranges, items, upper)
        return GuardRows(self.names, items, times, np.zeros(len(items)), function)


def recorded_ranges(reference: Motion) -> tuple[JointRange, ...]:
    """Human ranges of a motion's figure, whose joints bend the way they do in it."""
    times = np.linspace(0.0, reference.duration, RANGE_SAMPLES)
    return joint_ranges(reference.transcription.character, reference.angles(times))


def _beyond(ranges: tuple[JointRange, ...], times: FloatArray, turned: FloatArray) -> BeyondRange:
    """Where joint rotations (T, B, 3, 3) at instants (T,) s are beyond ranges, by MOST_NEW."""
    low, high = np.stack([each.past(turned[:, each.body]) for each in ranges], axis=2)
    over = np.maximum(high, low)
    instants, items = np.nonzero(over > MOST_NEW)
    upper = high[instants, items] >= low[instants, items]
    return BeyondRange(items, times[instants], over[instants, items], upper)


def _grid(duration: float, spacing: float) -> FloatArray:
    return np.linspace(0.0, duration, 1 + int(np.ceil(duration / spacing)))
