"""Repairs and findings as the armature's settings hold them: the recording's keys never change."""

from __future__ import annotations

import json
from dataclasses import asdict, astuple, replace

import bpy

from ...solver.data.problem import Mend
from ...solver.doctor.examination.diagnose import Diagnosis
from ...solver.doctor.feet import FootFault, FootFaultKind
from ...solver.doctor.finding import Finding, FindingKind
from ...solver.doctor.repairs import MissingFrames, Repairs, UpAxis
from ..accessors import current_scene, source_of
from ..armature.actions import recorded_action
from ..armature.poses import frames_per_second
from ..properties.settings import HangtimeSettings, settings_of
from ..rows.copying import resized
from ..rows.finding import HangtimeFinding
from ..takes.takes import take_digest

USUAL = asdict(Repairs())


def applied(settings: HangtimeSettings) -> Repairs:
    """The repairs that count: poses are mended and drift is left out as the recording is read;
    turn, size, floor and clock are what the scene has (placed_armature.py)."""
    return repairs_in(settings.repairs)


def repairs_to_write(settings: HangtimeSettings) -> Repairs | None:
    """The repairs for a recipe; None where there are none."""
    return applied(settings) if settings.repairs else None


def unreadable(settings: HangtimeSettings) -> bool:
    """Whether a script, or a version that knows other repairs, stored what cannot be read."""
    return bool(settings.repairs) and applied(settings) == Repairs()


def repairs_in(stored: str) -> Repairs:
    """Repairs in a stored text; those that change nothing in an empty one, and in one that cannot
    be read, which `unreadable` tells."""
    try:
        held = {**USUAL, **json.loads(stored or "{}")}
        mend, (x, y) = tuple(map(Mend, held["mend"])), map(float, held["drift"])
        missing = tuple(MissingFrames(int(after), int(n)) for after, n in held["missing"])
        read = {"up": UpAxis(held["up"]), "missing": missing, "mend": mend, "drift": (x, y)}
        return Repairs(**{**held, **read})
    except (ValueError, TypeError):
        return Repairs()


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
    found = [
        (finding, diagnosis.mass or 0.0 if finding.kind is FindingKind.MASS else 0.0)
        for finding in diagnosis.findings
    ]
    kinds = [finding.kind for finding, _ in found]
    found = [each for each in kept if each[0].kind not in kinds] + found
    rows = resized(settings.findings, len(found))
    for row, (finding, mass) in zip(rows, found, strict=True):
        row.name, row.amount, row.unit = finding.kind.value, finding.amount, finding.unit
        row.frames, row.part, row.mass = json.dumps(finding.frames), finding.part, mass
        row.remedy = text_of(finding.remedy or Repairs())
        row.other = text_of(finding.alternative or Repairs())
    settings.examined = examined_key(armature)
    settings.examination_stale = False
    told = [(f.kind.value, *astuple(f)[1:]) for f in feet]
    settings.feet = json.dumps([settings.repairs, told]) if told else ""


def findings(settings: HangtimeSettings) -> list[HangtimeFinding]:
    """The rows of what was found."""
    return [row for row in settings.findings if row.name]


def finding_of(row: HangtimeFinding) -> Finding:
    """The finding in a row."""
    remedy, other = (repairs_in(each) if each else None for each in (row.remedy, row.other))
    frames = tuple((first, last) for first, last in json.loads(row.frames or "[]"))
    kind = FindingKind(row.name)
    return Finding(kind, row.amount, row.unit, frames, row.part, remedy, other)


def is_applied(settings: HangtimeSettings, row: HangtimeFinding, *, other: bool = False) -> bool:
    """Whether a row's remedy counts. other: its other one."""
    if row.mass:
        return bool(abs(settings.mass - row.mass) < 0.5)
    remedy = repairs_in(row.other if other else row.remedy)
    if remedy.trim:
        last = json.loads(row.frames)[0][-1]
        return bool(settings.use_range and settings.first_frame > last)
    return remedy != Repairs() and applied(settings).includes(remedy)


def foot_faults(settings: HangtimeSettings) -> tuple[FootFault, ...]:
    """The feet's faults; none where the recording was repaired otherwise since."""
    if not settings.feet or settings.examination_stale:
        return ()
    repairs, told = json.loads(settings.feet)
    if repairs != settings.repairs:
        return ()
    faults = (FootFault(FootFaultKind(kind), *rest) for kind, *rest in told)
    return tuple(replace(f, offset=(f.offset[0], f.offset[1], f.offset[2])) for f in faults)


def rate_unrepaired(settings: HangtimeSettings) -> float:
    """The frames a second that the scene has without the repairs that count."""
    return frames_per_second(current_scene()) * applied(settings).time_scale


def examined_key(armature: bpy.types.Object) -> str:
    """What an examination is of: the recording's keys, the object's scale and the clock, both as
    they are without repairs."""
    action = recorded_action(armature)
    if action is None:
        return ""
    clock = rate_unrepaired(settings_of(armature))
    scale = " ".join(f"{each:.4g}" for each in armature.scale.to_tuple())
    return f"{take_digest(armature, action)} {clock:.4g} {scale}"


def look_at_examination(armature: bpy.types.Object) -> bool:
    """Notes whether what was examined has changed; returns whether that is new."""
    settings = settings_of(armature)
    stale = bool(settings.examined) and settings.examined != examined_key(armature)
    if stale == settings.examination_stale:
        return False
    settings.examination_stale = stale
    return True


def of_recording(armature: bpy.types.Object) -> bool:
    """Whether what is read is a recording: results that are started from need no mending."""
    action = recorded_action(armature)
    return action is not None and source_of(action) is None
