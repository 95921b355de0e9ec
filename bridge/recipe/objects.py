"""Objects of the scene in a recipe.

[[object]]                      # a solid of the scene, by its name
name = "Crate"
role = "ground"                 # feet land on it (default), or "obstacle"
box = [0.6, 0.5, 0.3]           # m, along its x, y and z; or
ramp = [1.2, 0.8, 0.3]          # length along x, width, and height to which it rises; or
file = "crate.obj"              # relative to the recipe; metres, Z up; or
points = [[0, 0, 0], ...]       # m, with faces = [[0, 1, 2], ...], counter-clockwise from outside
place = [1, 0, 0]               # m, world: of its origin, which is the middle of a box's or a
                                # ramp's base; default: [0, 0, 0]
turn = 90                       # degrees, counter-clockwise from above
axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]   # or its turn as a matrix, in rows
path = [{ frame = 1, place = [0, 0, 0], turn = 0 }, { frame = 50, place = [2, 0, 0] }]  # it moves
under = "Landing"               # instead of place: its top (in its middle) is where that pin's
                                # contacts land, of hands where the palms rest, x ahead; or
                                # under = "flight 1": on the floor below the highest point of it
forward = 0.2                   # m from there along the travel; left, up, back, right, down

How it moves beside its path is in object_rates.py.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...solver.analysis.analyse import Analysis
from ...solver.analysis.performance import above_ground
from ...solver.analysis.pins.pinned_places import (
    chosen_contacts,
    phase_of,
    pinned_places,
    travel_axes,
)
from ...solver.arrays import FloatArray, IntArray
from ...solver.data.contacts import Phase, PhaseKind
from ...solver.data.faults import NoFaceThere, UnknownPhaseIn
from ...solver.data.problem import MotionProblem
from ...solver.data.scene import SceneObject, SceneRole
from ...solver.numerics.rotations import axis_rotation
from ...solver.scene.triangle_mesh import placed_mesh
from ..formats.obj import UnreadableMesh, read_obj
from ..formats.paths import unreadable
from ..recipe_syntax.items import TRAVEL_WORDS, travelled
from ..recipe_syntax.table import Table, shown
from ..shapes.boxes import SOLIDS
from .object_rates import RATE_KEYS, read_rates

HEADER = "object"
SHAPES = ("box", "ramp", "file", "points")
PLACING = ("place", "axes", "path")
KEYS = ("name", "role", *SHAPES, "faces", *PLACING, "turn", "under", *TRAVEL_WORDS, *RATE_KEYS)
PATH_KEYS = ("frame", "place", "turn", "axes")


@dataclass(frozen=True)
class Under:
    """An object that is yet to be placed: under a pin's contacts, or the top of a flight.

    what: the name of either. offset: (3,) m forward, left and up of there.
    """

    thing: SceneObject
    what: str
    offset: tuple[float, float, float]


def read_objects(top: Table) -> tuple[tuple[SceneObject, ...], tuple[Under, ...]]:
    """Objects with their places, and those whose places the analysis tells. Raises BadRecipe."""
    placed, under = [], []
    for i, table in enumerate(top.tables(HEADER, KEYS)):
        thing = _read(table, table.word("name") or default_name(i))
        what = table.word("under")
        if what is None:
            for key in TRAVEL_WORDS:
                if key in table.values:
                    table.refuse(key, f'"{key}" is from what the object is "under"; add that')
            placed.append(thing)
        else:
            table.not_both("under", PLACING)
            under.append(Under(thing, what, travelled(table)))
    return tuple(placed), tuple(under)


def object_files(values: Mapping[str, Any], path: str | Path) -> tuple[Path, ...]:
    """The files that a recipe's objects are read from. values: of its text. path: of its file."""
    things = values.get(HEADER, ())
    return tuple(Path(path).parent / thing["file"] for thing in things if "file" in thing)


def default_name(i: int) -> str:
    """Default name of the i-th (from 0) object."""
    return f"Object {i + 1}"


def _read(table: Table, name: str) -> SceneObject:
    table.needs(SHAPES)
    for i, key in enumerate(SHAPES):
        table.not_both(key, SHAPES[:i])
    table.not_both("turn", ("axes", "path"))
    table.not_both("path", ("place",))
    vertices, triangles = _shape(table)
    role = table.choice("role", SceneRole) or SceneRole.GROUND
    keys = [table]
    frames = [0.0]
    if "path" in table.values:
        form = "write path as [{ frame = 1, place = [0, 0, 0] }, ...]"
        keys = table.inner(("path",), table.values["path"], PATH_KEYS, form)
        frames = [each.number("frame") or 0.0 for each in keys]
        if sorted(set(frames)) != frames or not frames:
            table.refuse("path", "the path's frames must ascend")
    positions = np.array([each.vector("place") or (0.0, 0.0, 0.0) for each in keys])
    rotations = np.stack([_turn(each) for each in keys])
    return SceneObject(
        name,
        role,
        vertices,
        triangles,
        np.array(frames),
        positions,
        rotations,
        read_rates(table),
    )


