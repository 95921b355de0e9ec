"""How a solve ends; apart, so that it can be worded where CasADi is missing."""

from enum import Enum


class Status(Enum):
    """How a solve ended."""

    SOLVED = "solved"
    STALLED = "stalled"
    TOO_MANY_STEPS = "too many steps"
    MISSED = "missed between the nodes"
    STOPPED = "stopped"  # by the artist, who takes the motion as it stands
