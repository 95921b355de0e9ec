"""Recordings for the benchmarks, read without Blender."""

from functools import cache

from ..bridge.formats.bvh import read_bvh
from ..bridge.formats.guess import guess_unit, guess_up
from ..bridge.formats.skeleton import to_recording
from ..devtools.environment.virtual_environment import ROOT
from ..solver.analysis.analyse import Analysis, analyse
from ..solver.data.problem import MotionProblem, Pin
from ..solver.data.recording import Recording

MOCAP = ROOT.parent / "shared" / "mocap"
RATE = 120.0  # Hz, of every clip here
JUMP = "cmu_bvh/forward_jump_116cm.bvh"
HOPS = "cmu_bvh/forward_hops_01_01.bvh"
FORWARD_AND_UP = (0.4, 0.0, 0.3)  # m


@cache
def recording(file: str) -> Recording:
    """A BVH file below MOCAP, in metres, Z up. Raises OSError where it is absent."""
    clip = read_bvh(MOCAP / file)
    up = guess_up(clip)
    return to_recording(clip, clip.unit or guess_unit(clip, up), up)


def analysed(file: str, problem: MotionProblem) -> Analysis:
    """The problem's frames of a recording."""
    return analyse(recording(file), problem)


def jump() -> MotionProblem:
    """The broad jump, its landing moved forward and up."""
    return landing((60.0, 330.0), FORWARD_AND_UP)


def hops(start: float, seconds: float) -> MotionProblem:
    """A window of the ten hops, its first landing moved 0.3 m forward."""
    frames = (1 + round(start * RATE), 1 + round((start + seconds) * RATE))
    return landing(frames, (0.3, 0.0, 0.0))


def landing(frames: tuple[float, float], offset: tuple[float, float, float]) -> MotionProblem:
    """The first landing in a window of frames, moved by an offset along the travel, m."""
    return MotionProblem(frames=frames, pins=(Pin("landing", "ground 2", offset=offset),))