def _turn(table: Table) -> FloatArray:
    """(3, 3) object to world."""
    table.not_both("turn", ("axes",))
    if "axes" in table.values:
        axes = _rows(table, "axes")
        if axes.shape != (3, 3) or not np.allclose(axes @ axes.T, np.eye(3), atol=1e-6):
            table.refuse("axes", '"axes" must be the three rows of a rotation')
        return axes
    return axis_rotation(2, np.radians(table.number("turn") or 0.0))


def _shape(table: Table) -> tuple[FloatArray, IntArray]:
    if "faces" in table.values and "points" not in table.values:
        table.refuse("faces", '"faces" are of "points"; add these')
    if "points" in table.values:
        points, faces = _rows(table, "points"), _rows(table, "faces")
        if (faces != faces.astype(int)).any() or not _within(faces, len(points)):
            table.refuse("faces", '"faces" must hold indices of "points", from 0')
        return points, faces.astype(int)
    if "file" in table.values:
        return _from_file(table)
    size = np.array(table.vector("box") or table.vector("ramp"))
    key = "box" if "box" in table.values else "ramp"
    if not (size > 0.0).all():
        table.refuse(key, f'"{key}" must be above zero in all three')
    return SOLIDS[key](size)


def _within(faces: FloatArray, count: int) -> bool:
    return bool(((faces >= 0) & (faces < count)).all())


def _rows(table: Table, key: str) -> FloatArray:
    """(N, 3) finite numbers."""
    value = table.values.get(key)
    try:
        rows = np.array(value, dtype=float)
    except (TypeError, ValueError):
        rows = np.empty(0)
    if rows.ndim != 2 or rows.shape[1] != 3 or not np.isfinite(rows).all():
        table.refuse(key, f'"{key}" must be a list of [x, y, z], not {shown(value)}')
    return rows


def _from_file(table: Table) -> tuple[FloatArray, IntArray]:
    path = Path(table.source.path).parent / (table.word("file") or "")
    if problem := unreadable(path):
        table.refuse("file", f"{path} cannot be read ({problem}); check its path")
    try:
        return read_obj(path)
    except UnreadableMesh as error:
        table.refuse("file", f'line {error.line} of {path.name} is no OBJ: "{error.text}"')
    except OSError as error:
        table.refuse("file", f"{path} cannot be read ({error.strerror}); check its path")
    except UnicodeDecodeError:
        table.refuse("file", f"{path.name} is no text; export it as OBJ")


# ---------------------------------------------------------------- placing


def placed_objects(
    under: Sequence[Under], problem: MotionProblem, analysis: Analysis
) -> tuple[SceneObject, ...]:
    """The objects where the analysis tells them to be. Raises UnknownPhaseIn, NoFaceThere, and as
    `pinned_places` does."""
    return tuple(_placed(each, problem, analysis) for each in under)


def _placed(under: Under, problem: MotionProblem, analysis: Analysis) -> SceneObject:
    schedule, performance = analysis.schedule, analysis.performance
    pin = next((pin for pin in problem.pins if pin.name == under.what), None)
    if pin is None:
        phase = _flight(under, schedule.phases)
        times = performance.times
        during = (times >= phase.start) & (times <= phase.end)
        apex = performance.com[during][performance.com[during][:, 2].argmax()]
        place, top = np.array([*apex[:2], schedule.floor_m]), 0.0
    else:
        bare = replace(problem, pins=tuple(replace(each, on=None) for each in problem.pins))
        phase = phase_of(pin, schedule)
        chosen = chosen_contacts(pin, phase, schedule)
        contacts = [schedule.contacts[i] for i in chosen]
        places = pinned_places(bare, performance, schedule)[chosen]
        places[:, 2] -= above_ground(contacts, performance.character, schedule.floor_m)
        place = places.mean(axis=0)
        middle = placed_mesh(under.thing).heights(np.zeros((1, 2))).z[0]
        if not np.isfinite(middle):
            raise NoFaceThere(pin.name, under.what, under.thing.name)
        top = float(middle)
    axes = travel_axes(performance, schedule, phase)
    place = place + axes @ np.array(under.offset) - [0.0, 0.0, top]
    return replace(
        under.thing,
        positions=place[None],
        rotations=(axes @ under.thing.rotations[0])[None],
    )


def _flight(under: Under, phases: Sequence[Phase]) -> Phase:
    for phase in phases:
        if phase.name == under.what.casefold() and phase.kind is PhaseKind.FLIGHT:
            return phase
    known = tuple(phase.name for phase in phases if phase.kind is PhaseKind.FLIGHT)
    raise UnknownPhaseIn(under.thing.name, under.what, known)
