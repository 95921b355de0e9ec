"""Recordings for the benchmarks, read without Blender."""

from ..devtools.recordings import find, read
from ..solver.data.problem import MotionProblem, Pin
from ..solver.data.recording import Recording

RATE = 120.0  # Hz, of every clip here


def recording(file: str) -> Recording:
    """A BVH or AMC file by its name. Raises SetUpError where there is none."""
    return read(find(file))


def jump() -> MotionProblem:
    """The broad jump, its landing moved 0.4 m forward and 0.3 m up."""
    return landing((60.0, 330.0), (0.4, 0.0, 0.3))


def hops(start: float, seconds: float) -> MotionProblem:
    """A window of the ten hops, its first landing moved 0.3 m forward."""
    frames = (1 + round(start * RATE), 1 + round((start + seconds) * RATE))
    return landing(frames, (0.3, 0.0, 0.0))


def landing(frames: tuple[float, float], offset: tuple[float, float, float]) -> MotionProblem:
    """The first landing in a window of frames, moved by an offset along the travel, m."""
    return MotionProblem(frames=frames, pins=(Pin("landing", "ground 2", offset=offset),))
