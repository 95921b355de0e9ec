"""Fits of clips that were damaged and repaired, and of parts without any flight.

A fit shall end with a valid motion whatever was wrong with its clip, and near it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...operators.words.messages import sentence
from ...solver.analysis.performance import perform
from ...solver.arrays import FloatArray
from ...solver.body.character import build_character
from ...solver.data.contacts import Interval, gaps
from ...solver.data.faults import Fault
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import Recording
from ...solver.doctor.examination.diagnose import diagnose
from ...solver.doctor.examination.repair import repaired
from ...solver.fitting.fit import Fit
from ...solver.results.certificate import loaded_drifts
from ...solver.worker.pipeline import StageClock, fit_subject, measure, no_fit
from .damages import DAMAGES, Damage

NOISE = "30 Hz, 3 mm and 1° noise"
WITHOUT_FLIGHT = "part without flight"
LEAST = 1.0  # s, of such a part
LONGEST = 5.0  # s


@dataclass(frozen=True)
class FittedClip:
    """What became of a fit. damage: its name, WITHOUT_FLIGHT, or "" for the clean clip. valid:
    whether it ended with a valid motion, else `said` tells why not. off: m, rms of the joint
    centres from the undamaged clip, and from the repaired one that was fitted. slides: m, the
    furthest that a contact slides while it carries. let_go: contacts that it does not hold."""

    clip: str
    damage: str
    valid: bool
    said: str = ""
    off_original: float = 0.0
    off_fitted: float = 0.0
    slides: float = 0.0
    let_go: int = 0


def one_of_each_kind() -> list[Damage]:
    """Of each finding's damages the middle one, and the noise of video."""
    kinds = {damage.kind: [d for d in DAMAGES if d.kind is damage.kind] for damage in DAMAGES}
    middle = {alike[len(alike) // 2].name for alike in kinds.values()}
    return [damage for damage in DAMAGES if damage.name in {*middle, NOISE}]


def fits(
    name: str, part: Recording, whole: Recording, damages: list[Damage]
) -> Iterator[FittedClip]:
    """Of a clip's part as it is and with each damage, repaired as the doctor offers, and of the
    whole's longest part without flight."""
    yield fitted(name, "", part, part)
    for damage in damages:
        damaged = damage.of(part)
        mended = repaired(damaged.recording, diagnose(damaged.recording).repairs)
        yield fitted(name, damage.name, mended, damaged.original)
    grounded = without_flight(whole)
    if grounded is not None:
        yield fitted(name, WITHOUT_FLIGHT, grounded, grounded)


def without_flight(recording: Recording) -> Recording | None:
    """The longest part of a clip without any flight, at most LONGEST; None where there is none of
    LEAST."""
    schedule = measure(recording, MotionProblem()).analysis.schedule
    flights = [(each.start, each.end) for each in schedule.flights]
    parts = gaps(flights, schedule.duration)
    longest = max(parts, key=lambda each: each.end - each.start, default=Interval(0.0, 0.0))
    end = min(longest.end, longest.start + LONGEST)
    if end - longest.start < LEAST:
        return None
    first, last = np.interp((longest.start, end), recording.times, recording.frames)
    return recording.window(float(np.ceil(first)), float(np.floor(last)))


def fitted(name: str, damage: str, recording: Recording, original: Recording) -> FittedClip:
    """The fit of a recording, beside the undamaged one at the same frames."""
    try:
        subject = measure(recording, MotionProblem())
        fit = fit_subject(subject, StageClock())
        if not fit.solved:
            return FittedClip(name, damage, False, sentence(no_fit(subject, fit)))
    except Fault as fault:
        return FittedClip(name, damage, False, sentence(fault))
    drifts = loaded_drifts(fit.motion)
    slides = max((float(each.slide.max(initial=0.0)) for each in drifts), default=0.0)
    performance = fit.performance
    apart = fit.motion.joint_centres(performance.times) - performance.centres
    off = off_original(fit, original), _rms(apart)
    return FittedClip(name, damage, True, "", *off, slides, len(fit.let_go))


def off_original(fit: Fit, original: Recording) -> float:
    """M, rms distance of the joint centres from the undamaged recording's, at common frames."""
    found, true = fit.performance, perform(original, build_character(original))
    _, ours, theirs = np.intersect1d(
        found.recording.frames, true.recording.frames, return_indices=True
    )
    return _rms(fit.motion.joint_centres(found.times[ours]) - true.centres[theirs])


def _rms(apart: FloatArray) -> float:
    return float(np.sqrt((apart**2).sum(axis=-1).mean()))
