"""The lists of constraints and body changes as the solver's requests.

Each kind of constraint makes its own record. Blender units become metres; rows that are switched
off are left out.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from typing import Any

import bpy

from ...solver.data.faults import NamedTwice, NameMissing
from ...solver.data.requests import BodyChange, Path, Requests
from ..accessors import current_scene
from ..armature.poses import frames_per_second, metres_per_unit
from ..constraint_kinds import KINDS, hold, timing
from ..properties.body_change import HangtimeBodyChange
from ..properties.constraint import HangtimeConstraint
from ..properties.settings import HangtimeSettings
from ..rows.choices import BodyKind
from ..rows.phases import listed
from ..rows.row_parts import RowContext
from ..rows.times import Clip
from .body_requests import body_change, shapes_of
from .target_paths import Durations, paths_of


def requests_of(
    settings: HangtimeSettings,
    armature: bpy.types.Object,
    span: tuple[float, float] | None = None,
    *,
    beside: Requests | None = None,
    paths: Mapping[str, Path] | None = None,
) -> Requests:
    """What the artist's lists ask for.

    span: first and last scene frame of the recording; None takes the analysed clip's. beside: what
    else is asked for, with other durations as well. paths: of points that follow a target, by their
    rows' names, where they were taken before. The scene's frame is afterwards what it was. Raises
    NameMissing, NamedTwice, NoBoneChosen, UnknownBone, NoPhaseChosen, UnknownPhaseIn, EmptyRange,
    CrossedBounds, AsksNothing, NoDirection.
    """
    rows = [row for row in settings.constraints if row.used]
    changes = [row for row in settings.body_changes if row.used]
    _require_names([*rows, *changes], [row.name for row in listed(settings)])
    clip = Clip.of(settings, span)
    metres = metres_per_unit(current_scene())
    own = metres * armature.matrix_world.median_scale
    context = RowContext(armature, clip, metres, own, {})
    durations = _durations(rows, context, beside or Requests(), keep=settings.keep_times)
    context = replace(context, paths=paths_of(rows, clip, metres, durations, paths or {}))
    made: dict[str, list[Any]] = {}
    for row in rows:
        kind = KINDS[row.kind]
        made.setdefault(kind.requests, []).append(kind.record(row, context))
    lists: dict[str, Any] = {field: tuple(records) for field, records in made.items()}
    shapes = shapes_of(changes, context)
    return Requests(**lists, shapes=shapes, body=body_change(settings, changes, context))


def _durations(
    rows: list[HangtimeConstraint], context: RowContext, beside: Requests, *, keep: bool
) -> Durations:
    """What the rows and what is asked for beside them change of durations. keep: whether the artist
    keeps those that neither names."""
    holds = [hold.KIND.record(row, context) for row in rows if row.kind == hold.KIND.name]
    timings = [timing.KIND.record(row, context) for row in rows if row.kind == timing.KIND.name]
    return Durations(
        frames_per_second(current_scene()),
        (*holds, *beside.holds),
        (*timings, *beside.timings),
        free=not (keep or beside.solution.keep_times),
    )


def joined(first: Requests, second: Requests) -> Requests:
    """Both; how to solve, and a mass or a gravity that both give, is the second's.

    Raises NamedTwice.
    """
    refuse_same_names([*first.names, *second.names])
    usual = BodyChange()
    mass = first.body.mass if second.body.mass is None else second.body.mass
    same = second.body.gravity == usual.gravity
    body = BodyChange(
        mass=mass,
        gravity=first.body.gravity if same else second.body.gravity,
        added=first.body.added + second.body.added,
        limbs=first.body.limbs + second.body.limbs,
    )
    lists = [f.name for f in fields(Requests) if f.name not in ("body", "solution")]
    both = {name: getattr(first, name) + getattr(second, name) for name in lists}
    return Requests(**both, body=body, solution=second.solution)


def refuse_same_names(names: Iterable[str]) -> None:
    """Raises NamedTwice."""
    for name, count in Counter(names).items():
        if count > 1:
            raise NamedTwice(name)


def _require_names(
    rows: list[HangtimeConstraint | HangtimeBodyChange], contacts: list[str]
) -> None:
    labels = {
        **{kind.name: kind.label for kind in KINDS.values()},
        **{kind.name: kind.value for kind in BodyKind},
    }
    for row in rows:
        if not row.name.strip():
            raise NameMissing(labels[row.kind])
    names = [row.name for row in rows]
    refuse_same_names([*names, *(set(contacts) & set(names))])
