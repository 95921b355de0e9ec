"""A motion in two numbers a frame, that tell whether another is the same but for rounding; and in
two a bone, that tell which are moved otherwise.

Digests of rounded values do not: of a hundred thousand values there is always one at the edge of
its rounding. Random projections keep distances instead (Johnson and Lindenstrauss 1984): of n
values v in a frame, sum v_k exp(i k^2) / sqrt(n). Rounding moves it by about as much as one value;
a value that changes, whichever, moves it by 1 / sqrt(n) of its change.
"""

from __future__ import annotations

import base64
import binascii
import hashlib
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..data.recording import POSE_TOLERANCE, Recording

_CLEARLY = 0.1  # of what the bone misses that is moved most otherwise


@dataclass(frozen=True)
class Apart:
    """Where two motions of the same bones differ. bones: indices of those that are clearly moved
    otherwise, parents first. frame: index of the one in which the poses differ most."""

    bones: tuple[int, ...]
    frame: int


@dataclass(frozen=True, eq=False)
class MotionSketch:
    """layout: digest of what is no measure: bones, frames and known contacts. projections:
    (1 + T, 2) of the rest pose and of each frame's; by_bone: (B, 2) of each bone's poses, none in
    those that earlier versions kept; m and rad, world."""

    layout: str
    projections: FloatArray
    by_bone: FloatArray

    @staticmethod
    def of(recording: Recording) -> MotionSketch:
        named = tuple((bone.name, bone.parent, bone.follows) for bone in recording.bones)
        layout = hashlib.sha256(repr((named, recording.known)).encode())
        layout.update(recording.frames.tobytes())
        rests = [(*bone.head, *bone.tail, *bone.rotation.ravel()) for bone in recording.bones]
        n_frames = len(recording.frames)
        poses = [each.reshape(n_frames, -1) for each in (recording.heads, recording.rotations)]
        projections = [_projected(np.ravel(rests)[None]), _projected(np.hstack(poses))]
        turns = recording.rotations.reshape(*recording.heads.shape[:2], -1)
        bones = np.swapaxes(np.concatenate([recording.heads, turns], axis=2), 0, 1)
        by_bone = _projected(bones.reshape(len(recording.bones), -1))
        return MotionSketch(layout.hexdigest(), np.concatenate(projections), by_bone)

    @property
    def text(self) -> str:
        """To be kept in a file; see `from_text`."""
        tables = (each.astype("<f4").tobytes() for each in (self.projections, self.by_bone))
        return " ".join([self.layout, *(base64.b64encode(each).decode() for each in tables)])

    @staticmethod
    def from_text(text: str) -> MotionSketch | None:
        """None where it is no text of one."""
        layout, *tables = text.split(" ")
        try:
            projections, by_bone = map(_table, (*tables, "") if len(tables) == 1 else tables)
            return MotionSketch(layout, projections, by_bone)
        except (binascii.Error, ValueError):
            return None

    def is_near(self, other: MotionSketch) -> bool:
        """Whether both are of the same motion of the same bones in the same frames, to rounding."""
        one, two = self.projections, other.projections
        alike = self.layout == other.layout and one.shape == two.shape
        return alike and np.allclose(one, two, rtol=0.0, atol=POSE_TOLERANCE)

    def apart(self, other: MotionSketch) -> Apart | None:
        """Where the other motion differs; None where that is not told: of other bones or frames, or
        by a sketch of an earlier version."""
        if self.layout != other.layout or not len(self.by_bone):
            return None
        by_frame = np.linalg.norm(self.projections[1:] - other.projections[1:], axis=1)
        off = np.linalg.norm(self.by_bone - other.by_bone, axis=1)
        bones = np.flatnonzero(off > _CLEARLY * off.max())
        return Apart(tuple(bones.tolist()), int(by_frame.argmax()))


def _table(text: str) -> FloatArray:
    """(N, 2) of what is kept. Raises ValueError."""
    values = np.frombuffer(base64.b64decode(text, validate=True), "<f4")
    return values.reshape(-1, 2).astype(float)


def _projected(values: FloatArray) -> FloatArray:
    """(T, 2) of values (T, n)."""
    count = values.shape[1]
    found = values @ np.exp(1j * np.arange(count) ** 2) / np.sqrt(count)
    return np.stack([found.real, found.imag], axis=1)
