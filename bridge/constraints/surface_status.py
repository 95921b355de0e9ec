"""Outcome of a solve for each surface, for the rows of their list."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from ...solver.data.reports.constraints import ConstraintReport
from ...solver.data.reports.report import Report
from ...solver.data.scene import CLEARANCE, SceneObject
from ..properties.of_actions.shown_overlaps import IN
from ..properties.settings import HangtimeSettings
from ..rows.choices import Met
from ..scene.members import objects_of

KEPT_OUT = "Nothing new is in it"


def write_surface_status(
    settings: HangtimeSettings,
    report: Report,
    remarks: Mapping[str, str],
    stale: Collection[str] = (),
    scene: Collection[SceneObject] = (),
) -> None:
    """Sets every row's `met` and `status`. remarks: what else there is to say, by object. stale:
    objects that are others by now, so that it is not known what is in them. scene: what was
    solved among."""
    for row in settings.surfaces:
        names = {each.name_full for each in objects_of(row)}
        parts = {each.name for each in scene if each.whole in names}
        called, deepest = {*names, row.called}, _deepest(report, names | parts)
        met, status = Met.UNKNOWN, ""
        if deepest is not None:
            met, status = Met.MISSED, _in_the_way(deepest)
        elif settings.keep_out and called.isdisjoint(stale):
            met, status = Met.MET, KEPT_OUT
        said = [remark for name, remark in remarks.items() if name in called]
        told = ". ".join([each for each in (status, *said[:1]) if each])
        row.met, row.status = (met.name, told) if row.used else (Met.UNKNOWN.name, "")


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
