"""Limits of the gallery, and the verdicts on a result and on the whole."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import median

from ...solver.human.human_guard import MOST_BEYOND
from .jobs import Json, Page

METHODS = ("implicit", "implicit with torques", "explicit")


@dataclass(frozen=True)
class GalleryLimit:
    """Upper bound that a number must keep, and the one that is aimed at."""

    unit: str
    must: float
    aim: float


SLACK = {
    "mm": 1.0,
    "degrees": 0.5,
    "N·m": 0.2,  # of a limp joint's numerical slack; the moment that may be left makes three of it
    "% of the bound": 1.0,
}  # of a constraint, by its unit
RESIDUALS = {
    "flight_force": GalleryLimit("BW", 0.003, 0.0005),
    "flight_moment": GalleryLimit("BW·m", 0.001, 0.0003),
    "ground_force": GalleryLimit("BW", 0.02, 0.005),
}
SECONDS = {
    "implicit": GalleryLimit("s", 0.5, 0.1),
    "implicit with torques": GalleryLimit("s", 2.0, 0.5),
    "explicit": GalleryLimit("s", 15.0, 5.0),
}
MEMORY = GalleryLimit("GB", 1.0, 0.4)
LOOKS = {  # what a picture must not show, at any instant
    "overlap_cm": GalleryLimit("cm that limbs are in each other, beyond the fit", 0.5, 0.1),
    "below_floor_cm": GalleryLimit("cm under the floor", 2.0, 0.0),
    "jerk": GalleryLimit("times the fit's sharpest acceleration", 2.5, 1.0),
}
DEPTH = GalleryLimit("mm", 5.0, 1.0)  # by which anything is in floor, scene or body, by MuJoCo
STANDING = GalleryLimit("mm", 2.0, 0.5)  # that a foot stands off the face it was put on
LEAST_KNEE = -math.degrees(MOST_BEYOND)  # below zero a knee is bent backwards; ranges let that be


@dataclass(frozen=True)
class GalleryFigure:
    """One measured number. must, aim: None where it is only told. result: whose, "all" of them."""

    name: str
    value: float | None
    unit: str
    must: float | None
    aim: float | None
    ok: bool
    result: str


def all_conditions(row: Json) -> list[Json]:
    """Of every constraint its worst violation, contacts in Blender among them."""
    return [*row.get("conditions", ()), *row.get("checks", ())]


def worst(row: Json) -> Json | None:
    """The constraint that is missed most, as a share of its slack."""
    return max(
        all_conditions(row), key=lambda c: c["worst"] / SLACK.get(c["unit"], 0.01), default=None
    )


def faults(row: Json) -> list[str]:
    """Faults of a result in words; empty where it has none."""
    found = [row["failed"]] if "failed" in row else []
    first = row.get("methods", {}).get("implicit", {})
    if not first.get("solved", False) and not found:
        found.append(f"not solved ({first.get('status', 'no result')})")
    for c in all_conditions(row):
        if not c["worst"] <= SLACK.get(c["unit"], 0.01):
            found.append(f"{c['name']}: {c['worst']:.3g} {c['unit']} off, by {c['by']}")
    for name, limit in RESIDUALS.items():
        value = row.get("residuals", {}).get(name)
        if value is not None and not value <= limit.must:
            found.append(f"{name.replace('_', ' ')} {value:.2g} {limit.unit}")
    found += [*_penetrations(row), *_ugly(row.get("looks", {}))]
    for method, solved in row.get("methods", {}).items():
        if not solved.get("solved", True) and method != "implicit":
            found.append(f"{method}: {solved['status']}")
        if solved.get("peak_memory_gb", 0.0) > MEMORY.must:
            found.append(f"{method}: {solved['peak_memory_gb']:.2f} GB")
    return found


def _penetrations(row: Json) -> Iterator[str]:
    """What is in each other, and what does not stand where it should, in words."""
    for each in row.get("penetrations", ()):
        if not each["deeper_mm"] <= DEPTH.must:
            yield f"{each['what']} by {each['deeper_mm']:.1f} mm at frame {each['frame']:g}"
    for each in row.get("standing", ()):
        if not each["off_mm"] <= STANDING.must:
            yield f"{each['contact']} {each['off_mm']:.1f} mm off {each['object']}"


def deepest(row: Json) -> float | None:
    """mm that anything of a result is deeper in something than its fit; None where not measured."""
    return max((each["deeper_mm"] for each in row.get("penetrations", ())), default=None)


def furthest_off(row: Json) -> float | None:
    """mm that a foot of a result stands off its face; None where none was put on one."""
    return max((each["off_mm"] for each in row.get("standing", ())), default=None)


def _ugly(looks: Json) -> Iterator[str]:
    """Visible defects in words."""
    for name, limit in LOOKS.items():
        if name in looks and not looks[name] <= limit.must:
            where = looks.get(f"{name.removesuffix('_cm')}_at", "")
            yield f"{looks[name]:.2g} {limit.unit} ({where})"
    if looks.get("least_knee_deg", 0.0) < LEAST_KNEE:
        yield f"a knee is bent backwards by {-looks['least_knee_deg']:.1f}°"


def figures(rows: Sequence[Json]) -> list[GalleryFigure]:
    """Every number of every result, and over all of them what has a limit."""
    found = [figure for row in rows for figure in _of(row)]
    adapted = thesis(rows)
    parts = {"results in order": adapted, "in a scene in order": of_page(rows, Page.SCENE)}
    found += [_in_order(name, mine) for name, mine in parts.items() if mine]
    for method, limit in SECONDS.items():
        if taken := times(adapted, method):
            found.append(_figure(f"{method}, median", median(taken), limit, "all"))
    return found


def thesis(rows: Sequence[Json]) -> list[Json]:
    """The thesis's results that are no fits."""
    return [row for row in of_page(rows, Page.THESIS) if not row["name"].endswith("_fit")]


