"""Bodies and meshes: distances against MuJoCo's boxes, their Jacobians, what is near."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from hangtime.solver.arrays import IntArray
from hangtime.solver.data.scene import SceneObject
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.scene.object_motion import ObjectMotion
from hangtime.solver.scene.triangle_mesh import mesh_of, triangle_mesh
from hangtime.solver.solid.mesh_surface import MeshSurface, deepest, scene_shapes
from hangtime.solver.solid.penetrations import Penetrations, placed_at
from hangtime.solver.solid.shapes import Capsules
from hangtime.solver.solid.solid_world import SolidDistance
from hangtime.solver.solid.surfaces import Placed
from hangtime.solver.transcription.sampling import Instants, State
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.meshes import Triangles, ball, box, thing
from hangtime.tests.helpers.toy_problems import jacobian_error

TIMES = np.array([0.013, 0.21, 0.48, 0.7, 1.2])
SHALLOWER = 1e-6  # m, than the deepest of points on an axis
# Of the Jacobian, which is exact on edges, too: 1e-9 m less deep than the deepest, about an edge
# 5 cm away, is the square root of 4e-8 beside it.
SOUGHT = 2e-4
SIZE = (0.5, 0.6, 0.7)
TURN = axis_rotation(2, 0.3) @ axis_rotation(0, 0.2)


def crate() -> SceneObject:
    """A box that stands in the way of the legs."""
    com = fitted_hop().motion.com(np.array([0.6]))[0]
    return thing("Crate", box(SIZE), (com[0], com[1], com[2] - 0.8), rotation=TURN)


def surface(which: SceneObject) -> MeshSurface:
    t = fitted_hop().motion.transcription
    shapes = scene_shapes(t.character, t.points)
    names = tuple(f"{i} in Crate" for i in range(len(shapes)))
    motion = ObjectMotion.of(which, 0.0, 1.0)
    return MeshSurface(mesh_of(which), motion, Capsules.of(shapes), names)


def every(placed: Placed) -> tuple[IntArray, IntArray]:
    count = len(surface(crate()).names)
    instants, items = np.indices((len(placed.times), count)).reshape(2, -1)
    return instants, items


def mujocos(placed: Placed, at: int) -> np.ndarray:
    """Distances of all shapes at an instant from MuJoCo's box."""
    shapes = surface(crate()).shapes
    place = " ".join(map(repr, crate().positions[0].tolist()))
    columns = " ".join(map(repr, TURN[:, :2].T.ravel().tolist()))
    half = " ".join(map(repr, (0.5 * np.array(SIZE)).tolist()))
    geoms = [f'<geom type="box" size="{half}" pos="{place}" xyaxes="{columns}"/>']
    ends = np.concatenate(shapes.ends(placed.pose), axis=2)[at] + np.tile(placed.com[at], 2)
    for line, radius in zip(ends.tolist(), shapes.radius, strict=True):
        point = line[:3] == line[3:]
        kind, where = ("sphere", "pos") if point else ("capsule", "fromto")
        said = " ".join(map(repr, line[:3] if point else line))
        geoms.append(f'<geom type="{kind}" {where}="{said}" size="{max(radius, 1e-9)}"/>')
    text = f"<mujoco><worldbody>{''.join(geoms)}</worldbody></mujoco>"
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    count = len(shapes.radius)
    return np.array(
        [mujoco.mj_geomDistance(model, data, 0, 1 + i, 9.0, None) for i in range(count)]
    )


def test_distances_are_mujocos() -> None:
    """Those of axes outside; MuJoCo knows no depth beyond them."""
    placed = placed_at(fitted_hop().motion, TIMES)
    instants, items = every(placed)
    found = surface(crate()).closest(placed, instants, items).distance
    theirs = np.concatenate([mujocos(placed, at) for at in range(len(TIMES))])
    radius = surface(crate()).shapes.radius[items]
    outside = found + radius > 1e-3
    assert (found[outside] < 0.0).any()
    np.testing.assert_allclose(found[outside], theirs[outside], atol=5e-4)


def test_all_that_is_deep_is_near() -> None:
    placed = placed_at(fitted_hop().motion, TIMES)
    instants, items = every(placed)
    deep = surface(crate()).closest(placed, instants, items).distance < 0.0
    near = set(zip(*(each.tolist() for each in surface(crate()).near(placed)), strict=True))
    assert deep.any()
    assert set(zip(instants[deep].tolist(), items[deep].tolist(), strict=True)) <= near


@pytest.mark.parametrize("moves", [False, True])
def test_the_jacobian_is_the_distances_derivative(*, moves: bool) -> None:
    which = crate()
    if moves:  # through the same place
        way = np.array([[0.1], [0.0], [-0.1]]) * [1.0, 0.5, 0.2]
        which = replace(
            which,
            frames=np.array([0.0, 0.6, 1.2]),
            positions=which.positions + way,
            rotations=np.stack([TURN, axis_rotation(2, 0.1) @ TURN, axis_rotation(2, 0.3) @ TURN]),
        )
    motion, seen = fitted_hop().motion, surface(which)
    t, placed = motion.transcription, placed_at(motion, TIMES)
    instants, items = seen.near(placed)
    assert len(items) > 30
    none = np.zeros(len(items))
    where = Penetrations(seen.names, items, TIMES[instants], none, none, np.zeros((len(items), 3)))
    state = State(t.character, t.layout, Instants(t.basis, where.times), motion.x)
    assert jacobian_error(state, SolidDistance(seen, where), 0) < SOUGHT


@pytest.mark.parametrize("mesh", [box((0.4, 0.3, 0.05)), ball(0.2, 8), ball(0.2, 40)])
def test_the_deepest_point_of_an_axis_is_found(mesh: Triangles) -> None:
    """Against points every millimetre of axes that are all about, through and in it."""
    solid = triangle_mesh(*mesh)
    assert solid is not None
    start, end = np.random.default_rng(1).uniform(-0.3, 0.3, (2, 12, 3))
    shares = np.linspace(0.0, 1.0, 500)[:, None, None]
    along = (start + shares * (end - start)).reshape(-1, 3)
    least = solid.distances(along).distance.reshape(500, -1).min(axis=0)
    found = deepest(solid, start, end)
    assert least.min() < -0.02
    assert np.median(found.distance - least) < 0.0
    assert (found.distance - least).max() < SHALLOWER
    at = start + found.share[:, None] * (end - start)
    np.testing.assert_allclose(solid.distances(at).distance, found.distance, atol=1e-12)
    assert deepest(solid, start[:0], end[:0]).gradient.shape == (0, 3)
