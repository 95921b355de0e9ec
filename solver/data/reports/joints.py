"""Records of the report on joints: what changed most, and what goes beyond a person's range."""

from dataclasses import dataclass


@dataclass(frozen=True)
class JointChange:
    """Largest turn of a bone's joint from where the recording (its fit) had it, and when."""

    bone: str
    change_deg: float
    frame: float


@dataclass(frozen=True)
class RecordedRange:
    """How far the recording (its fit) itself goes beyond a person's range; it may.

    name: such as "Left knee bends".
    """

    name: str
    beyond_deg: float
    frame: float


@dataclass(frozen=True)
class FastJoint:
    """A joint that goes faster than a person's, seen from the centre of mass, m/s.

    calmed: whether it would have, had torques not been weighed for that.
    """

    bone: str
    speed: float
    calmed: bool
