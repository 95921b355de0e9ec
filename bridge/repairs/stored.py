"""Repairs and findings as the armature's settings hold them: the recording's keys never change."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict, astuple, replace
from typing import Any

import bpy

from ...solver.data.problem import Mend
from ...solver.doctor.examination.diagnose import Diagnosis
from ...solver.doctor.finding import Finding, FindingKind
from ...solver.doctor.repairs import (
    MOST_MISSING,
    STEEPEST,
    MissingFrames,
    Repairs,
    UpAxis,
    recorded_frame,
)
from ...solver.doctor.stance.feet import FootFault, FootFaultKind
from ...solver.doctor.stretch import CUTTING, Span, belonging, is_clear
from ..accessors import current_scene, source_of
from ..armature.actions import recorded_action
from ..armature.keys_digest import KeptDigests
from ..armature.poses import frames_per_second
from ..hidden_texts import HiddenText, entries, listed, number, spans_text, whole, word
from ..properties.settings import HangtimeSettings, settings_of
from ..results.digests import keyed_for, take_digest
from ..rows.copying import rows_named
from ..rows.finding import HangtimeFinding
from .length_keys import stretching_bone

USUAL = asdict(Repairs())


def applied(settings: HangtimeSettings) -> Repairs:
    """The repairs that count: poses are mended and drift is left out as the recording is read;
    turn, size, floor and clock are what the scene has (placed_armature.py)."""
    return repairs_in(settings.repairs)


def repairs_to_write(settings: HangtimeSettings) -> Repairs | None:
    """The repairs for a recipe; None where there are none. What is left out at both ends the range
    of frames says."""
    return replace(applied(settings), trim=0, trim_end=0) if settings.repairs else None


def unreadable(settings: HangtimeSettings) -> bool:
    """Whether a script, or a version that knows other repairs, stored what cannot be read."""
    return not REPAIRS.is_ours(settings.repairs)


def repairs_in(stored: str) -> Repairs:
    """Repairs in a stored text; those that change nothing in an empty one, and in one that cannot
    be read, which `unreadable` tells."""
    return REPAIRS.of(stored)


def _read_repairs(content: Any) -> Repairs:
    read = {name: _READ[name](value) for name, value in entries(content).items()}
    return Repairs(**read)


def _missing(content: Any) -> tuple[MissingFrames, ...]:
    gaps = [MissingFrames(int(number(after)), _count(n)) for after, n in listed(content)]
    if not all(1 <= abs(gap.count) <= MOST_MISSING for gap in gaps):
        raise ValueError(content)
    return tuple(gaps)


def _count(content: Any) -> int:
    """Of frames that are missing, or, below 0, too many."""
    less = isinstance(content, int) and content < 0
    return -whole(-content) if less else whole(content)


def _factor(content: Any) -> float:
    if (factor := number(content)) <= 0.0:
        raise ValueError(content)
    return factor


def _pair(content: Any) -> tuple[float, float]:
    x, y = map(number, listed(content))
    return x, y


def _tilt(content: Any) -> tuple[float, float]:
    x, y = _pair(content)
    if not max(abs(x), abs(y)) <= STEEPEST:
        raise ValueError(content)
    return x, y


_READ: dict[str, Callable[[Any], Any]] = {
    "up": UpAxis,
    "missing": _missing,
    "trim": whole,
    "trim_end": whole,
    "mend": lambda content: tuple(map(Mend, listed(content))),
    "time_scale": _factor,
    "scale": _factor,
    "drift": _pair,
    "floor": number,
    "rise": number,
    "tilt": _tilt,
}
REPAIRS = HiddenText("repairs", _read_repairs, Repairs())


def _read_feet(content: Any) -> tuple[str, tuple[FootFault, ...]]:
    repairs, told = listed(content)
    return word(repairs), tuple(_foot_fault(*each) for each in map(listed, listed(told)))


def _foot_fault(
    kind: Any, point: Any, bone: Any, offset: Any, first: Any, last: Any, amount: Any
) -> FootFault:
    x, y, z = map(number, listed(offset))
    ends = number(first), number(last)
    return FootFault(FootFaultKind(kind), word(point), word(bone), (x, y, z), *ends, number(amount))


FEET: HiddenText[tuple[str, tuple[FootFault, ...]]] = HiddenText("feet", _read_feet, ("", ()))
FRAMES = spans_text("frames")


def text_of(repairs: Repairs) -> str:
    """Repairs as a text to be stored; "" of those that change nothing."""
    plain = {
        "up": repairs.up.value,
        "missing": [(gap.after, gap.count) for gap in repairs.missing],
        "mend": [each.value for each in repairs.mend],
    }
    held = {n: plain.get(n, value) for n, value in asdict(repairs).items() if value != USUAL[n]}
    return json.dumps(held) if held else ""


def write_diagnosis(
    armature: bpy.types.Object, diagnosis: Diagnosis, feet: tuple[FootFault, ...]
) -> None:
    """Keeps what was found, and of what. Findings whose remedy counts stay, found again or not."""
    settings = settings_of(armature)
    kept = [(finding_of(row), row.mass) for row in findings(settings) if is_applied(settings, row)]
    missing = repairs_in(settings.repairs).missing
    found = [
        _told(armature, _of_recorded(finding, missing), diagnosis.mass or 0.0)
        for finding in diagnosis.findings
    ]
    kinds = [finding.kind for finding, _ in found]
    found = [each for each in kept if each[0].kind not in kinds] + found
    rows = rows_named(settings.findings, [finding.kind.value for finding, _ in found])
    for row, (finding, mass) in zip(rows, found, strict=True):
        row.amount, row.unit, row.surplus = finding.amount, finding.unit, False
        row.frames, row.part, row.mass = json.dumps(finding.frames), finding.part, mass
        row.remedy = text_of(finding.remedy or Repairs())
        row.other = text_of(finding.alternative or Repairs())
    settings.examined = examined_key(armature)
    settings.examination_stale = False
    told = [(f.kind.value, *astuple(f)[1:]) for f in feet]
    settings.feet = json.dumps([settings.repairs, told]) if told else ""


def _of_recorded(finding: Finding, missing: tuple[MissingFrames, ...]) -> Finding:
    """With a remedy whose frames are those of the recording, as it is without what is put in."""
    remedy = finding.remedy
    if remedy is None or not (missing and remedy.missing):
        return finding
    gaps = (replace(gap, after=round(recorded_frame(gap.after, missing))) for gap in remedy.missing)
    return replace(finding, remedy=replace(remedy, missing=tuple(gaps)))


def _told(armature: bpy.types.Object, finding: Finding, mass: float) -> tuple[Finding, float]:
    """A finding as it is kept, with the mass where it is about that."""
    if finding.kind is FindingKind.BONE_LENGTH:
        finding = replace(finding, part=stretching_bone(armature, finding.part))
    return finding, mass if finding.kind is FindingKind.MASS else 0.0


def findings(settings: HangtimeSettings) -> list[HangtimeFinding]:
    """The rows of what was found."""
    return [row for row in settings.findings if is_finding(row) and not row.surplus]


def finding_named(settings: HangtimeSettings, kind: str) -> HangtimeFinding | None:
    """The row of a kind of finding; None where nothing such was found."""
    return next((row for row in findings(settings) if row.name == kind), None)


def is_finding(row: HangtimeFinding) -> bool:
    """Whether a row is Hangtime's: no script or other version wrote what is no finding."""
    remedies = [REPAIRS.is_ours(each) for each in (row.remedy, row.other)]
    known = row.name in {kind.value for kind in FindingKind}
    placed = bool(FRAMES.of(row.frames)) or not repairs_in(row.remedy).trims
    return known and FRAMES.is_ours(row.frames) and placed and all(remedies)


