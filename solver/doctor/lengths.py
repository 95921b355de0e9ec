"""Limbs that change their length in the course of a recording."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..data.problem import Mend
from ..data.recording import Recording
from .figure import Figure
from .finding import Finding, FindingKind
from .local_poses import LocalPoses, spans
from .repairs import Repairs

CHANGED = 0.02  # of its usual length, and
CHANGED_BY = 0.005  # m; rigs that stretch do more, float32 and files' digits far less


def find_lengths(recording: Recording, figure: Figure) -> Finding | None:
    """The limb that changes its length most."""
    bones = list(figure.limbs)
    lengths = np.linalg.norm(LocalPoses.of(recording).heads[:, bones], axis=2)
    usual = np.median(lengths, axis=0)
    away = np.abs(lengths - usual)
    changed = (away > CHANGED_BY) & (away > CHANGED * usual)
    if not changed.any():
        return None
    worst = int(np.argmax((away * changed).max(axis=0)))
    return Finding(
        FindingKind.BONE_LENGTH,
        100.0 * float(away[:, worst].max()),
        "cm",
        spans(recording, changed.any(axis=1)),
        recording.bones[recording.bones[bones[worst]].parent].name,
        Repairs(mend=(Mend.BONE_LENGTHS,)),
        end=recording.bones[bones[worst]].name,
    )


def kept_lengths(recording: Recording, figure: Figure) -> Recording:
    """With every joint where it usually is in its parent."""
    local, bones = LocalPoses.of(recording), list(figure.limbs)
    usual: FloatArray = np.median(local.heads[:, bones], axis=0)
    local.heads[:, bones] = usual
    return local.posed(recording)
