"""Ways out of objects: up is clearance, which keeps what is over one above it, and no more."""

import numpy as np
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.scene.object_motion import ObjectMotion
from hangtime.solver.solid.penetrations import placed_at
from hangtime.solver.solid.profile import FINEST, profile_under_balls
from hangtime.solver.solid.shapes import Capsules
from hangtime.solver.solid.way_out import WayOut
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.meshes import box, thing

UP = (0.0, 0.0, 1.0)


def test_the_lowest_point_over_the_base_counts() -> None:
    placed = placed_at(fitted_hop().motion, np.zeros(1))
    placed.pose.rotations[:] = np.eye(3)
    placed.pose.centres[:] = 0.0
    placed.com[:] = [0.0, 0.0, 1.0]
    turn = axis_rotation(2, np.radians(90.0))
    hurdle = thing("Hurdle", box((0.1, 1.0, 0.6)), (0.0, 0.0, 0.3), rotation=turn)
    axes = (  # steep over it, level beside it, a ball over it
        np.array([[0.0, -0.25, 0.1], [0.0, 0.3, 0.0], [0.2, 0.0, -0.3]]),
        np.array([[0.0, 0.25, -0.4], [0.3, 0.3, 0.0], [0.2, 0.0, -0.3]]),
    )
    shapes = Capsules(np.arange(3), *axes, np.full(3, 0.05))
    by = np.full(3, 0.02)
    seen = WayOut.above(ObjectMotion.of(hurdle, 0.0, 1.0), shapes, by, ("a", "b", "c"))
    none, items = np.zeros(3, dtype=int), np.arange(3)
    found = seen.closest(placed, none, items)
    # the steep one falls by 45° past the edge of the top, which is turned: there it is nearest
    steep = 1.0 - 0.15 - 0.05 - 0.05 * np.sqrt(2.0) - 0.02 - 0.6
    np.testing.assert_allclose(found.distance[[0, 2]], [steep, 0.03], atol=FINEST)
    assert found.distance[1] > 0.0
    np.testing.assert_allclose(found.normal[:, 2], [1.0, 0.0, 1.0])
    placed.com[:, 2] -= 0.2
    assert seen.near(placed)[1].tolist() == [0, 2]


def test_an_object_is_as_high_as_its_highest_face_beneath() -> None:
    """A gate: posts and a bar, and a slab on the floor before it."""
    slab, bar = box((1.0, 1.0, 0.1)), box((0.04, 1.0, 0.04))
    bar = bar[0] + [0.3, 0.0, 0.6], bar[1]
    gate = thing("Gate", (np.concatenate([slab[0], bar[0]]), np.concatenate([slab[1], bar[1] + 8])))
    under = profile_under_balls(gate, UP, 0.0)
    places = np.array([[-0.3, 0.0], [0.3, 0.2], [0.25, 0.0], [0.35, 0.0], [0.3, 0.6]])
    np.testing.assert_allclose(under.at(places), [0.05, 0.62, 0.05, 0.05, -np.inf], atol=1e-9)


def test_a_ball_touches_a_slope_beside_its_lowest_point() -> None:
    slope = np.array([[0.0, -1.0, 0.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]])
    ramp = thing("Ramp", (slope, np.array([[0, 1, 2], [0, 2, 3]])))
    under = profile_under_balls(ramp, UP, 0.1)
    centre = 0.5 + 0.1 * np.sqrt(2.0)
    assert abs(float(under.at(np.array([[0.5, 0.0]]))[0]) - centre) < FINEST


def test_a_thin_wire_is_seen_whatever_its_way() -> None:
    turn = axis_rotation(2, np.radians(33.0))
    wire = box((2.0, 0.002, 0.002))
    fence = thing("Fence", (wire[0] @ turn.T, wire[1]), (0.0, 0.0, 0.5))
    along = np.linspace(-0.95, 0.95, 200)[:, None] * turn[:, 0]
    height = profile_under_balls(fence, UP, 0.03).at(along[:, :2])
    np.testing.assert_allclose(height, 0.031, atol=0.01)
