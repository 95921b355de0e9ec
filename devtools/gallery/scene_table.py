"""The second part of docs/gallery.md: results in a scene of objects."""

from collections.abc import Iterator, Sequence

from .jobs import Json
from .limits import DEPTH, RESIDUALS, STANDING, deepest, faults, furthest_off
from .table import cells

SCENE_HEAD = "## The scene"
NOTES = f"""
`python3 dev.py gallery --scene` makes these alone: recipes in `examples/world` with objects as
meshes, still or moving. *Deepest* is what anything of the body is deeper in the floor and in itself
than in the fit, or is in the scene at all, by MuJoCo's distances at every frame of the written
action (must {DEPTH.must:g} mm). *Off its face* is how far points that stand on an object are from
its faces, likewise (must {STANDING.must:g} mm).
"""
COLUMNS = (
    "result",
    "implicit (q, λ)",
    "flight",
    "ground",
    "deepest (mm)",
    "off its face (mm)",
    "worst constraint",
    "force (BW)",
    "from the fit",
    "",
)


def scene_section(rows: Sequence[Json]) -> str:
    """The part of the page; rows: of results in a scene."""
    return "\n".join([SCENE_HEAD, NOTES, *_limits(rows), "", *_table(rows)]) + "\n"


def _limits(rows: Sequence[Json]) -> Iterator[str]:
    good = sum(not faults(row) for row in rows)
    yield "| figure | found | must | aim |"
    yield "|---|---|---|---|"
    yield f"| results in order | {good} of {len(rows)} | {len(rows)} | {len(rows)} |"
    for key, limit in RESIDUALS.items():
        values = [row["residuals"][key] for row in rows if "residuals" in row]
        if values:
            name = f"{key.replace('_', ', ')} ({limit.unit}), worst"
            yield f"| {name} | {max(values):.2g} | {limit.must:g} | {limit.aim:g} |"


def _table(rows: Sequence[Json]) -> Iterator[str]:
    yield f"| {' | '.join(COLUMNS)} |"
    yield f"|{'---|' * len(COLUMNS)}"
    for row in rows:
        yield f"| {' | '.join(_cells(row))} |"


def _cells(row: Json) -> Iterator[str]:
    name, _, implicit, _, _, flight, ground, missed, _, force, away, verdict = cells(row)
    yield from (name, implicit, flight, ground)
    for value in (deepest(row), furthest_off(row)):
        yield "" if value is None else f"{value:.1f}"
    yield from (missed, force, away, verdict)
