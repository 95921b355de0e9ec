"""Outcome of a solve and progress of a drag; apart, to be worded where CasADi is missing."""

from enum import Enum


class Status(Enum):
    """Outcome of a solve."""

    SOLVED = "solved"
    STALLED = "stalled"
    TOO_MANY_STEPS = "too many steps"
    MISSED = "missed between the nodes"
    STOPPED = "stopped"  # by the artist, who takes the motion as it stands


class DragStatus(Enum):
    """Drag status: converging, converged, diverged."""

    ON_ITS_WAY = "on its way"
    ARRIVED = "arrived"  # the pin is reached and physics holds
    LOST = "lost"  # it cannot follow, and stays where it last could
