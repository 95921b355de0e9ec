"""Termination status of solves and drags; apart, so that it can be worded without CasADi."""

from enum import Enum


class Status(Enum):
    """Termination status of a solve."""

    SOLVED = "solved"
    STALLED = "stalled"
    TOO_MANY_STEPS = "too many steps"
    MISSED = "missed between the nodes"
    NO_BODY = "no body can do it"  # its limbs go through each other, or joints far beyond ranges
    STOPPED = "stopped"  # by the artist, who takes the motion as it stands


class Durations(Enum):
    """Origin of a result's durations, as far as nobody asked for one."""

    RECORDED = "as recorded"  # no jump from standing has another length, or times are kept
    FOUND = "found"  # those that go with the moved landings and take-offs
    NONE_FOUND = "none found"  # no motion was found with others, so they are as recorded
    NOT_MET = "not met"  # those found missed what is asked for, or guards: as recorded
    MOVING_GROUND = "moving ground"  # a stance rides on what keeps its own time: as recorded


class DragStatus(Enum):
    """Convergence of a motion that follows a dragged pin."""

    CONVERGING = "converging"
    CONVERGED = "converged"  # the pin is reached and physics holds
    DIVERGED = "diverged"  # it cannot follow, and stays where it last could
