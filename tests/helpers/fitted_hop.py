"""A fitted jump that the tests of several files share."""

from functools import cache

from hangtime.solver.analysis.analyse import Analysis, analyse
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.fitting.fit import Fit, fit
from hangtime.tests.helpers.clips import load_recording

HOP_CLIP = "hop_01_01.bvh"  # the first of ten hops
HOP = (19 / 120, 175 / 120)  # s, from crouch to crouch; short, so that its fit is quick


@cache
def hop() -> Analysis:
    """The first hop of the ten."""
    return analyse(load_recording(HOP_CLIP), MotionProblem(frames=frames_of(HOP_CLIP, HOP)))


@cache
def fitted_hop() -> Fit:
    analysis = hop()
    return fit(analysis.performance, analysis.schedule)


def frames_of(relative: str, seconds: tuple[float, float]) -> tuple[float, float]:
    """Scene frames of a recording's instants."""
    recording = load_recording(relative)
    rate = (len(recording.times) - 1) / float(recording.times[-1])
    first = float(recording.frames[0])
    return tuple(round(first + t * rate) for t in seconds)  # type: ignore[return-value]
