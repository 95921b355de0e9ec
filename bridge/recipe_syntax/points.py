"""A point's place that moves, and the axes that its displacement and its bounds are in."""

import math
from typing import Any

from ...solver.data.requests import Bound, Path, PointAxes, PointRequest
from .items import AGAINST, TRAVEL_KEYS, TRAVEL_WORDS, Item, Values, direction, travelled
from .table import Table, listed

AXIS_NAMES = {
    PointAxes.WORLD: ("x", "y", "z"),
    PointAxes.TRAVEL: TRAVEL_KEYS,
    PointAxes.SURFACE: ("along", "across", "out"),
}
BOUND_KEYS = ("at_least", "at_most")
NO_SURFACE = (
    '"normal" is of a surface, and this point has none; add axes = "surface" where its place or '
    "its bounds are told along one, environment = true where one pushes back, or leave it out"
)


def _read_axes(table: Table) -> Values:
    table.not_both("relative", TRAVEL_WORDS)
    names = sum(AXIS_NAMES.values(), ())
    at_least, at_most = bounds = [table.table(key, names, "axis") for key in BOUND_KEYS]
    axes = _axes(table, bounds)
    values: Values = {"axes": axes}
    if "normal" in table.values:
        if axes is not PointAxes.SURFACE and not table.flag("environment"):
            table.refuse("normal", NO_SURFACE)
        values["normal"] = direction(table, "normal")
    if "relative" in table.values:
        values["relative"] = table.vector("relative")
    elif axes is PointAxes.TRAVEL:
        values["relative"] = travelled(table)
    if set(BOUND_KEYS) & set(table.values):
        values["bounds"] = tuple(_bound(at_least, at_most, name) for name in AXIS_NAMES[axes])
        for key, bound in zip(BOUND_KEYS, bounds, strict=True):
            if key in table.values and not bound.values:
                table.refuse(key, f'"{key}" bounds no axis; give it one, such as {{ z = 0.3 }}')
    return values


def _axes(table: Table, bounds: list[Table]) -> PointAxes:
    """The axes that are written, or else those that the names of axes belong to."""
    named = [(table, key) for key in TRAVEL_WORDS if key in table.values]
    same = dict(zip(AGAINST, TRAVEL_KEYS, strict=True))
    for bound in bounds:
        named += [(bound, name) for name in bound.values]
    axes = table.choice("axes", PointAxes)
    if axes is None and named:
        first = same.get(named[0][1], named[0][1])
        axes = next(of for of, names in AXIS_NAMES.items() if first in names)
    axes = axes or PointAxes.WORLD
    known = AXIS_NAMES[axes]
    for where, name in named:
        if same.get(name, name) not in known:
            where.refuse(name, f'"{name}" is none of the {axes.value} axes: {listed(known)}')
    return axes


def _bound(at_least: Table, at_most: Table, name: str) -> Bound:
    lower, upper = at_least.number(name), at_most.number(name)
    if lower is not None and upper is not None and lower > upper:
        at_most.refuse(name, f'"{name}" at most {upper:g} is less than at least {lower:g}')
    return lower, upper


def _write_axes(record: Any) -> Values:
    point: PointRequest = record
    names = AXIS_NAMES[point.axes]
    moved = {k: v for k, v in zip(names, point.relative, strict=True) if v}
    values: Values = {"axes": point.axes.value if point.axes is not PointAxes.WORLD else None}
    if point.axes is PointAxes.TRAVEL:
        values |= moved
    elif moved:
        values["relative"] = point.relative
    values["normal"] = point.normal
    if point.bounds is not None:
        for i, key in enumerate(BOUND_KEYS):
            ends = zip(names, point.bounds, strict=True)
            values[key] = {name: bound[i] for name, bound in ends if bound[i] is not None} or None
    return values


def _read_environment(table: Table) -> Values:
    environment, grip = table.flag("environment"), table.flag("grip")
    if grip and not environment:
        table.refuse("grip", 'only what pushes back can be gripped; add "environment = true"')
    return {"environment": environment, "grip": grip}


def _write_environment(record: Any) -> Values:
    return {"environment": record.environment or None, "grip": record.grip or None}


def _read_path(table: Table) -> Values:
    if "path" not in table.values:
        return {}
    frames: list[float] = []
    places: list[tuple[float, float, float]] = []
    for entry in table.tables("path", ("frame", "place")):
        entry.needs(("frame",))
        entry.needs(("place",))
        frames.append(entry.number("frame") or 0.0)
        places.append(entry.vector("place") or (0.0, 0.0, 0.0))
        if frames[-1] <= max(frames[:-1], default=-math.inf):
            entry.refuse("frame", f"frame {frames[-1]:g} must come after the one before it")
    if not frames:
        table.refuse("path", 'an empty "path"; give it { frame = ..., place = [x, y, z] }')
    return {"path": Path(tuple(frames), tuple(places))}


def _write_path(record: Any) -> Values:
    path: Path | None = record.path
    if path is None:
        return {}
    pairs = zip(path.frames, path.places, strict=True)
    return {"path": tuple({"frame": frame, "place": place} for frame, place in pairs)}


POINT_AXES = Item(
    ("axes", "relative", *TRAVEL_WORDS, *BOUND_KEYS, "normal"), _read_axes, _write_axes
)
PATH = Item(("path",), _read_path, _write_path)
ENVIRONMENT = Item(("environment", "grip"), _read_environment, _write_environment)
