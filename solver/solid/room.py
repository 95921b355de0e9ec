"""Room for a leg where feet shall stand: what fits in no pose is refused before anything is solved.

A foot whose heel and toe are held to their places holds its ankle, so the shank goes up from there,
leaning as far as ankles bend. Where it is in an object whatever way it leans, so is every motion.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from ..arrays import FloatArray
from ..data.constants import UP
from ..data.contacts import Contact, ContactSchedule
from ..data.faults import NoRoom
from ..data.scene import SceneObject
from ..numerics.rotations import unit
from ..scene.boxes import still_near
from ..scene.triangle_mesh import SHEET, TriangleMesh, placed_mesh
from ..transcription.transcription import Transcription
from .mesh_surface import scene_shapes
from .shape_changes import ShapeChanges

MOST_LEAN = np.radians(45.0)  # of a shank over a foot that stands; ankles bend by 20 to 40 degrees
LEANS, WAYS = 4, 16  # how many leans from upright on, and ways to lean, are tried
PARTS = 12  # along a shank, where it is looked at
DEEPEST = 0.03  # m, in an object; what is deeper in it in every pose does not fit


def check_room(
    scene: Sequence[SceneObject],
    transcription: Transcription,
    schedule: ContactSchedule,
    places: FloatArray,
    changes: ShapeChanges,
) -> None:
    """Every foot that stands, contacts at places (n, 3) m, has room for its shank in a still scene.

    Raises NoRoom.
    """
    character, points = transcription.character, transcription.touching
    shapes = {s.body: s for s in scene_shapes(character, points, changes)}
    local = {c.contact.point: points[c.point] for c in transcription.contacts}
    for heel, toe in _standing(schedule.contacts) if scene else ():
        names = [schedule.contacts[i].point for i in (heel, toe)]
        if not all(name in local for name in names):
            continue
        back, front = (local[name] for name in names)
        foot = character.joints[back.body]
        if foot.parent not in shapes:
            continue
        ahead = front.place + (
            0.0 if front.body == back.body else character.joints[front.body].offset
        )
        sole = unit(ahead - back.place)
        along = -float(sole @ back.place)
        above = float(np.linalg.norm(back.place + along * sole))
        ankle = places[heel] + along * unit(places[toe] - places[heel]) + above * UP
        shank = _leaning(ankle, float(np.linalg.norm(foot.offset)))
        radius = shapes[foot.parent].radius
        upright = shank[0]  # in an object, as all others are, that leaves no room
        for thing in still_near(scene, upright, max(radius, SHEET)):
            mesh = placed_mesh(thing)
            if _never_fits(mesh, shank, radius):
                needed = above + float(np.linalg.norm(foot.offset) * np.cos(MOST_LEAN)) + radius
                free = _free_above(mesh, places[heel], needed)
                raise NoRoom(thing.name, schedule.contacts[heel].name, free, needed)


def _standing(contacts: Sequence[Contact]) -> Iterator[tuple[int, int]]:
    """Indices of the heel and the toe of each foot that stands on both at once."""
    for i, heel in enumerate(contacts):
        side, _, end = heel.point.rpartition(" ")
        for j, toe in enumerate(contacts) if end == "heel" else ():
            both = min(heel.end, toe.end) - max(heel.start, toe.start)
            if toe.point == f"{side} toe" and both > 0.0:
                yield i, j


def _leaning(ankle: FloatArray, length: float) -> FloatArray:
    """(W, PARTS, 3) m, along shanks of that length from an ankle (3,) m, ever more leaning."""
    lean = np.linspace(0.0, MOST_LEAN, LEANS)[:, None]
    way = np.linspace(0.0, 2.0 * np.pi, WAYS, endpoint=False)
    up = np.stack(
        [np.sin(lean) * np.cos(way), np.sin(lean) * np.sin(way), np.cos(lean) + 0.0 * way]
    )
    share = np.linspace(0.0, 1.0, PARTS)[:, None]
    return np.asarray(ankle + length * share * up.reshape(3, -1).T[:, None])


def _never_fits(mesh: TriangleMesh, shanks: FloatArray, radius: float) -> bool:
    """Whether every one of the shanks (W, P, 3) is in a mesh."""
    distance = mesh.distances(shanks.reshape(-1, 3)).distance.reshape(shanks.shape[:2])
    return bool((distance.min(axis=1) < radius - DEEPEST).all())


def _free_above(mesh: TriangleMesh, place: FloatArray, most: float) -> float:
    """How far, m, it is from a place (3,) m up to a mesh; `most` where it is not in the way."""
    heights = np.arange(DEEPEST, most, 0.005)
    inside = mesh.distances(place + heights[:, None] * UP).distance < 0.0
    return float(heights[inside.argmax()]) if inside.any() else most