def of_page(rows: Sequence[Json], page: Page) -> list[Json]:
    """The results of one page."""
    return [row for row in rows if row["page"] == page.value]


def _in_order(name: str, rows: Sequence[Json]) -> GalleryFigure:
    good, count = sum(not faults(row) for row in rows), len(rows)
    return GalleryFigure(name, good, "1", count, count, good == count, "all")


def times(rows: Sequence[Json], method: str) -> list[float]:
    """Seconds by a method, of the results that have them."""
    return [s for row in rows if (s := of_method(row, method, "seconds")) is not None]


def of_method(row: Json, method: str, key: str) -> float | None:
    """What a method's solve of a result took or had; None where it has none."""
    value: float | None = row.get("methods", {}).get(method, {}).get(key)
    return value


def _of(row: Json) -> Iterator[GalleryFigure]:
    name = row["name"]
    good = not faults(row)
    yield GalleryFigure("in order", float(good), "1 = yes", 1.0, 1.0, good, name)
    for key, limit in RESIDUALS.items():
        if key in row.get("residuals", {}):
            yield _figure(key.replace("_", " "), row["residuals"][key], limit, name)
    for method, solved in row.get("methods", {}).items():
        if "seconds" in solved:
            yield _told(f"{method}: time", solved["seconds"], "s", name)
            yield _told(f"{method}: iterations", solved["iterations"], "1", name)
            yield _told(f"{method}: unknowns", solved["unknowns"], "1", name)
            yield _told(f"{method}: constraints", solved["rows"], "1", name)
            yield _figure(f"{method}: peak memory", solved["peak_memory_gb"], MEMORY, name)
    for c in all_conditions(row):
        slack = SLACK.get(c["unit"], 0.01)
        label = f"{c['kind']}: {c['name']}"
        yield GalleryFigure(label, c["worst"], c["unit"], slack, None, c["worst"] <= slack, name)
    for key, measured, limit in (
        ("deepest penetration", deepest(row), DEPTH),
        ("off its face", furthest_off(row), STANDING),
    ):
        if measured is not None:
            yield _figure(key, measured, limit, name)
    for part in ("loads", "from_fit", "shape", "looks"):
        for key, value in row.get(part, {}).items():
            if isinstance(value, float):
                yield _told(key, value, "", name)


def _figure(name: str, value: float, limit: GalleryLimit, result: str) -> GalleryFigure:
    ok = bool(value <= limit.must)
    finite = value if math.isfinite(value) else None
    return GalleryFigure(name, finite, limit.unit, limit.must, limit.aim, ok, result)


def _told(name: str, value: float, unit: str, result: str) -> GalleryFigure:
    return GalleryFigure(name, float(value), unit, None, None, True, result)
