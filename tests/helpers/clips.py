"""Recorded motion for tests, read without Blender. What is not there fails; nothing skips."""

from functools import cache
from pathlib import Path

from hangtime.bridge.formats.acclaim import find_asf, read_acclaim
from hangtime.bridge.formats.bvh import read_bvh
from hangtime.bridge.formats.guess import guess_unit, guess_up
from hangtime.bridge.formats.motion_clip import MotionClip, to_recording
from hangtime.devtools.recordings import find
from hangtime.solver.data.recording import Recording

JUMP = "forward_jump_116cm.bvh"
JUMP_FRAMES = 110, 260  # from crouch to crouch; short, so that its fit is quick


def mocap_path(name: str) -> Path:
    """A recording's file, by its name in examples/recordings or that of the hops."""
    return find(name)


@cache
def load_clip(name: str) -> MotionClip:
    """A BVH or AMC file as it is."""
    path = mocap_path(name)
    return read_bvh(path) if path.suffix == ".bvh" else read_acclaim(find_asf(path), path)


@cache
def load_recording(name: str) -> Recording:
    """A BVH or AMC file in metres, Z up."""
    clip = load_clip(name)
    up = guess_up(clip)
    return to_recording(clip, clip.unit or guess_unit(clip), up)


def without_frames(clip: Path, after: int, count: int, folder: Path) -> Path:
    """A copy of a BVH file without so many frames after one (the first is 1)."""
    text, motion = clip.read_text().split("MOTION\n")
    _, time, *frames = motion.splitlines()
    kept = frames[:after] + frames[after + count :]
    copy = folder / "without_frames.bvh"
    copy.write_text("\n".join([f"{text}MOTION", f"Frames: {len(kept)}", time, *kept, ""]))
    return copy


def with_frames_repeated(clip: Path, after: int, count: int, folder: Path) -> Path:
    """A copy of a BVH file in which a frame (the first is 1) is held for so many more."""
    text, motion = clip.read_text().split("MOTION\n")
    _, time, *frames = motion.splitlines()
    held = frames[:after] + count * [frames[after - 1]] + frames[after:]
    copy = folder / "with_frames_repeated.bvh"
    copy.write_text("\n".join([f"{text}MOTION", f"Frames: {len(held)}", time, *held, ""]))
    return copy


def begun_at_rest(clip: Path, folder: Path, *, ended: bool = False) -> Path:
    """A copy of a BVH file with the rest pose, whose angles are 0, on its first frame. ended: and
    on its last."""
    text, motion = clip.read_text().split("MOTION\n")
    count, time, *frames = motion.splitlines()
    values = frames[0].split()
    rest = " ".join([*values[:3], *["0.0"] * (len(values) - 3)])
    frames = [rest, *frames, *([rest] if ended else [])]
    copy = folder / "begun_at_rest.bvh"
    count = f"Frames: {len(frames)}"
    copy.write_text("\n".join([f"{text}MOTION", count, time, *frames, ""]))
    return copy


def joined_after(clip: Path, after: int, step: float, folder: Path) -> Path:
    """A copy of a BVH file that goes on elsewhere after a frame (the first is 1). step: in its
    units, along X."""
    text, motion = clip.read_text().split("MOTION\n")
    count, time, *frames = motion.splitlines()
    rows = [frame.split() for frame in frames]
    moved = [[str(float(x) + step * (i >= after)), *row] for i, (x, *row) in enumerate(rows)]
    copy = folder / "joined_after.bvh"
    copy.write_text("\n".join([f"{text}MOTION", count, time, *map(" ".join, moved), ""]))
    return copy
