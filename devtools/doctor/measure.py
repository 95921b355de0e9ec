"""One clip with one damage: what the doctor says of it, and what its remedies leave."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...solver.analysis.performance import perform
from ...solver.body.character import build_character
from ...solver.data.recording import Recording
from ...solver.doctor.examination.diagnose import diagnose
from ...solver.doctor.examination.repair import repaired
from ...solver.doctor.falls import Falls, falls_of
from ...solver.doctor.finding import FindingKind
from .damages.damage import Damage

# What a clip truly has, undamaged, is no false alarm: the dancer's hips rise by 0.12 m in 50 ms and
# stop at once, which at 30 Hz is a jump; and afterwards the lowest foot stands 4 to 16 cm up, until
# it falls to the floor as suddenly.
OWN_FAULTS = {"rokoko_jesse_dance": (FindingKind.LEAP, FindingKind.JUMP, FindingKind.FLOOR)}


@dataclass(frozen=True)
class Examined:
    """damage: its name, "" for the clean clip. found: whether it was named rightly. false: other
    findings that are no notes. scale_error: of the factor of time or size, None where it is of
    another kind or was not found. before, after: m, rms of the joints' distance to the original.
    falls: of the clean clip, where there are any."""

    clip: str
    damage: str
    kind: FindingKind | None
    found: bool
    false: tuple[str, ...]
    scale_error: float | None
    before: float
    after: float
    falls: Falls | None = None


def examine_clean(name: str, recording: Recording) -> Examined:
    """What the doctor says of a clip as it is."""
    own = OWN_FAULTS.get(name, ())
    told = [f.kind for f in diagnose(recording).findings if not f.kind.note]
    kinds = [kind.value for kind in told if kind not in own]
    falls = falls_of(perform(recording, build_character(recording)))
    return Examined(name, "", None, True, tuple(kinds), None, 0.0, 0.0, falls)


def without_own_faults(name: str, recording: Recording) -> Recording:
    """A clip that truly has some, mended by what the doctor offers; others as they are."""
    return repaired(recording, diagnose(recording).repairs) if name in OWN_FAULTS else recording


def examine(name: str, recording: Recording, damage: Damage) -> Examined:
    """Damages a clip, has it diagnosed and repaired."""
    damaged = damage.of(recording)
    diagnosis = diagnose(damaged.recording)
    told = [finding for finding in diagnosis.findings if not finding.kind.note]
    right = (damage.kind, *damage.also)
    found = {*right} <= {finding.kind for finding in told}
    usual = (*right, *OWN_FAULTS.get(name, ()))
    false = tuple(f.kind.value for f in told if f.kind not in usual)
    mended = repaired(damaged.recording, diagnosis.repairs)
    error = None
    if damaged.scale is not None and found:
        repairs = diagnosis.repairs
        timed = damage.kind is FindingKind.TIME_SCALE
        error = abs(damaged.scale * (repairs.time_scale if timed else repairs.scale) - 1.0)
    before, after = (apart(each, damaged.original) for each in (damaged.recording, mended))
    return Examined(name, damage.name, damage.kind, found, false, error, before, after)


def apart(recording: Recording, original: Recording) -> float:
    """M, rms over joints and the frames that both have, for some at the ends may be left out."""
    _, ours, theirs = np.intersect1d(recording.frames, original.frames, return_indices=True)
    away = recording.heads[ours] - original.heads[theirs]
    return float(np.sqrt(np.mean(np.sum(away**2, axis=-1))))
