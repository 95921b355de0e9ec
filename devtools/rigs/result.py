"""What is found about one rig."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray


@dataclass(frozen=True)
class FileResult:
    """What a file of a format loses at most: of any bone's place, and of its turn."""

    name: str
    mm: float
    degrees: float


@dataclass(frozen=True)
class Edited:
    """The adapted jump as Blender shows it: joint centres (T, J, 3), m, at frames (T,).

    files: it, written to files and read again.
    """

    frames: FloatArray
    centres: FloatArray
    solved: bool
    files: tuple[FileResult, ...] = ()


@dataclass(frozen=True)
class RigResult:
    """A rig mapped with no hand work, and the same edit on it.

    wrong: parts whose bone is another or none, "left toe: ball_l". evidence: how many bones were
    found by what. difference_mm: the largest of a joint centre to the reference rig's, at `joint`
    and `frame`; None where the edit was not made. failed: why, in words.
    """

    key: str
    name: str
    unknown: bool
    bones: int
    convention: str = ""
    wrong: tuple[str, ...] = ()
    evidence: tuple[tuple[str, int], ...] = ()
    difference_mm: float | None = None
    joint: str = ""
    frame: float = 0.0
    recording_mm: float | None = None
    solved: bool = False
    failed: str = ""
    files: tuple[FileResult, ...] = ()

    @property
    def mapped(self) -> bool:
        """Whether every part was found by itself, and rightly."""
        return not self.wrong and not self.failed


def compared(
    edited: Edited, reference: Edited, joints: tuple[str, ...]
) -> tuple[float, str, float]:
    """The largest difference of a joint centre in mm, its joint and frame; at frames of both."""
    _, mine, other = np.intersect1d(edited.frames, reference.frames, return_indices=True)
    apart = np.linalg.norm(edited.centres[mine] - reference.centres[other], axis=2)
    t, j = np.unravel_index(int(np.argmax(apart)), apart.shape)
    return 1e3 * float(apart[t, j]), joints[int(j)], float(edited.frames[mine[t]])
