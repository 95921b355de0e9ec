"""The charts that are switched on, of an armature's motions, with the bounds set on them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from ...solver.data.traces import Traces
from ..accessors import armature_data
from ..armature.traces_store import StoredTraces, kept
from ..constraint_kinds import contact_force, torque_limit
from ..properties.constraint import HangtimeConstraint
from ..properties.settings import HangtimeSettings, settings_of
from ..properties.view import HangtimeView
from ..rows.phases import PhaseSpan, carried, clip_ends, phases
from ..rows.times import Spans, interval_of
from .curves import Cap, Chart, Take, force_chart, height_chart, speed_chart, torque_chart

INSTANT_MARGIN = 0.5  # frames to either side of an instant, so that its bound is seen


@dataclass(frozen=True)
class PlotContent:
    """Key of the plots: equal as long as they are. motions: as they are stored, by key."""

    motions: tuple[tuple[Take, str], ...]
    bone: str
    forces: bool
    torque: bool
    com: bool
    phases: tuple[PhaseSpan, ...]
    force_caps: tuple[Cap, ...]
    torque_caps: tuple[Cap, ...]


@dataclass(frozen=True)
class PlottedMotions:
    """The motions to be plotted, and what of them."""

    content: PlotContent
    takes: dict[Take, Traces]

    def charts(self) -> tuple[Chart, ...]:
        """The charts that are switched on, from left to right."""
        takes, content = self.takes, self.content
        charts = []
        if content.forces:
            charts.append(force_chart(takes, content.force_caps))
        if content.torque:
            charts.append(torque_chart(takes, content.bone, content.torque_caps))
        if content.com:
            charts += [height_chart(takes), speed_chart(takes)]
        return tuple(charts)


@dataclass(frozen=True)
class _Times:
    """The phases by name, and the motion whose apexes they have."""

    phases: Spans
    motion: Traces | None


def plotted(armature: bpy.types.Object, view: HangtimeView) -> PlottedMotions | None:
    """Motions and charts of an armature; None where no motion of it is stored."""
    motions = kept_takes(armature)
    if not motions:
        return None
    takes = {take: kept.traces for take, kept in motions.items()}
    bone = view.plot_bone or _active_bone(armature)
    settings = settings_of(armature)
    spans = _phases(settings, takes)
    times = _Times(
        {phase.name: (phase.start, phase.end) for phase in spans},
        takes.get(Take.ADAPTED, takes.get(Take.RECORDING)),
    )
    rows = [row for row in settings.constraints if row.used]
    content = PlotContent(
        motions=tuple((take, kept.key) for take, kept in motions.items()),
        bone=bone,
        forces=view.plot_forces,
        torque=view.plot_torque,
        com=view.plot_com,
        phases=spans,
        force_caps=tuple(
            cap for row in rows if _caps_forces(row) for cap in _caps(row, row.peak, times)
        ),
        torque_caps=tuple(
            cap
            for row in rows
            if _caps_torque(row, bone)
            for cap in _caps(row, row.torque + abs(row.torque_value), times)
        ),
    )
    return PlottedMotions(content, takes)


def kept_takes(armature: bpy.types.Object) -> dict[Take, StoredTraces]:
    """The motions of an armature of which traces are stored."""
    owners = {Take.RECORDING: armature, Take.ADAPTED: settings_of(armature).adapted}
    found = {take: kept(owner) for take, owner in owners.items()}
    return {take: traces for take, traces in found.items() if traces is not None}


def _phases(settings: HangtimeSettings, takes: dict[Take, Traces]) -> tuple[PhaseSpan, ...]:
    """The adapted motion's, which may be retimed; before there is one, the recording's."""
    adapted = takes.get(Take.ADAPTED)
    if adapted is not None:
        first, last = float(adapted.frames[0]), float(adapted.frames[-1])
        edges = [first, *(e for f in adapted.flights for e in (f.start, f.end)), last]
        return phases(zip(edges[::2], edges[1::2], strict=True), first, last)
    ends = clip_ends(settings)
    return phases(carried(settings), *ends) if ends is not None else ()


def _active_bone(armature: bpy.types.Object) -> str:
    bone = armature_data(armature).bones.active
    return bone.name if bone is not None else ""


def _caps_forces(row: HangtimeConstraint) -> bool:
    return bool(row.kind == contact_force.KIND.name and row.use_peak)


def _caps_torque(row: HangtimeConstraint, bone: str) -> bool:
    """Whether it bounds the bone's torque by a number; shares are of a torque not stored."""
    mine = row.kind == torque_limit.KIND.name and any(b.name == bone for b in row.bones)
    return mine and row.torque_by == torque_limit.TorqueBy.NEWTON_METRES.name


def _caps(row: HangtimeConstraint, level: float, times: _Times) -> Iterator[Cap]:
    """A row's bound as it is drawn: an instant's a frame wide, so that it is seen."""
    first, last = interval_of(row, times.phases, times.motion)
    if first == last:
        first, last = first - INSTANT_MARGIN, last + INSTANT_MARGIN
    if first <= last:  # its phase is there
        yield Cap(row.name, first, last, level)
