"""The kinds of constraints and body changes that the sidebar's lists hold, and their choices.

The members' names are stored in the artist's file; the values are what the artist reads.
"""

from enum import Enum


class ConstraintKind(Enum):
    """What a row of the constraints' list asks for."""

    POINT = "Point"
    LIFT = "Lift Off"
    ANGLE = "Joint Limit"
    CONE = "Cone"
    TWIST = "Twist Limit"
    TORQUE = "Torque Limit"
    POSE = "Pose"
    ORIENTATION = "Orientation"
    FORCE = "Contact Force"
    TIMING = "Timing"
    HOLD = "Hold"


class BodyKind(Enum):
    """What a row of the body changes' list does."""

    LOAD = "Carried Weight"
    LIMB = "Limb"


class Span(Enum):
    """During what a constraint holds."""

    ALWAYS = "Whole Clip"
    PHASE = "Phase"
    FRAMES = "Frames"
    FRAME = "One Frame"


class Instant(Enum):
    """The one instant of a phase at which a constraint holds, if it is to be one."""

    THROUGHOUT = "Throughout"
    START = "Start"
    MIDDLE = "Middle"
    APEX = "Apex"
    END = "End"


class PointAxes(Enum):
    """In what axes a point's bounds are."""

    WORLD = "World"
    TRAVEL = "Travel"
    SURFACE = "Surface"


class TorqueBy(Enum):
    """How a torque's bound is given."""

    NEWTON_METRES = "Newton Metres"
    SHARE = "Share of the Recording's Peak"


class PoseSource(Enum):
    """Where a pose is taken from."""

    FIT = "Recording"
    REST = "Rest Pose"


class ForceShape(Enum):
    """How a friction cone is bounded."""

    EXACT = "Round Cone"
    PYRAMID = "Pyramid"


class TimingBy(Enum):
    """How a phase's duration is given."""

    FACTOR = "Factor"
    SECONDS = "Seconds"


class Met(Enum):
    """How a constraint came out of the last solve."""

    UNKNOWN = "Not Solved Yet"
    MET = "Met"
    MISSED = "Missed"
