"""Fits of clips that were damaged and repaired, and of parts without any flight.

A fit shall end with a valid motion whatever was wrong with its clip, and near it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...operators.words.messages import sentence
from ...solver.analysis.performance import perform
from ...solver.body.character import build_character
from ...solver.data.contacts import gaps
from ...solver.data.faults import Fault
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import Recording
from ...solver.doctor.examination.diagnose import diagnose
from ...solver.doctor.examination.repair import repaired
from ...solver.fitting.fit import Fit
from ...solver.results.certificate import loaded_drifts
from ...solver.results.fit_quality import fit_quality
from ...solver.worker.pipeline import fit_subject, measure, no_fit
from ...solver.worker.stage_clock import StageClock
from .damages.damage import Damage
from .damages.every import DAMAGES

NOISE = "30 Hz, 3 mm and 1° noise"
WITHOUT_FLIGHT = "part without flight"
LEAST = 1.0  # s, of such a part
LONGEST = 5.0  # s, of what is damaged or fitted


@dataclass(frozen=True)
class FittedClip:
    """What became of a fit. damage: its name, WITHOUT_FLIGHT, or "" for the clean clip. valid:
    whether it ended with a valid motion, else `said` tells why not. off: m, rms of the joint
    centres from the undamaged clip, and from the repaired one that was fitted. slides: m, the
    furthest that a contact slides while it carries. let_go: contacts that it does not hold.
    carried: the share of its time in which something unseen carries the body."""

    clip: str
    damage: str
    valid: bool
    said: str = ""
    off_original: float = 0.0
    off_fitted: float = 0.0
    slides: float = 0.0
    let_go: int = 0
    carried: float = 0.0


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
    for damage in (each for each in damages if each.possible(part)):
        damaged = damage.of(part)
        yield fitted(name, damage.name, damaged.recording, damaged.original)
    try:
        grounded = without_flight(whole)
    except Fault as fault:
        yield FittedClip(name, WITHOUT_FLIGHT, False, sentence(fault))
        return
    if grounded is not None:
        yield fitted(name, WITHOUT_FLIGHT, grounded, grounded)


def without_flight(recording: Recording) -> Recording | None:
    """The longest part of a clip without any flight, at most LONGEST; None where there is none of
    LEAST. What seems to fly at the ends of a part that is looked at by itself is left out."""
    part = recording
    while part.times[-1] - part.times[0] >= LEAST:
        schedule = measure(part, MotionProblem()).analysis.schedule
        if not schedule.flights and part.times[-1] - part.times[0] <= LONGEST:
            return part
        grounded = gaps(((each.start, each.end) for each in schedule.flights), schedule.duration)
        if not grounded:
            return None
        longest = max(grounded, key=lambda each: each.end - each.start)
        end = min(longest.end, longest.start + LONGEST)
        first, last = np.interp((longest.start, end), part.times - part.times[0], part.frames)
        part = part.window(float(np.ceil(first)), float(np.floor(last)))
    return None


def fitted(name: str, damage: str, recording: Recording, original: Recording) -> FittedClip:
    """The fit of a recording, with what the doctor repairs of a damaged one, beside the undamaged
    one at the same frames."""
    try:
        mended = recording if recording is original else repaired_by_doctor(recording)
        subject = measure(mended, MotionProblem())
        fit = fit_subject(subject, StageClock())
        if not fit.solved:
            return FittedClip(name, damage, False, sentence(no_fit(subject, fit)))
    except Fault as fault:
        return FittedClip(name, damage, False, sentence(fault))
    drifts = loaded_drifts(fit.motion)
    slides = max((float(each.slide.max(initial=0.0)) for each in drifts), default=0.0)
    off = off_original(fit, original), 0.01 * fit_quality(fit).joint_centres_rms_cm
    return FittedClip(name, damage, True, "", *off, slides, len(fit.let_go), carried(fit))


def repaired_by_doctor(recording: Recording) -> Recording:
    """With all remedies that the doctor offers."""
    return repaired(recording, diagnose(recording).repairs)


def carried(fit: Fit) -> float:
    """The share of a fit's time in which something unseen carries the body."""
    schedule = fit.schedule
    return sum(each.end - each.start for each in schedule.unseen) / schedule.duration


def off_original(fit: Fit, original: Recording) -> float:
    """M, rms distance of the joint centres from the undamaged recording's, at common frames."""
    found, true = fit.performance, perform(original, build_character(original))
    _, ours, theirs = np.intersect1d(
        found.recording.frames, true.recording.frames, return_indices=True
    )
    apart = fit.motion.joint_centres(found.times[ours]) - true.centres[theirs]
    return float(np.sqrt((apart**2).sum(axis=-1).mean()))
