"""Outcome of a solve for each constraint and body change, for the rows of their lists."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

import numpy as np

from ...solver.data.reports.jumps import TimeMap
from ...solver.data.reports.report import Report
from ...solver.data.row_kinds import RowKind
from ..properties.body_change import HangtimeBodyChange
from ..properties.constraint import HangtimeConstraint
from ..properties.settings import HangtimeSettings
from ..rows.choices import Met, Span
from .body_requests import leaves_limb

MET = "Met"
PINNED = 1.0  # mm; a point that something holds from outside and that is nearer is held
CENTIMETRES = 20.0  # mm, from which on lengths are told in these
UNITS = {  # after an amount, where not the report's own
    RowKind.TORQUE: " N·m",
    RowKind.PEAK: " body weights",
    **dict.fromkeys((k for k in RowKind if k.reported_unit == "degrees"), "°"),
}


def write_status(settings: HangtimeSettings, report: Report) -> None:
    """Sets every row's `met` and `status` from a solve's report."""
    found: dict[str, tuple[bool, str]] = {}
    for contact in report.contacts:
        off = contact.worst_violation_mm
        found[contact.name] = _told(off <= PINNED, off, RowKind.PIN, contact.worst_violation_frame)
    for each in report.conditions:
        found[each.name] = _told(
            each.met, each.worst_violation, each.kind, each.worst_violation_frame
        )
    retimed = retimed_frames(settings, report.times)
    for row in (*settings.constraints, *settings.body_changes):
        row.met, status = _status(row, found)
        row.status = status + retimed.get(row.name, "") if status == MET else status


def _status(
    row: HangtimeConstraint | HangtimeBodyChange, found: Mapping[str, tuple[bool, str]]
) -> tuple[str, str]:
    if not row.used:
        return Met.UNKNOWN.name, ""
    if isinstance(row, HangtimeBodyChange) and leaves_limb(row):
        return Met.UNKNOWN.name, "Changes nothing yet"
    # What has no condition of its own shapes the problem, so it holds in every solution.
    met, status = found.get(row.name, (True, "Applied"))
    return (Met.MET if met else Met.MISSED).name, status


def retimed_frames(settings: HangtimeSettings, times: TimeMap) -> dict[str, str]:
    """At which of the result's frames constraints hold, by name, where those are not the rows' own,
    which are the recording's: " at frame 1040.5 (the recording's 1039)"."""
    told = {row.name: _retimed(row, times) for row in settings.constraints if row.used}
    return {name: at for name, at in told.items() if at}


def _retimed(row: HangtimeConstraint, times: TimeMap) -> str:
    frames = {Span.FRAME: [row.first_frame], Span.FRAMES: [row.first_frame, row.last_frame]}
    ends = times.recorded_frame[0], times.recorded_frame[-1]
    own = np.clip(frames.get(Span[row.span], []), *ends).tolist()
    held = np.interp(own, times.recorded_frame, times.adapted_frame).tolist()
    if all(_frame(now) == _frame(then) for now, then in zip(held, own, strict=True)):
        return ""
    now, then = (" to ".join(map(_frame, each)) for each in (held, own))
    return f" at frame{'s' * (len(own) > 1)} {now} (the recording's {then})"


def _frame(frame: float) -> str:
    return f"{frame:.1f}".removesuffix(".0")


def _told(met: bool, amount: float, kind: RowKind, frame: float) -> tuple[bool, str]:
    if met:
        return True, MET
    unit = UNITS.get(kind, f" {kind.reported_unit}")
    if unit == " mm" and amount >= CENTIMETRES:
        amount, unit = amount / 10.0, " cm"
    by = f" by {_rounded(amount)}{unit}" if isfinite(amount) else ""
    return False, f"Missed{by} at frame {frame:.0f}"


def _rounded(amount: float) -> str:
    return f"{amount:.0f}" if amount >= 10.0 else f"{amount:.2g}"
