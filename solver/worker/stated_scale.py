"""The scale that a recording is read with, before anything of the figure is measured at it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from ..body.character import build_character
from ..data.constants import STATURES
from ..data.faults import NoFaceThere, OddScale, OverTheEdge
from ..data.problem import MotionProblem
from ..data.recording import Recording
from ..data.scaling import scaled_recording

USUAL_STATURE = 1.75  # m


def check_scale(recording: Recording, problem: MotionProblem, scale: float) -> None:
    """Whether a figure is a person's at the scale that its recording got already.

    Measured without it, for bones of a millionth have no length. Raises OddScale, and as
    `build_character`.
    """
    if scale == 1.0:
        return
    unscaled = scaled_recording(recording, 1.0 / scale)
    height = build_character(unscaled, chosen=problem.bones).height
    if not STATURES[0] <= scale * height <= STATURES[1]:
        person = STATURES[0] <= height <= STATURES[1]
        raise OddScale(scale, scale * height, 1.0 if person else USUAL_STATURE / height)


@contextmanager
def own_lengths(factor: float) -> Iterator[None]:
    """Context whose faults tell places in the recording's own lengths, which the solver has times
    `factor`."""
    try:
        yield
    except OverTheEdge as fault:
        raise replace(fault, metres=fault.metres / factor) from None
    except NoFaceThere as fault:
        if fault.at is None or fault.reach is None:
            raise
        (x, y), (low, high) = (np.divide(each, factor).tolist() for each in (fault.at, fault.reach))
        raise replace(fault, at=(x, y), reach=(tuple(low), tuple(high))) from None
