"""Writer of Biovision files (.bvh)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from io import StringIO
from pathlib import Path

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.recording import Recording
from .motion_clip import Joint, MotionClip, UpAxis, from_recording, to_z_up

ROTATIONS = ("Zrotation", "Xrotation", "Yrotation")  # R = Rz Rx Ry
POSITIONS = ("Xposition", "Yposition", "Zposition")
STILL = 1e-4  # units of the file, by which a head may leave its place under its parent


def write_bvh(recording: Recording, path: Path, unit: float, up: UpAxis) -> None:
    """Write a recording as a BVH file.

    unit: m per unit of the file. up: its axis that points up. A joint whose head moves against its
    parent has channels for that. Raises OSError.
    """
    clip = _in_file(from_recording(recording), unit, up)
    children = [
        [c for c, j in enumerate(clip.joints) if j.parent == i] for i in range(-1, len(clip.joints))
    ]
    order: list[int] = []
    lines = ["HIERARCHY"]
    moving = _moving(clip)
    for root in children[0]:
        lines += _joint(clip, root, children[1:], moving, order, 0)
    lines += ["MOTION", f"Frames: {len(clip.positions)}", f"Frame Time: {clip.frame_time:.9f}"]
    text = StringIO()
    np.savetxt(text, _table(clip, order, moving), fmt="%.6f")
    path.write_text("\n".join([*lines, text.getvalue()]), encoding="utf-8")


def _in_file(clip: MotionClip, unit: float, up: UpAxis) -> MotionClip:
    """A clip in metres, Z up, in the file's units and axes."""
    turn = to_z_up(up)

    def placed(vector: FloatArray) -> FloatArray:
        return np.asarray(vector @ turn / unit)

    joints = tuple(
        Joint(j.name, j.parent, placed(j.offset), None if j.tip is None else placed(j.tip))
        for j in clip.joints
    )
    rotations = turn.T @ clip.rotations @ turn
    return MotionClip(clip.name, joints, placed(clip.positions), rotations, clip.frame_time, unit)


def _moving(clip: MotionClip) -> list[bool]:
    offsets = np.array([joint.offset for joint in clip.joints])
    away = np.abs(clip.positions - offsets).max(axis=(0, 2))
    return [
        bool(joint.parent < 0 or far > STILL) for joint, far in zip(clip.joints, away, strict=True)
    ]


def _joint(
    clip: MotionClip,
    j: int,
    children: Sequence[Sequence[int]],
    moving: Sequence[bool],
    order: list[int],
    depth: int,
) -> Iterator[str]:
    """Lines of a joint and all below it. order: gets the joints as they are written."""
    joint, margin = clip.joints[j], "  " * depth
    order.append(j)
    channels = (*(POSITIONS if moving[j] else ()), *ROTATIONS)
    yield f"{margin}{'ROOT' if joint.parent < 0 else 'JOINT'} {joint.name}"
    yield f"{margin}{{"
    yield f"{margin}  OFFSET {_numbers(joint.offset)}"
    yield f"{margin}  CHANNELS {len(channels)} {' '.join(channels)}"
    for child in children[j]:
        yield from _joint(clip, child, children, moving, order, depth + 1)
    if not children[j] and joint.tip is not None:
        yield from (f"{margin}  End Site", f"{margin}  {{")
        yield from (f"{margin}    OFFSET {_numbers(joint.tip)}", f"{margin}  }}")
    yield f"{margin}}}"


def _numbers(vector: FloatArray) -> str:
    return " ".join(f"{number:.6f}" for number in vector)


def _table(clip: MotionClip, order: Sequence[int], moving: Sequence[bool]) -> FloatArray:
    """(T, C) channel values, units and degrees."""
    columns: list[FloatArray] = []
    for j in order:
        if moving[j]:
            columns.append(clip.positions[:, j])
        columns.append(np.degrees(_angles(clip.rotations[:, j])))
    return np.concatenate(columns, axis=1)


def _angles(rotations: FloatArray) -> FloatArray:
    """(T, 3) rad about z, x and y of R = Rz Rx Ry, without jumps of a whole turn."""
    about_x = np.arcsin(np.clip(rotations[:, 2, 1], -1.0, 1.0))
    about_z = np.arctan2(-rotations[:, 0, 1], rotations[:, 1, 1])
    about_y = np.arctan2(-rotations[:, 2, 0], rotations[:, 2, 2])
    return np.unwrap(np.stack([about_z, about_x, about_y], axis=1), axis=0)
