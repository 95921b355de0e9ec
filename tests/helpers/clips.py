"""Recorded motion for tests, read without Blender."""

from functools import cache
from pathlib import Path

import pytest
from hangtime.bridge.formats.acclaim import find_asf, read_acclaim
from hangtime.bridge.formats.bvh import read_bvh
from hangtime.bridge.formats.guess import guess_unit, guess_up
from hangtime.bridge.formats.skeleton import MotionClip, to_recording
from hangtime.solver.data.recording import Recording

MOCAP = Path(__file__).resolve().parents[3] / "shared" / "mocap"


def mocap_path(relative: str) -> Path:
    """The file below the folder of recordings; skips the test where it is absent."""
    path = MOCAP / relative
    if not path.is_file():
        pytest.skip(f"no recording {relative} in ../shared/mocap beside the repository")
    return path


@cache
def load_clip(relative: str) -> MotionClip:
    """A BVH or AMC file as it is; skips the test where it is absent."""
    path = mocap_path(relative)
    return read_bvh(path) if path.suffix == ".bvh" else read_acclaim(find_asf(path), path)


@cache
def load_recording(relative: str) -> Recording:
    """A BVH or AMC file in metres, Z up; skips the test where it is absent."""
    clip = load_clip(relative)
    up = guess_up(clip)
    return to_recording(clip, clip.unit or guess_unit(clip, up), up)
