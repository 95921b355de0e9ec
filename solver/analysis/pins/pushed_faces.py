"""The faces that contacts push against beside those they stand on: walls, as the scene has them.

A foot on the floor beside a wall, or on a crate's rim, stands; what is at a steep face and on
nothing pushes off from that.
"""

from collections.abc import Sequence

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...body.character import Character
from ...data.constants import UP
from ...data.contacts import Contact
from ...data.problem import MotionProblem
from ...numerics.rotations import unit
from ...scene.boxes import still_near
from ...scene.steep import is_steep
from ...scene.triangle_mesh import Distances, TriangleMesh, placed_mesh

OFF = 0.04  # m from a part's skin, within which a face is what it touches (grounding.py)
RIM = 0.01  # m behind a steep face, clear of its edge, where a top that begins there is found


def pushed_normals(
    problem: MotionProblem,
    contacts: Sequence[Contact],
    places: FloatArray,
    character: Character,
    floor_m: float,
) -> FloatArray:
    """(n, 3) normals of what contacts at places (n, 3) m push against: those that the artist gives,
    or else of the scene's steep faces that they are at; up for all others."""
    normals = np.tile(UP, (len(places), 1))
    if not len(places):
        return normals
    reach = OFF + _thickness(contacts, character)
    free = ~_riding(problem, contacts) & (places[:, 2] > floor_m + reach)
    nearest = reach.copy()
    for thing in still_near(problem.scene, places, float(reach.max())):
        mesh = placed_mesh(thing)
        found = mesh.distances(places)
        at_rim = np.abs(found.distance) < reach
        at_rim &= _on_top(mesh, _behind(places, found), reach)
        free &= ~(at_rim | _on_top(mesh, places, reach))
        near = (np.abs(found.distance) < nearest) & is_steep(found.normal)
        normals[near], nearest[near] = found.normal[near], np.abs(found.distance)[near]
    normals[~free] = UP
    given = {r.name: r.normal for r in problem.requests.points if r.environment and r.normal}
    for i, contact in enumerate(contacts):
        if contact.name in given:
            normals[i] = unit(np.array(given[contact.name], dtype=float))
    return normals


def _riding(problem: MotionProblem, contacts: Sequence[Contact]) -> BoolArray:
    """(n,) whether contacts are on something that moves: they stand there, whatever it passes."""
    moving = {thing.name for thing in problem.scene if thing.moves}
    return np.array([contact.on in moving for contact in contacts])


def _behind(places: FloatArray, found: Distances) -> FloatArray:
    """(n, 3) m, places (n, 3) moved level to a little behind the faces that are nearest to them."""
    level = found.normal[:, :2]
    level = level / np.maximum(np.linalg.norm(level, axis=1, keepdims=True), 1e-9)
    moved = (found.distance + RIM)[:, None] * level
    return np.asarray(places - np.pad(moved, ((0, 0), (0, 1))))


def _on_top(mesh: TriangleMesh, places: FloatArray, reach: FloatArray) -> BoolArray:
    """(n,) whether places are at the highest face above or below them, on which they can stand."""
    top = mesh.heights(places[:, :2])
    return np.asarray((np.abs(places[:, 2] - top.z) < reach) & ~is_steep(top.normal))


def _thickness(contacts: Sequence[Contact], character: Character) -> FloatArray:
    """(n,) m, from the middle of what contacts are of to its skin: a point within a limb is so far
    from what that touches."""
    half = {body.bone: 0.5 * float(body.box_size.min()) for body in character.bodies}
    return np.array([half.get(contact.bone, 0.0) for contact in contacts])
