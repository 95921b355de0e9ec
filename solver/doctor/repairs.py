"""Repairs that a recording gets when it is read; the recorded action is never changed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from enum import Enum

from ..data.faults import NotBetweenFrames
from ..data.problem import Mend

MOST_MISSING = 1000  # frames in one place; what lies between seconds apart is anybody's guess
STEEPEST = 30.0  # °; from 45 on another axis is up


class UpAxis(Enum):
    """The axis of the world, as it was read, along which the figure stands."""

    X = "X"
    Y = "Y"
    Z = "Z"
    MINUS_X = "-X"
    MINUS_Y = "-Y"
    MINUS_Z = "-Z"


@dataclass(frozen=True)
class MissingFrames:
    """Frames that were not recorded: `count` of them, after a scene frame. Below 0 so many after it
    are too many, which repeat its pose."""

    after: int
    count: int


def check_missing(missing: Sequence[MissingFrames], first: float, last: float) -> None:
    """Whether all are amid a recording's frames. Raises NotBetweenFrames."""
    for gap in missing:
        if not first <= gap.after <= gap.after - min(gap.count, 0) < last:
            raise NotBetweenFrames(gap.after, first, last)


def filled_frame(frame: float, missing: Sequence[MissingFrames]) -> float:
    """Where a recorded frame goes; one that is taken out to the pose that it repeats."""
    return frame + sum(max(gap.count, gap.after - frame) for gap in missing if frame > gap.after)


def recorded_frame(frame: float, missing: Sequence[MissingFrames]) -> float:
    """The recorded frame of one of the filled take; of those put in the next."""
    for gap in missing:
        if frame > gap.after:
            frame = max(gap.after + 1, frame - gap.count)
    return frame


@dataclass(frozen=True)
class Repairs:
    """What to mend, in this order; the defaults leave a recording as it is.

    up: what becomes Z. tilt: °, by which the floor then slopes upwards along X and along Y, and
    which becomes level. missing: frames that are put in, or taken out; all others of a recipe
    count with them.
    trim, trim_end: frames left out at the beginning and at the end of the whole clip. mend: of the
    poses, and of how the body stands. time_scale, scale: factors of durations and of lengths. drift
    and rise: m/s, along the floor and upwards, that are taken out, and floor: m, the height that
    becomes 0; all after the factors.
    """

    up: UpAxis = UpAxis.Z
    missing: tuple[MissingFrames, ...] = ()
    trim: int = 0
    mend: tuple[Mend, ...] = ()
    time_scale: float = 1.0
    scale: float = 1.0
    drift: tuple[float, float] = (0.0, 0.0)
    floor: float = 0.0
    trim_end: int = 0
    rise: float = 0.0
    tilt: tuple[float, float] = (0.0, 0.0)

    @property
    def trims(self) -> bool:
        """Whether frames are left out."""
        return self.trim > 0 or self.trim_end > 0

    @property
    def places(self) -> bool:
        """Whether the figure is turned, scaled or lowered, as the scene can show it."""
        turned = self.up is not UpAxis.Z or any(self.tilt)
        return turned or self.scale != 1.0 or self.floor != 0.0

    def without(self, other: Repairs) -> Repairs:
        """These, but for what the other changes."""
        usual = Repairs()
        kept = {
            f.name: getattr(usual, f.name)
            for f in fields(Repairs)
            if getattr(other, f.name) != getattr(usual, f.name)
        }
        kept["mend"] = tuple(each for each in self.mend if each not in other.mend)
        kept["missing"] = tuple(gap for gap in self.missing if gap not in other.missing)
        return replace(self, **kept)

    def includes(self, other: Repairs) -> bool:
        """Whether these change all that the other changes."""
        return other.without(self) == Repairs()

    def joined(self, other: Repairs) -> Repairs:
        """These, and where the other changes something, what it changes; of frames that are left
        out, all."""
        usual = Repairs()
        mend = {*self.mend, *other.mend}
        return Repairs(
            other.up if other.up is not usual.up else self.up,
            tuple(sorted({*self.missing, *other.missing}, key=lambda gap: (gap.after, gap.count))),
            max(self.trim, other.trim),
            tuple(each for each in Mend if each in mend),
            other.time_scale if other.time_scale != 1.0 else self.time_scale,
            other.scale if other.scale != 1.0 else self.scale,
            other.drift if other.drift != usual.drift else self.drift,
            other.floor or self.floor,
            max(self.trim_end, other.trim_end),
            other.rise or self.rise,
            other.tilt if other.tilt != usual.tilt else self.tilt,
        )
