"""Clearance: what is over an object is kept above it, and nothing beside it."""

import numpy as np
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.scene.object_motion import ObjectMotion
from hangtime.solver.solid.clearance import Clearance
from hangtime.solver.solid.shapes import Capsules
from hangtime.solver.solid.solid_world import placed_at
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.meshes import box, thing


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
    seen = Clearance.over(hurdle, ObjectMotion.of(hurdle, 0.0, 1.0), shapes, by, ("a", "b", "c"))
    none, items = np.zeros(3, dtype=int), np.arange(3)
    found = seen.closest(placed, none, items)
    # the steep one falls as far as it goes; the base is turned, and wider by the radius
    steep = 1.0 + 0.1 - (0.25 + 0.1) - 0.05 - 0.02 - 0.6
    np.testing.assert_allclose(found.distance[[0, 2]], [steep, 0.03], atol=1e-9)
    assert found.distance[1] > 0.0
    np.testing.assert_allclose(found.normal[:, 2], [1.0, 0.0, 1.0])
    placed.com[:, 2] -= 0.2
    assert seen.near(placed)[1].tolist() == [0, 2]
