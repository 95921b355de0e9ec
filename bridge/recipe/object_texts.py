"""Objects of the scene as tables of a recipe: boxes and ramps in three numbers, others as files."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.data.scene import SceneObject, SceneRole, SupportBox
from ...solver.doctor.stance.footing import FLOOR_OFF, TOP_OFF
from ...solver.numerics.rotations import axis_rotation
from ...solver.unseen.offered import OfferedSupport
from ..recipe_syntax.toml_text import degrees, entries
from ..shapes.boxes import Known, known_solid
from .contacts import added_texts
from .object_rates import rate_values
from .objects import HEADER
from .requests import point_texts

FINE = 3  # decimals of the metres and degrees of a box that is offered


def object_text(thing: SceneObject, file: str | None = None) -> str:
    """The table that is read as an object. file: of its mesh; None writes the mesh itself."""
    return f"[[{HEADER}]]\n{entries(_values(thing, file))}"


def mesh_files(scene: Sequence[SceneObject]) -> dict[str, str]:
    """Names of files, none twice in any case, for objects that are no boxes or ramps."""
    files: dict[str, str] = {}
    taken: set[str] = set()
    for thing in scene:
        if _known(thing) is None:
            stem = "".join(c if c.isalnum() or c in " -_" else "_" for c in thing.name).strip()
            names = (f"{stem or HEADER}{number}.obj" for number in ("", *range(2, len(scene) + 2)))
            files[thing.name] = next(name for name in names if name.casefold() not in taken)
            taken.add(files[thing.name].casefold())
    return files


def offered_texts(offer: OfferedSupport) -> list[str]:
    """The tables of what would carry a body that something unseen carries."""
    contacts, holds = added_texts(offer.contacts), point_texts(offer.holds)
    return [*support_texts(offer.boxes), *contacts, *holds]


def support_texts(boxes: Sequence[SupportBox]) -> list[str]:
    """The tables of boxes that would carry what nothing in sight does."""
    stands = any(abs(box.top) <= TOP_OFF for box in boxes)
    return [_support_text(support_name(i), box, stands=stands) for i, box in enumerate(boxes)]


def _support_text(name: str, box: SupportBox, *, stands: bool) -> str:
    """With a comment of where it goes if the recording is put on the floor, as is advised unless
    it stands at 0 on one of the boxes."""
    values = {
        "name": name,
        "role": SceneRole.GROUND.value,
        "box": _rounded(box.size),
        "place": _rounded(box.place),
        "turn": round(float(np.degrees(box.turn)), FINE),
    }
    text = f"[[{HEADER}]]\n{entries(values)}"
    x, y, floor = _rounded(box.place)
    if stands or abs(floor) <= FLOOR_OFF:
        return text
    way = "lowered" if floor > 0.0 else "raised"
    moved = f"{way} by {abs(floor):g} m, by “floor” under [recording]"
    return f"{text}# with the recording {moved}: place = [{x:g}, {y:g}, 0]\n"


def support_name(i: int) -> str:
    """Of the i-th (from 0) box that is offered."""
    return "Box" if i == 0 else f"Box {i + 1}"


def _rounded(vector: tuple[float, float, float]) -> tuple[float, ...]:
    return tuple(round(value, FINE) + 0.0 for value in vector)


def _values(thing: SceneObject, file: str | None) -> dict[str, Any]:
    values: dict[str, Any] = {"name": thing.name, "role": thing.role.value}
    known = _known(thing)
    base, turn = np.zeros(3), np.eye(3)
    if known is not None:
        values[known.kind] = tuple(known.size.tolist())
        base, turn = known.base, known.turn
    elif file is not None:
        values["file"] = file
    else:
        values["points"], values["faces"] = _tuples(thing.vertices), _tuples(thing.triangles)
    positions, rotations = thing.positions + thing.rotations @ base, thing.rotations @ turn
    if len(thing.frames) > 1 or thing.frames[0] != 0.0:
        poses = zip(thing.frames.tolist(), positions, rotations, strict=True)
        values["path"] = tuple({"frame": frame} | _pose(p, r) for frame, p, r in poses)
    else:
        values |= _pose(positions[0], rotations[0])
    return values | rate_values(thing)


def _known(thing: SceneObject) -> Known | None:
    """What an object is; none whose own axes are told, as a belt's way is in these."""
    return known_solid(thing.vertices, thing.triangles) if thing.steady is None else None


def _pose(position: FloatArray, rotation: FloatArray) -> dict[str, Any]:
    values: dict[str, Any] = {"place": tuple(position.tolist())}
    if np.array_equal(rotation, np.eye(3)):
        return values
    turn = degrees(float(np.arctan2(rotation[1, 0], rotation[0, 0])))
    if np.array_equal(axis_rotation(2, np.radians(turn)), rotation):
        return values | {"turn": turn}
    return values | {"axes": _tuples(rotation)}


def _tuples(rows: FloatArray | IntArray) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in rows.tolist())
