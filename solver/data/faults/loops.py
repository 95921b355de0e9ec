"""Faults of a motion that shall repeat. Frames are scene frames."""

from dataclasses import dataclass

from .base import Fault


@dataclass
class NothingRecurs(Fault):
    """No point comes down or leaves twice, about as many frames apart as are asked for."""

    first: float
    last: float


@dataclass
class EndsTouchOtherwise(Fault):
    """No frames near those asked for are a period apart with the same points on the ground."""

    first: float
    last: float
    period: float
    at_first: tuple[str, ...]
    at_last: tuple[str, ...]


@dataclass
class CycleTurns(Fault):
    """The body faces elsewhere at the cycle's end. degrees: counter-clockwise from above."""

    degrees: float


@dataclass
class CycleClimbs(Fault):
    """The body is higher or, with less than 0, lower at the cycle's end, m."""

    metres: float

    @property
    def down(self) -> float:
        return -self.metres


@dataclass
class NotInLoop(Fault):
    """Something that a loop cannot have is asked for beside it."""

    what: str


@dataclass
class SeamStanceMoved(Fault):
    """A pin moves a contact that the seam cuts, which would tear the loop."""

    name: str


@dataclass
class NoRootBone(Fault):
    """No bone of the armature lies above the pelvis, to carry root motion."""

    armature: str
    pelvis: str
