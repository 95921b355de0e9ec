"""Landing on an object: contacts are put onto its faces, each foot tilted as they are.

A foot's contacts keep their distances: they are turned together until they lie on the faces, by
the plane through these. A foot of which a part has no face to lie on hangs over an edge.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...arrays import FloatArray
from ...body.anatomy import Side
from ...body.character import Character
from ...data.constants import UP
from ...data.contacts import Contact
from ...data.faults import InsideOut, NoFaceThere, OverTheEdge
from ...data.problem import Pin
from ...data.scene import SceneObject
from ...numerics.rotations import rotation_matrix
from ...scene.triangle_mesh import Heights, TriangleMesh
from ..performance import above_ground

ROUNDS = 6  # in which a foot's plane settles on curved ground
STEP = 0.04  # m, by which a face lies above or below a foot's plane and is another one's
LEVELLED = 0.006  # m, by which a sole gives on uneven ground
STIFF = 1e-4  # m²; how far apart (squared) contacts are to say a slope rather than their face
EDGE_PARTS = 64  # in which the way to an edge is looked for


@dataclass(frozen=True)
class Footing:
    """Of n contacts: places (n, 3) m, world, and normals (n, 3) of the faces they are on.

    pins: those that put a contact on a face, by its name.
    """

    places: FloatArray
    normals: FloatArray
    pins: Mapping[str, Pin] = field(default_factory=dict)


@dataclass(frozen=True)
class Ground:
    """An object as the ground of a pin. mesh: in the world."""

    pin: str
    thing: SceneObject
    mesh: TriangleMesh


def land(
    ground: Ground,
    contacts: Sequence[Contact],
    places: FloatArray,
    character: Character,
    floor_m: float,
) -> Footing:
    """Contacts, at places (n, 3) m, put onto an object, a palm's point above the face. floor_m:
    height of the recording's floor.

    Raises NoFaceThere, OverTheEdge, InsideOut.
    """
    places, normals = places.copy(), np.tile(UP, (len(places), 1))
    for foot in _feet(contacts, character):
        names = [contacts[i].name for i in foot]
        places[foot], normals[foot] = _stand(ground, names, places[foot])
    above = above_ground(contacts, character, floor_m)
    return Footing(places + above[:, None] * normals, normals)


def _feet(contacts: Sequence[Contact], character: Character) -> Iterator[list[int]]:
    """Contacts of one side's limb that touch together, or one after the other without a gap."""
    bodies = {body.bone: body for body in character.bodies}
    groups: dict[tuple[Side | None, bool], list[int]] = {}
    for i, contact in enumerate(contacts):
        body = bodies[contact.bone]
        groups.setdefault((body.side, body.part.value in ("foot", "toe")), []).append(i)
    for group in groups.values():
        found: list[int] = []
        for i in sorted(group, key=lambda i: contacts[i].start):
            if found and contacts[i].start > max(contacts[j].end for j in found):
                yield found
                found = []
            found.append(i)
        yield found


def _stand(
    ground: Ground, names: Sequence[str], points: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Points (k, 3) m of one foot on the faces, and the normals there."""
    centre = points.mean(axis=0)
    middle = ground.mesh.heights(centre[None, :2])
    if not np.isfinite(middle.z[0]):
        x, y = centre[:2].tolist()
        raise NoFaceThere(ground.pin, names[0], ground.thing.name, (x, y), _reach(ground.mesh))
    if middle.normal[0, 2] <= 0.0:
        raise InsideOut(ground.thing.name)
    centre[2] = middle.z[0]
    slope = -middle.normal[0, :2] / max(middle.normal[0, 2], 1e-3)
    for _ in range(ROUNDS):
        placed = centre + (points - points.mean(axis=0)) @ _tilt(slope).T
        found = ground.mesh.heights(placed[:, :2])
        _check_edges(ground, names, placed, found, centre)
        off = found.z - placed[:, 2]
        apart = placed[:, :2] - centre[:2]
        stiff = apart.T @ apart + STIFF * np.eye(2)
        centre[2] += off.mean()
        slope = slope + np.linalg.solve(stiff, apart.T @ (off - off.mean()))
    for i in np.flatnonzero(np.abs(off) > LEVELLED)[:1]:
        raise OverTheEdge(ground.pin, names[i], ground.thing.name, float(np.abs(off[i])))
    return placed, found.normal


def _reach(mesh: TriangleMesh) -> tuple[tuple[float, float], tuple[float, float]]:
    """Least and greatest x, and y, m, of a mesh's corners."""
    corners = mesh.tree.triangles.reshape(-1, 3)
    (x, y, _), (x_most, y_most, _) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return (x, x_most), (y, y_most)


def _tilt(slope: FloatArray) -> FloatArray:
    """(3, 3) the least turn that makes the level a plane that rises by slope (2,)."""
    across = np.array([slope[1], -slope[0], 0.0])
    steep = float(np.linalg.norm(across))
    return rotation_matrix(across * (np.arctan(steep) / steep if steep > 0.0 else 0.0))


def _check_edges(
    ground: Ground, names: Sequence[str], placed: FloatArray, found: Heights, centre: FloatArray
) -> None:
    """Every point has a face near its foot's plane. Raises OverTheEdge."""
    share = np.linspace(0.0, 1.0, EDGE_PARTS + 1)
    over: dict[int, float] = {}
    for i in np.flatnonzero(~(np.abs(found.z - placed[:, 2]) < STEP)).tolist():
        way = placed[i] + share[:, None] * (centre - placed[i])
        on = np.abs(ground.mesh.heights(way[:, :2]).z - way[:, 2]) < STEP
        over[i] = float(share[int(on.argmax())] * np.linalg.norm(centre - placed[i]))
    if over:
        worst = max(over, key=lambda i: over[i])
        raise OverTheEdge(ground.pin, names[worst], ground.thing.name, over[worst])
