"""Outcome of a solve for each surface, for the rows of their list."""

from __future__ import annotations

from collections.abc import Mapping

from ...solver.data.reports.constraints import ConstraintReport
from ...solver.data.reports.report import Report
from ...solver.data.scene import CLEARANCE
from ..properties.of_actions.shown_overlaps import IN
from ..properties.settings import HangtimeSettings
from ..rows.choices import Met
from ..scene.members import objects_of

KEPT_OUT = "Nothing new is in it"


def write_surface_status(
    settings: HangtimeSettings, report: Report, remarks: Mapping[str, str]
) -> None:
    """Sets every row's `met` and `status`. remarks: what else there is to say, by object."""
    for row in settings.surfaces:
        names = {each.name_full for each in objects_of(row)}
        said = [remark for name, remark in remarks.items() if name in names or name == row.called]
        deepest = _deepest(report, names)
        if not row.used:
            row.met, row.status = Met.UNKNOWN.name, ""
        elif deepest is not None:
            row.met, row.status = Met.MISSED.name, _in_the_way(deepest)
        elif said:
            row.met, row.status = Met.UNKNOWN.name, said[0]
        elif settings.keep_out:
            row.met, row.status = Met.MET.name, KEPT_OUT
        else:
            row.met, row.status = Met.UNKNOWN.name, ""
        row.name = row.called


def _deepest(report: Report, names: set[str]) -> ConstraintReport | None:
    called = names | {CLEARANCE.format(name) for name in names}
    inside = (each for each in report.overlaps if each.name.partition(IN)[2] in called)
    return max(inside, key=lambda each: each.worst_violation, default=None)


def _in_the_way(overlap: ConstraintReport) -> str:
    body, _, where = overlap.name.partition(IN)
    what = "Not cleared" if where.startswith(CLEARANCE.format("")) else "In the way"
    return (
        f"{what}: {body} {overlap.worst_violation:.0f} mm "
        f"at frame {overlap.worst_violation_frame:.0f}"
    )
