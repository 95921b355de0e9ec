"""A motion in two numbers a frame, that tell whether another is the same but for rounding.

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


@dataclass(frozen=True, eq=False)
class MotionSketch:
    """layout: digest of what is no measure: bones, frames and known contacts. projections:
    (1 + T, 2) of the rest pose and of each frame's; m and rad, world."""

    layout: str
    projections: FloatArray

    @staticmethod
    def of(recording: Recording) -> MotionSketch:
        bones = tuple((bone.name, bone.parent, bone.follows) for bone in recording.bones)
        layout = hashlib.sha256(repr((bones, recording.known)).encode())
        layout.update(recording.frames.tobytes())
        rests = [(*bone.head, *bone.tail, *bone.rotation.ravel()) for bone in recording.bones]
        n_frames = len(recording.frames)
        poses = [each.reshape(n_frames, -1) for each in (recording.heads, recording.rotations)]
        projections = [_projected(np.ravel(rests)[None]), _projected(np.hstack(poses))]
        return MotionSketch(layout.hexdigest(), np.concatenate(projections))

    @property
    def text(self) -> str:
        """To be kept in a file; see `from_text`."""
        values = self.projections.astype("<f4").tobytes()
        return f"{self.layout} {base64.b64encode(values).decode()}"

    @staticmethod
    def from_text(text: str) -> MotionSketch | None:
        """None where it is no text of one."""
        layout, _, values = text.partition(" ")
        try:
            projections = np.frombuffer(base64.b64decode(values, validate=True), "<f4")
            return MotionSketch(layout, projections.reshape(-1, 2).astype(float))
        except (binascii.Error, ValueError):
            return None

    def is_near(self, other: MotionSketch) -> bool:
        """Whether both are of the same motion of the same bones in the same frames, to rounding."""
        one, two = self.projections, other.projections
        alike = self.layout == other.layout and one.shape == two.shape
        return alike and np.allclose(one, two, rtol=0.0, atol=POSE_TOLERANCE)


def _projected(values: FloatArray) -> FloatArray:
    """(T, 2) of values (T, n)."""
    count = values.shape[1]
    found = values @ np.exp(1j * np.arange(count) ** 2) / np.sqrt(count)
    return np.stack([found.real, found.imag], axis=1)
