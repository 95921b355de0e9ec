"""Choices that rows of the sidebar's lists store.

The members' names are stored in the artist's file; the values are what the artist reads.
"""

from enum import Enum

HOLD = "HOLD"  # the kind of constraint whose rows are phases by their own names


class BodyKind(Enum):
    """What a row of the body changes' list does."""

    LOAD = "Carried Weight"
    LIMB = "Limb"


class SurfaceRole(Enum):
    """What an object of the scene is to the performer; the names are the solver's."""

    GROUND = "Ground"
    OBSTACLE = "Obstacle"


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


class Met(Enum):
    """How a constraint came out of the last solve."""

    UNKNOWN = "Not Solved Yet"
    MET = "Met"
    MISSED = "Missed"
