"""A way to damage a recording, and what several of them need."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ....solver.body.anatomy import Part
from ....solver.data.recording import Recording
from ....solver.doctor.figure import figure_of
from ....solver.doctor.finding import FindingKind
from ....solver.doctor.local_poses import LocalPoses
from ....solver.numerics.interpolation import interpolate

SEED = 7
VIDEO_RATE, FAST_RATE = 30.0, 120.0  # Hz, of one camera and of several


@dataclass(frozen=True)
class Damaged:
    """original: at the damaged recording's frames. scale: which the damage multiplied durations or
    lengths by; None where it is of another kind."""

    recording: Recording
    original: Recording
    scale: float | None = None


@dataclass(frozen=True)
class Damage:
    """kind: of the finding that names it rightly, and also: others that do so together with it.
    possible: whether a recording can be damaged so."""

    name: str
    kind: FindingKind
    do: Callable[[Recording, np.random.Generator], Damaged]
    also: tuple[FindingKind, ...] = ()
    possible: Callable[[Recording], bool] = lambda _: True

    def of(self, recording: Recording) -> Damaged:
        """The damage done to a recording, alike in every run."""
        return self.do(recording, np.random.default_rng(SEED))


def at_rate(recording: Recording, rate: float) -> Recording:
    """The recording sampled at another rate, Hz: cubic in places, nearest turns in between."""
    count = int(recording.times[-1] * rate) + 1
    times = np.arange(count) / rate
    local = LocalPoses.of(recording)
    flat = local.rotations.reshape(len(recording.frames), -1)
    mixed = interpolate(recording.times, flat, times).reshape(count, -1, 3, 3)
    u, _, vt = np.linalg.svd(mixed)
    heads = interpolate(recording.times, local.heads.reshape(len(flat), -1), times)
    made = LocalPoses(u @ vt, heads.reshape(count, -1, 3))
    frames = recording.frames[0] + np.arange(count)
    return made.posed(replace(recording, frames=frames, times=times))


def bone_of(recording: Recording, part: Part) -> int:
    """Index of the first bone that moves a part of the body."""
    return figure_of(recording).of(part)[0]
