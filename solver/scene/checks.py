"""Checks of a scene before anything is solved in it."""

from collections.abc import Sequence

import numpy as np

from ..data.faults import (
    InsideOut,
    NotFinite,
    NotGround,
    NoThickness,
    SameObjectName,
    TooManyFaces,
    UnknownObject,
)
from ..data.problem import MotionProblem
from ..data.scene import SceneObject, SceneRole
from .triangle_mesh import MERGED, mesh_of

MOST_TRIANGLES = 2_000_000  # whose tree is built in 7 s


def check_scene(problem: MotionProblem) -> None:
    """Refuses objects that are no solids, and requests for objects that are not there.

    Raises NoFaces, NoThickness, NotFinite, InsideOut, TooManyFaces, SameObjectName, UnknownObject,
    NotGround.
    """
    names = [thing.name for thing in problem.scene]
    for i, thing in enumerate(problem.scene):
        if thing.name in names[:i]:
            raise SameObjectName(thing.name)
        _check(thing)
    for pin in problem.pins:
        if pin.on is None:
            continue
        if named(pin.name, pin.on, problem.scene).role is not SceneRole.GROUND:
            raise NotGround(pin.name, pin.on)
    for clear in problem.requests.clears:
        named(clear.name, clear.thing, problem.scene)


def named(request: str, name: str, scene: Sequence[SceneObject]) -> SceneObject:
    """The object that a request names. Raises UnknownObject."""
    for thing in scene:
        if thing.name == name:
            return thing
    raise UnknownObject(request, name, tuple(thing.name for thing in scene))


def _check(thing: SceneObject) -> None:
    if len(thing.triangles) > MOST_TRIANGLES:
        raise TooManyFaces(thing.name, len(thing.triangles), MOST_TRIANGLES)
    values = thing.vertices, thing.positions, thing.rotations
    if not all(np.isfinite(each).all() for each in values):
        raise NotFinite(thing.name)
    mesh = mesh_of(thing)
    if mesh.closed and mesh.thickness < MERGED:
        raise NoThickness(thing.name)
    if mesh.closed and mesh.volume < 0.0:
        raise InsideOut(thing.name)
