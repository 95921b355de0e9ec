"""Of many objects only those are looked at that the body is near, and nothing near is missed."""

from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.scene import SceneObject, SteadyMotion
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.scene.boxes import still_near
from hangtime.solver.scene.object_motion import ObjectMotion
from hangtime.solver.scene.triangle_mesh import mesh_of
from hangtime.solver.solid.mesh_surface import MeshSurface, scene_shapes
from hangtime.solver.solid.penetrations import placed_at
from hangtime.solver.solid.shapes import Capsules
from hangtime.solver.solid.surfaces import Placed, Surfaces
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.meshes import box, thing

TILE = 0.5  # m


@cache
def hop() -> Placed:
    motion = fitted_hop().motion
    return placed_at(motion, np.linspace(0.0, motion.duration, 40))


def tiles() -> list[SceneObject]:
    """Of a floor of 10 m, in which the figure stands to its knees."""
    places = [(TILE * x, TILE * y, 0.3) for x in range(-10, 10) for y in range(-10, 10)]
    return [thing(f"Tile {i}", box((TILE, TILE, 0.1)), at) for i, at in enumerate(places)]


def turned(rng: np.random.Generator, i: int) -> SceneObject:
    """A box somewhere about the figure: still, with keys, or going steadily."""
    turns = [axis_rotation(k, rng.uniform(-3.0, 3.0)) for k in range(3)]
    place = hop().com.mean(axis=0) + rng.uniform(-0.7, 0.7, 3)
    still = thing(f"Box {i}", box((0.6, 0.3, 0.1)), (place[0], place[1], place[2]))
    still = replace(still, rotations=np.array([turns[0] @ turns[1] @ turns[2]]))
    keys = still.positions + np.linspace(-1.0, 1.0, 3)[:, None]
    kinds = (
        still,
        replace(still, steady=SteadyMotion(velocity=(1.0, 0.5, 0.0), spin=2.0)),
        replace(
            still,
            frames=np.array([0.0, 0.5, 1.0]),
            positions=keys,
            rotations=np.repeat(still.rotations, 3, axis=0),
        ),
    )
    return kinds[i % len(kinds)]


def surface(which: SceneObject) -> MeshSurface:
    t = fitted_hop().motion.transcription
    shapes = Capsules.of(scene_shapes(t.character, t.points))
    names = tuple(f"{i} in {which.name}" for i in range(len(shapes.radius)))
    return MeshSurface(mesh_of(which), ObjectMotion.of(which, 0.0, 1.0), shapes, names)


def one_by_one(surfaces: Surfaces) -> list[list[int]]:
    """What the surfaces find, each asked about all instants."""
    found: list[list[int]] = []
    first = 0
    for part in surfaces.parts:
        when, items = part.near(hop())
        found += np.column_stack([when, items + first]).tolist()
        first += len(part.names)
    return found


def test_nothing_near_is_missed() -> None:
    """The same rows in the same order, of turned boxes that stand and that move."""
    rng = np.random.default_rng(3)
    surfaces = Surfaces(tuple(surface(turned(rng, i)) for i in range(30)))
    found = np.column_stack(surfaces.near(hop())).tolist()
    assert len({item for _, item in found}) > 100
    assert found == one_by_one(surfaces)


def test_tiles_that_are_far_are_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    surfaces = Surfaces(tuple(surface(tile) for tile in tiles()))
    expected, asked, near = one_by_one(surfaces), Counter[str](), MeshSurface.near

    def counted(self: MeshSurface, placed: Placed) -> object:
        asked[self.motion.thing.name] += 1
        return near(self, placed)

    monkeypatch.setattr(MeshSurface, "near", counted)
    assert np.column_stack(surfaces.near(hop())).tolist() == expected
    assert expected
    assert len(asked) < len(surfaces.parts) / 10
    assert max(asked.values()) == 1


def test_of_no_surface_that_is_met_there_is_nothing_near() -> None:
    away = surface(thing("Away", box((1.0, 1.0, 1.0)), (50.0, 0.0, 0.0)))
    instants, items = Surfaces((away,)).near(hop())
    assert not len(instants)
    assert not len(items)


def test_still_objects_are_near_by_their_boxes() -> None:
    tip = axis_rotation(2, np.pi / 4.0)
    wall = thing("Wall", box((2.0, 0.1, 1.0)), (1.0, 0.0, 0.5), rotation=tip)
    moving = replace(wall, steady=SteadyMotion(spin=1.0))

    def seen(point: FloatArray, within: float) -> list[SceneObject]:
        return still_near((moving, wall), point[None], within)

    assert seen(np.array([1.6, 0.6, 0.5]), 0.1) == [wall]
    assert seen(np.array([1.0, 0.9, 0.5]), 0.1) == []
    assert seen(np.array([1.0, 0.9, 0.5]), 0.2) == [wall]
    assert still_near((), np.zeros((1, 3)), 1.0) == []
