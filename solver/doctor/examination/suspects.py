"""What is wrong with a recording that is to be solved: told before, and where its solve failed, for
it may be the cause."""

from __future__ import annotations

import logging

from ...data.faults import Damage, Fault
from ...data.problem import MotionProblem
from ...data.recording import Recording
from ..falls import Spans
from ..finding import Finding, FindingKind
from ..repairs import Repairs
from .diagnose import diagnose

# What objects of the scene may explain: a box to stand on, a ramp, a train, a belt.
ABOUT_GROUND = (
    *(FindingKind.FLOOR, FindingKind.TILTED, FindingKind.SLIDING, FindingKind.RISING),
    *(FindingKind.IN_PLACE, FindingKind.FLOATING, FindingKind.SINKING),
)


def faults_of(recording: Recording, problem: MotionProblem) -> list[Finding]:
    """All that the doctor finds, without its notes and without what the problem explains: by its
    scene, a treadmill's loop, a stature that it states. recording: in its own lengths."""
    explained = set(ABOUT_GROUND) if problem.scene or problem.loop else set[FindingKind]()
    if problem.height is not None:
        explained.add(FindingKind.SIZE)
    found = diagnose(recording, problem.bones, carried=stated_contacts(problem)).findings
    return [each for each in found if not each.kind.note and each.kind not in explained]


def stated_contacts(problem: MotionProblem) -> Spans:
    """Scene frames of the contacts that the artist added, or edited at both ends."""
    added = ((each.start_frame, each.end_frame) for each in problem.added)
    edited = (
        (each.start_frame, each.end_frame)
        for each in problem.contacts
        if each.start_frame is not None and each.end_frame is not None and not each.remove
    )
    return (*added, *edited)


def damages_of(recording: Recording, problem: MotionProblem) -> tuple[Damage, ...]:
    """What may be why a solve failed; none where the doctor cannot look, of which a mistake of its
    own is logged. A fit finds the floor's height by itself."""
    try:
        found = faults_of(recording, problem)
    except Fault:
        return ()
    except Exception:  # it only explains, and must not hide the fault itself
        logging.getLogger(__name__).exception("The doctor failed on the recording")
        return ()
    return tuple(_damage(each) for each in found if each.kind is not FindingKind.FLOOR)


def _damage(finding: Finding) -> Damage:
    remedy = finding.remedy or Repairs()
    about = finding.frames, finding.part, finding.end, remedy.mend, remedy.time_scale
    return Damage(finding.kind.value, finding.amount, finding.unit, *about)