def finding_of(row: HangtimeFinding) -> Finding:
    """The finding in a row."""
    remedy, other = (repairs_in(each) if each else None for each in (row.remedy, row.other))
    kind, frames = FindingKind(row.name), FRAMES.of(row.frames)
    return Finding(kind, row.amount, row.unit, frames, row.part, remedy, other)


def is_applied(settings: HangtimeSettings, row: HangtimeFinding, *, other: bool = False) -> bool:
    """Whether a row's remedy counts. other: its other one."""
    if row.mass:
        return bool(abs(settings.mass - row.mass) < 0.5)
    remedy = repairs_in(row.other if other else row.remedy)
    if remedy.trims:
        span = float(settings.first_frame), float(settings.last_frame)
        return bool(settings.use_range) and is_clear(span, finding_of(row))
    return remedy != Repairs() and applied(settings).includes(remedy)


def undoubted(settings: HangtimeSettings, span: Span) -> Span:
    """A span of frames and those around it that belong to it, as far as an examination tells: what
    is beyond a leap, a jump or a rest pose says nothing of what touches in it."""
    cutting = (each for each in map(finding_of, findings(settings)) if each.kind in CUTTING)
    return belonging(span, cutting)


def foot_faults(settings: HangtimeSettings) -> tuple[FootFault, ...]:
    """The feet's faults; none where the recording was repaired otherwise since."""
    if not settings.feet or settings.examination_stale:
        return ()
    repairs, faults = FEET.of(settings.feet)
    return faults if repairs == settings.repairs else ()


def rate_unrepaired(settings: HangtimeSettings) -> float:
    """The frames a second that the scene has without the repairs that count."""
    return frames_per_second(current_scene()) * applied(settings).time_scale


def examined_key(armature: bpy.types.Object, known: KeptDigests | None = None) -> str:
    """What an examination is of: the recording's keys, the object's scale and the clock, both as
    they are without repairs. known: digests of keys that are up to date."""
    action = recorded_action(armature)
    if action is None:
        return ""
    clock = rate_unrepaired(settings_of(armature))
    scale = " ".join(f"{each:.4g}" for each in armature.scale.to_tuple())
    return f"{take_digest(armature, action, known)} {clock:.4g} {scale}"


def examined_actions(armature: bpy.types.Object) -> list[bpy.types.Action]:
    """The actions whose keys `look_at_examination` asks for."""
    action = recorded_action(armature) if settings_of(armature).examined else None
    return keyed_for(action) if action is not None else []


def look_at_examination(armature: bpy.types.Object, known: KeptDigests | None = None) -> bool:
    """Notes whether what was examined has changed; returns whether that is new. known: digests of
    keys that are up to date."""
    settings = settings_of(armature)
    stale = bool(settings.examined) and settings.examined != examined_key(armature, known)
    if stale == settings.examination_stale:
        return False
    settings.examination_stale = stale
    return True


def of_recording(armature: bpy.types.Object) -> bool:
    """Whether what is read is a recording: results that are started from need no mending."""
    action = recorded_action(armature)
    return action is not None and source_of(action) is None
