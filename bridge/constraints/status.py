"""What a solve made of each constraint and body change, for the rows of their lists."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..properties.body_change import HangtimeBodyChange
from ..properties.constraint import HangtimeConstraint
from ..properties.settings import HangtimeSettings
from ..rows.choices import Met
from .body_requests import leaves_limb

PINNED = 1.0  # mm; a point that something holds from outside and that is nearer is held
WORDS = {  # of the report's units
    "degrees": "°",
    "N·m beyond the limit": " N·m",
    "BW beyond the cap": " body weights",
}


def write_status(settings: HangtimeSettings, report: Mapping[str, Any]) -> None:
    """Sets every row's `met` and `status` from a solve's report (solver/results/report.py)."""
    found: dict[str, tuple[bool, str]] = {}
    for contact in report["contacts"]:
        off = contact["worst_violation_mm"]
        found[contact["name"]] = _told(
            met=off <= PINNED, amount=off, unit="mm", frame=contact["worst_violation_frame"]
        )
    for condition in report["conditions"]:
        found[condition["name"]] = _told(
            met=condition["met"],
            amount=condition["worst_violation"],
            unit=condition["unit"],
            frame=condition["worst_violation_frame"],
        )
    for row in (*settings.constraints, *settings.body_changes):
        row.met, row.status = _status(row, found)


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


def _told(*, met: bool, amount: float | None, unit: str, frame: float) -> tuple[bool, str]:
    if met:
        return True, "Met"
    by = "" if amount is None else f" by {_rounded(amount)}{WORDS.get(unit, f' {unit}')}"
    return False, f"Missed{by} at frame {frame:.0f}"


def _rounded(amount: float) -> str:
    return f"{amount:.0f}" if amount >= 10.0 else f"{amount:.2g}"
