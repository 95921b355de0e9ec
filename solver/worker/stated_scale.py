"""The scale that a recording is read with, before anything of the figure is measured at it."""

from __future__ import annotations

from ..body.character import build_character
from ..data.constants import STATURES
from ..data.faults import OddScale
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
